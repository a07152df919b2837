//! The pages of `docs/`. Their examples are tests, and their links are checked with the documentation.
//!
//! - [`choosing`]: which strategy, precision, number of nodes and variates to take, and when no sample is needed.
//! - [`embedding`]: how to call airlight, and what is left to the renderer.
//! - [`accuracy`]: errors, bounds, and the inputs they hold on.
//! - [`speed`]: times, instruction sets, peers.
//! - [`mathematics`]: the derivation, equation by equation, with the source file of each.
//! - [`testing`]: the promises, and the test of each.
//! - [`command`]: the command line.

// Markdown takes the first definition of a link. `links.md` links to items of the documentation; the definitions at the end of each
// page link to files, for readers of the repository. So it is with images: those of `images.md` have the image in them (`build.rs`).

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
#[cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/images.md")))]
#[doc = include_str!("../docs/speed.md")]
pub mod speed {}

#[doc = include_str!("guide/links.md")]
#[cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/images.md")))]
#[doc = include_str!("../docs/mathematics.md")]
pub mod mathematics {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/testing.md")]
pub mod testing {}

#[doc = include_str!("guide/links.md")]
#[doc = include_str!("../docs/command.md")]
pub mod command {}
