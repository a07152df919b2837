//! First stage: a ray through every pixel of the wave.

use super::columns::Vectors;
use super::picture::Size;
use super::variate::{Dimension, Variates};
use airlight::Rays;
use glam::Vec3;

/// A pinhole camera; y is up.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Where it stands \[m\].
    pub eye: Vec3,
    /// What it looks at \[m\].
    pub target: Vec3,
    /// Vertical field of view \[degrees\].
    pub field_of_view: f32,
}

/// A camera with a picture before it.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: Vec3,
    /// From the eye to the upper left corner of the picture.
    corner: Vec3,
    /// The sides of a pixel.
    across: Vec3,
    down: Vec3,
    width: usize,
}

/// Camera rays as airlight takes them.
#[derive(Clone, Debug, Default)]
pub struct RayQueue {
    /// Where they start \[m\].
    pub origin: Vectors,
    /// Where they go.
    pub direction: Vectors,
    /// Where they enter the medium: at once, for the camera stands in it.
    pub t_min: Vec<f32>,
    /// Where they meet a surface, or infinity.
    pub t_max: Vec<f32>,
}

impl View {
    /// The view of `camera` in `size` pixels.
    #[must_use]
    pub fn new(camera: &Camera, size: Size) -> Self {
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let up = right.cross(forward);
        let pixel = 2.0 * (0.5 * camera.field_of_view.to_radians()).tan() / size.height as f32;
        let (across, down) = (right * pixel, -up * pixel);
        let corner = forward - 0.5 * (size.width as f32 * across + size.height as f32 * down);
        Self { eye: camera.eye, corner, across, down, width: size.width }
    }

    /// The unit direction through a point of the picture, in pixels from its upper left corner.
    #[must_use]
    pub fn direction(&self, x: f32, y: f32) -> Vec3 {
        (self.corner + x * self.across + y * self.down).normalize()
    }

    /// Shoots a ray through a random point of each of `count` pixels from `first` on.
    pub fn shoot(&self, first: usize, count: usize, variates: &Variates, rays: &mut RayQueue) {
        // The columns of distances hold the random numbers until they get their own.
        variates.fill(Dimension::X, first, count, &mut rays.t_min);
        variates.fill(Dimension::Y, first, count, &mut rays.t_max);
        rays.direction.fill(count, |i| {
            let (row, column) = ((first + i) / self.width, (first + i) % self.width);
            self.direction(column as f32 + rays.t_min[i], row as f32 + rays.t_max[i])
        });
        rays.origin.fill(count, |_| self.eye);
        rays.t_min.fill(0.0);
        rays.t_max.fill(f32::INFINITY);
    }
}

impl RayQueue {
    /// How many rays there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.t_max.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }

    /// The point of ray `i` at `t`.
    #[must_use]
    pub fn point(&self, i: usize, t: f32) -> Vec3 {
        self.origin.at(i) + t * self.direction.at(i)
    }

    /// The queue as airlight takes it.
    #[must_use]
    pub fn rays(&self) -> Rays<'_> {
        Rays::new(self.origin.columns(), self.direction.columns(), &self.t_min, &self.t_max)
    }
}
