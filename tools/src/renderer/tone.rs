//! From radiance to what a screen shows.

/// The displayed value in `[0, 1]` of a linear one: exposure, the filmic curve that Narkowicz fitted to ACES (2015),
/// the transfer function of sRGB.
#[must_use]
pub fn display(linear: f32, exposure: f32) -> f32 {
    let x = linear * exposure;
    // Beyond this the curve is at its end, and x^2 might overflow.
    let x = if x < 1e6 { x.max(0.0) } else { 1e6 };
    let filmic = ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0);
    if filmic <= 0.003_130_8 { 12.92 * filmic } else { 1.055 * filmic.powf(1.0 / 2.4) - 0.055 }
}
