//! The pages of `docs/`. Their examples are tests, and their links are checked with the documentation.
//!
//! - [`choosing`]: which strategy, precision, number of nodes, variates; when no sample at all.
//! - [`embedding`]: how to call airlight, and what the renderer does itself.
//! - [`accuracy`]: errors, bounds, and the inputs they hold on.
//! - [`speed`]: times, instruction sets, peers.
//! - [`mathematics`]: the derivation, equation by equation, with the source files.
//! - [`testing`]: what is promised, and which test holds it.
//! - [`command`]: the command line.

// Markdown takes the first definition of a link: `links.md` has the items of the documentation, and the end of each page the
// files for who reads it in the repository.

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/choosing.md")]
pub mod choosing {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/embedding.md")]
pub mod embedding {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/accuracy.md")]
pub mod accuracy {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/speed.md")]
pub mod speed {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/mathematics.md")]
pub mod mathematics {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/testing.md")]
pub mod testing {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/command.md")]
pub mod command {}
