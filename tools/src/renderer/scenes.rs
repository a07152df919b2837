//! The scenes that are built in.

mod dense;
mod forward;
mod many_lights;
mod shaft;
mod spots;

use super::scene::{Light, Object, Scene, Shape};
use airlight::{Emitter, Error};
use glam::Vec3;
use std::fmt;
use std::str::FromStr;

/// Radiance of a lamp of unit colour: white beside what it lights, yet no jagged edge where that is dark.
const GLOW: f32 = 3.0;

/// Which scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// One light falls through the windows of a dark hall.
    Shaft,
    /// Lanterns over a field of spheres.
    ManyLights,
    /// Lamps that face the eye, in air that scatters forward.
    Forward,
    /// Lamps among spheres, in air that one can see a few metres through.
    Dense,
    /// Two coloured spots through the holes of a ceiling, in tinted fog.
    Spots,
}

impl Name {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Shaft, Self::ManyLights, Self::Forward, Self::Dense, Self::Spots];

    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaft => "shaft",
            Self::ManyLights => "many-lights",
            Self::Forward => "forward",
            Self::Dense => "dense",
            Self::Spots => "spots",
        }
    }

    /// The scene itself.
    ///
    /// # Errors
    /// None but those of lights and media that are none.
    pub fn scene(self) -> Result<Scene, Error> {
        match self {
            Self::Shaft => shaft::scene(),
            Self::ManyLights => many_lights::scene(),
            Self::Forward => forward::scene(),
            Self::Dense => dense::scene(),
            Self::Spots => spots::scene(),
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Name {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let named = Self::ALL.into_iter().find(|name| name.name() == text);
        named.ok_or_else(|| format!("no scene is called '{text}'; there are {}", names()))
    }
}

/// A sphere that reflects.
fn sphere(centre: Vec3, radius: f32, albedo: Vec3) -> Object {
    Object { shape: Shape::Sphere { centre, radius }, albedo, emission: Vec3::ZERO, occludes: true }
}

/// A plane without openings that reflects.
fn plane(point: Vec3, normal: Vec3, albedo: Vec3) -> Object {
    let shape = Shape::Plane { point, normal, openings: Vec::new() };
    Object { shape, albedo, emission: Vec3::ZERO, occludes: true }
}

/// A light that shines with a colour, and a globe around it for the eye.
fn lamp(position: Vec3, normal: Vec3, colour: Vec3, intensity: f32, radius: f32) -> Result<(Light, Object), Error> {
    let light = Light { emitter: Emitter::point_normal(position, normal)?, intensity: intensity * colour };
    let shape = Shape::Sphere { centre: position, radius };
    Ok((light, Object { shape, albedo: Vec3::ZERO, emission: GLOW * colour, occludes: false }))
}
