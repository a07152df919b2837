//! Which backends have to be measured for accuracy.

use airlight::Backend;

/// Backends whose results differ: the first fused one stands for all of those, as their bits are equal.
pub fn distinct() -> impl Iterator<Item = Backend> {
    let mut fused = 0;
    Backend::available().filter(move |backend| {
        fused += usize::from(backend.is_fused());
        !backend.is_fused() || fused == 1
    })
}
