//! The pages of `docs/`: what stands in them is compiled, run and checked with the documentation.
//!
//! - [`choosing`]: which strategy, precision, number of nodes, variates; when no sample at all.
//! - [`embedding`]: how to call airlight, and what the renderer does itself.
//! - [`accuracy`]: errors, bounds, and the inputs they hold on.
//! - [`speed`]: times, instruction sets, peers.
//! - [`mathematics`]: the derivation, equation by equation, with the source files.
//! - [`testing`]: what is promised, and which test holds it.
//! - [`command`]: the command line.

// The first definition of a link holds: `links.md` has those of the documentation, the end of each page those between files.

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
