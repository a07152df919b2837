//! What a time is the time of.

use serde::Serialize;

/// The part of a time: all of a kernel that writes `t` and `pdf`.
pub(crate) const TOTAL: &str = "total";
/// That of a call of few rays, one of many calls.
pub(super) const CALL: &str = "call";
/// The same of `sample_one`, which writes weights and `r` as well.
pub(super) const ONE: &str = "one";
/// [`Integral::radiance`](airlight::Integral::radiance).
pub(super) const RADIANCE: &str = "radiance";
/// [`Integral::choose`](airlight::Integral::choose).
pub(super) const CHOOSE: &str = "choose";

/// The names of the fields are keys of the JSON, which others read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Subject {
    pub(crate) strategy: Option<&'static str>,
    pub(crate) precision: Option<&'static str>,
    /// Of a peer, the one of its width.
    pub(crate) backend: Option<&'static str>,
    /// A kernel of a library of peers.
    pub(crate) peer: Option<&'static str>,
    /// A limit of the machine: `fma`, `division` (an operation of one lane); `read`, `write`, `stream` (a ray).
    pub(crate) limit: Option<&'static str>,
    pub(crate) threads: usize,
    /// Rays of a batch; none where there is no batch.
    pub(crate) rays: Option<usize>,
    pub(crate) samples_per_ray: usize,
    /// A part of the kernel, or [`TOTAL`], or `with-weight`, where weights and `r` are written as well; or [`CALL`], or
    /// [`ONE`]; or, of the integral, [`RADIANCE`] or [`CHOOSE`].
    pub(crate) stage: Option<&'static str>,
    /// Nodes of the integral.
    pub(crate) nodes: Option<usize>,
    /// Emitters of a choice; its time is that of all of them.
    pub(crate) emitters: Option<usize>,
}

impl Subject {
    /// Whether it is a call of few rays.
    pub(super) fn is_call(&self) -> bool {
        matches!(self.stage, Some(CALL | ONE))
    }
}
