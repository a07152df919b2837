"""What is returned means what the documentation says."""

import pathlib

import airlight
import numpy as np
import pytest

LAMP, FOG = airlight.Emitter((0, 1, 3), (0, -1, 0)), airlight.Medium(0.01, 0.1, 0.6)
SCENE = (0, 0, 0), (0, 0, 1), 0, 4, LAMP, FOG


def test_the_mean_of_weights_is_the_radiance():
    u = (np.arange(1000) + 0.5) / 1000
    samples = airlight.sample(*SCENE, u)
    assert samples.weight.mean() == pytest.approx(airlight.radiance(*SCENE), rel=1e-4)
    assert samples.weight * samples.pdf == pytest.approx(airlight.evaluate(*SCENE, samples.t), rel=1e-5)
    assert samples.r == pytest.approx(np.hypot(1, 3 - samples.t), rel=1e-5)


def test_cdf_goes_back_to_u_and_pdf_is_its_density():
    u = np.linspace(0.01, 0.99, 99, dtype=np.float32)
    samples = airlight.sample(*SCENE, u)
    assert airlight.cdf(*SCENE, samples.t) == pytest.approx(u, abs=1e-6)
    assert airlight.pdf(*SCENE, samples.t) == pytest.approx(samples.pdf, rel=1e-5)
    assert airlight.pdf(*SCENE, [-1.0, 5.0]).tolist() == [0, 0]


def test_choices_are_in_proportion_to_what_each_emitter_adds():
    lamps, weights = [LAMP, airlight.Emitter((1, 0, 2)), airlight.Emitter((0, 0, -50))], [2.0, 0.5, 0.0]
    parts = np.array([w * airlight.radiance(*SCENE[:4], lamp, FOG) for lamp, w in zip(lamps, weights, strict=True)])
    u = np.linspace(0, 1, 101)
    index, probability, counts = airlight.choose(*SCENE[:4], lamps, weights, FOG, u)
    assert counts.sampled == 101 and index.dtype == np.uint32 and set(index) == {0, 1}
    assert probability == pytest.approx((parts / parts.sum())[index], rel=1e-3)
    assert (np.diff(index.astype(int)) >= 0).all()


def test_bad_rays_get_zeros_and_disturb_no_neighbour():
    good = airlight.sample(*SCENE, [0.25, 0.75])
    u = [0.25, np.nan, 0.75, 2.0, 0.5]
    t_max = [4, 4, 4, 4, 0]
    samples = airlight.sample(*SCENE[:3], t_max, LAMP, FOG, u)
    assert samples.counts == (2, 1, 2, 0)
    for values, kept in zip(samples[:4], good[:4], strict=True):
        assert values.tolist() == [kept[0], 0, kept[1], 0, 0]
    tables = airlight.Emitters.table([LAMP], [0, -1, 1, 2**32]), airlight.Media.table([FOG], 0)
    assert airlight.sample(*SCENE[:4], *tables, 0.5).counts == (1, 0, 3, 0)


def test_objects_tell_what_they_are():
    spot = airlight.Emitter.spot((0, 1, 2), (0, 0, 1), 0.5, 0.75)
    assert spot.cone == ((0, 0, 1), 0.5, 0.75) and spot.normal is None
    assert LAMP.normal == (0, -1, 0) and LAMP.cone is None and LAMP.position == (0, 1, 3)
    colour = airlight.Medium(0.25, (0.5, 1, 2), -0.5)
    assert (colour.mu_a, colour.mu_s, colour.g, colour.channels) == ((0.25,) * 3, (0.5, 1, 2), -0.5, 3)
    assert (FOG.channels, airlight.Medium([0.5], 0.25, 0).mu_a) == (1, 0.5)
    for thing in (spot, LAMP, airlight.Emitter((1, 2, 3)), colour, FOG):
        assert eval(f"airlight.{thing!r}") == thing
    assert spot != LAMP


def test_version_is_that_of_the_library():
    manifest = (pathlib.Path(__file__).parents[3] / "Cargo.toml").read_text()
    assert f'\nversion = "{airlight.__version__}"\n' in manifest


@pytest.mark.parametrize("channels", [3, 4])
def test_coloured_media_have_a_weight_for_each_channel(channels):
    mu_a, mu_s = np.linspace(0.1, 0.4, channels), np.linspace(0.3, 0.0, channels)
    colour = airlight.Medium(mu_a, mu_s, 0.6)
    scene = *SCENE[:5], colour
    u = (np.arange(3000).reshape(3, 1000) + 0.5) / 3000
    samples, radiance = airlight.sample(*scene, u), airlight.radiance(*scene)
    assert samples.weight.shape == (3, 1000, channels) and radiance.shape == (channels,)
    assert samples.weight.mean(axis=(0, 1)) == pytest.approx(radiance, rel=1e-3)
    integrands = airlight.evaluate(*scene, samples.t)
    assert samples.weight * samples.pdf[..., None] == pytest.approx(integrands, rel=1e-5)
    for c in range(channels):
        grey = *SCENE[:5], airlight.Medium(mu_a[c], mu_s[c], 0.6)
        assert radiance[c] == pytest.approx(airlight.radiance(*grey), rel=1e-4)
        assert integrands[..., c] == pytest.approx(airlight.evaluate(*grey, samples.t), rel=1e-5)

    none = airlight.sample(*scene, u, weight=False)
    assert none.weight is None and np.array_equal(none.r, samples.r)
    each = [
        airlight.Media.each(tuple(mu_a), tuple(mu_s), 0.6),
        airlight.Media.each(np.tile(mu_a, (3, 1)), mu_s[None], np.full(3, 0.6)),
        airlight.Media.table([colour], [0, 0, 0]),
    ]
    for media in each:
        assert np.array_equal(airlight.sample(*SCENE[:5], media, u).weight, samples.weight)
    assert airlight.sample(*scene, 0.5).weight.shape == (channels,)


def test_spots_light_their_cone():
    spots = [airlight.Emitter.spot((0, 1, 3), (0, -1, 0), 0.5, 0.75), airlight.Emitter((1, 2, 3), (0, -1, 0))]
    cosines = [0.5, -1], [0.75, -1]
    table = airlight.Emitters.table(spots, [0, 1])
    each = airlight.Emitters.each_spot([[0, 1, 3], [1, 2, 3]], (0, -1, 0), *cosines)
    u = np.random.default_rng(3).random((2, 1000))
    samples = airlight.sample(*SCENE[:4], table, FOG, u)
    assert np.array_equal(samples.weight, airlight.sample(*SCENE[:4], each, FOG, u).weight)
    assert samples.weight.mean(axis=1) == pytest.approx(airlight.radiance(*SCENE[:4], table, FOG), rel=1e-2)
    inside = samples.t[0] > 3 - np.sqrt(3)
    assert inside.all()
