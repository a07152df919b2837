//! Inputs that break renderers do not break this one: every bound holds on every family, and what is not a number or
//! beyond all range comes out finite, in range and counted.

use airlight::{Sampler, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::bounds::bounds;
use airlight_tools::errors::Errors;
use airlight_tools::families::Family;

const RAYS: usize = 1 << 14;

fn holds(family: Family) {
    let mut backends = 0;
    for backend in distinct() {
        backends += 1;
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy).with_backend(backend);
            let errors = Errors::measure(&sampler, family, RAYS, 201, |_| ());
            assert!(errors.sampled > RAYS / 40, "{strategy}: {} of {RAYS} rays sampled", errors.sampled);
            for bound in bounds(strategy, family) {
                let (figure, value, limit) = (bound.figure, (bound.read)(&errors), bound.limit);
                assert!(
                    bound.holds(&errors),
                    "{strategy} on {}, {}: {figure} {value:e} exceeds {limit:e}; worst {:?}",
                    family.name(),
                    backend.name(),
                    errors.worst
                );
            }
        }
    }
    assert!(backends > 0, "no backend was run");
}

#[test]
fn variates_at_the_ends_of_the_unit_interval() {
    holds(Family::Variate);
}

#[test]
fn emitters_on_the_ray() {
    holds(Family::NearEmitter);
}

#[test]
fn emitters_far_away() {
    holds(Family::FarAway);
}

#[test]
fn rays_without_end() {
    holds(Family::InfiniteRays);
}

#[test]
fn intervals_of_nanoradians() {
    holds(Family::ShortIntervals);
}

#[test]
fn emitters_that_turn_away() {
    holds(Family::Cosine);
}

#[test]
fn phase_functions_up_to_their_poles() {
    holds(Family::Phase);
}

#[test]
fn media_from_vacuum_to_ink() {
    holds(Family::Medium);
}

#[test]
fn rays_that_are_hardly_any() {
    holds(Family::Ray);
}

#[test]
fn arbitrary_bits() {
    holds(Family::RandomBits);
}
