"""Results are those of Rust, to the bit, in whatever form the arguments come."""

import pathlib

import airlight
import numpy as np
import pytest
import scenes

GOLDEN = pathlib.Path(__file__).parents[3] / "tests/golden/bits.txt"
LINES = [line.split() for line in GOLDEN.read_text().splitlines()]
# Of x86-64 with fused multiply-add and of AArch64; and of others.
ROUNDINGS = {"fused", "plain"}


@pytest.fixture(scope="module")
def columns():
    return scenes.columns()


@pytest.mark.parametrize(("strategy", "precision"), [line[1:3] for line in LINES if line[0] == "fused"])
def test_bits_are_those_that_the_library_is_tested_for(columns, strategy, precision):
    """The hash of `tests/golden.rs`: all functions, several variates, few rays and many."""
    options = {"strategy": strategy, "precision": precision}
    parts = []
    for rays, per_ray in [(scenes.RAYS, 1), (scenes.RAYS, 3), (1, 5000), (5, 33), (40, 7)]:
        u = np.resize(columns.u, rays * per_ray).reshape(rays, per_ray)
        scene = columns.scene(rays)
        less = airlight.sample(*scene, u, **options, weight=False, r=False)
        samples = airlight.sample(*scene, u, **options)
        assert (less.weight, less.r, less.counts) == (None, None, samples.counts)
        parts += [less.t, less.pdf, *samples[:4]]
        parts += [f(*scene, samples.t, **options) for f in (airlight.pdf, airlight.cdf)]
        parts.append(airlight.evaluate(*scene, samples.t, precision=precision))
        parts += [airlight.radiance(*scene, nodes=nodes) for nodes in (4, 6, 8, 12)]

    scene = (0, 0, 0), (0, 0, 1), 0, 4, airlight.Emitter((0, 1, 3), (0, -1, 0)), airlight.Medium(0.01, 0.1, 0.6)
    one = airlight.sample(*scene, 0.25, **options)
    pdf, integrand = airlight.pdf(*scene, one.t, **options), airlight.evaluate(*scene, one.t, precision=precision)
    parts += [*one[:4], pdf, integrand]

    golden = {rounding: digits for rounding, *sampler, digits in LINES if sampler == [strategy, precision]}
    assert f"{fnv1a(parts):016x}" in {golden[rounding] for rounding in ROUNDINGS}
    ROUNDINGS.intersection_update({rounding for rounding in ROUNDINGS if golden[rounding] == f"{fnv1a(parts):016x}"})


def fnv1a(parts):
    """The hash FNV-1a of arrays of float32."""
    digest = 0xCBF2_9CE4_8422_2325
    for byte in b"".join(np.asarray(part, "<f4").tobytes() for part in parts):
        digest = (digest ^ byte) * 0x100_0000_01B3 & 0xFFFF_FFFF_FFFF_FFFF
    return digest


def equal(samples, others):
    arrays = zip(samples[:4], others[:4], strict=True)
    return samples.counts == others.counts and all(np.array_equal(a, b) for a, b in arrays)


def test_arrays_of_rows_are_as_columns(columns):
    origin, direction, *rest = columns.scene(scenes.RAYS)
    expected = airlight.sample(origin, direction, *rest, columns.u)
    for dtype in (np.float32, np.float64):
        rows = [np.stack(vector, axis=1).astype(dtype) for vector in (origin, direction)]
        assert equal(airlight.sample(*rows, *rest, columns.u), expected)


def test_no_bit_depends_on_the_number_of_threads(columns):
    scene = columns.scene(scenes.RAYS)
    expected = airlight.sample(*scene, columns.u, threads=1)
    for threads in (2, 3, None):
        assert equal(airlight.sample(*scene, columns.u, threads=threads), expected)


def test_what_is_one_for_all_rays_is_as_repeated(columns):
    n = 1000
    lamp, fog = airlight.Emitter((1, 2, 3), (0, 0, -1)), airlight.Medium(0.1, 0.3, 0.6)
    direction = tuple(column[:n] for column in columns.direction)
    samples = airlight.sample((1, 2, 3.5), direction, 0.5, np.inf, lamp, fog, 0.25)

    def full(*values):
        return tuple(np.full(n, value, np.float32) for value in values)

    lamps, air = airlight.Emitters.each(full(1, 2, 3), full(0, 0, -1)), airlight.Media.each(*full(0.1, 0.3, 0.6))
    repeated = airlight.sample(full(1, 2, 3.5), direction, *full(0.5, np.inf), lamps, air, *full(0.25))
    assert samples.t.shape == (n,) and equal(samples, repeated)

    lamps, air = airlight.Emitters.table([lamp, lamp], np.arange(n) % 2), airlight.Media.table([fog], np.zeros(n, int))
    assert equal(airlight.sample((1, 2, 3.5), direction, 0.5, np.inf, lamps, air, 0.25), samples)


@pytest.mark.parametrize(("rays", "per_ray"), [(300_001, 1), (140_000, 3), (1, 200_001)])
def test_large_batches_that_are_converted_part_by_part_are_as_columns_in_place(columns, rays, per_ray):
    def long(column):
        return np.resize(column, rays)

    origin, direction = (tuple(map(long, vector)) for vector in (columns.origin, columns.direction))
    t_max, g = long(columns.t_max), long(columns.medium[2])
    u = np.resize(columns.u, (rays, per_ray))
    index = np.arange(rays, dtype=np.uint32) % 2
    lamps = [airlight.Emitter((1, 2, 3)), airlight.Emitter((-1, 2, 0), (0, 1, 0))]
    full = np.full(rays, 0.5, np.float32)
    in_place = airlight.Emitters.table(lamps, index), airlight.Media.each(full, full, g)
    expected = airlight.sample(origin, direction, full, t_max, *in_place, u)
    rows = [np.stack(vector, axis=1) for vector in (origin, direction)]
    converted = airlight.Emitters.table(lamps, index.astype(np.int64)), airlight.Media.each(0.5, 0.5, g)
    assert equal(airlight.sample(*rows, 0.5, t_max, *converted, u), expected)
    pdf = airlight.pdf(*rows, 0.5, t_max, *converted, expected.t)
    assert np.array_equal(pdf, airlight.pdf(origin, direction, full, t_max, *in_place, expected.t))
    if rays > 1:
        repeated = airlight.sample(origin, direction, full, t_max, *in_place, np.resize(u[:1], u.shape))
        assert equal(airlight.sample(*rows, 0.5, t_max, *converted, u[:1]), repeated)


def test_the_largest_batches_in_place_go_in_parts_too():
    n = (1 << 22) + 5
    zero, one, u = np.zeros(n, np.float32), np.ones(n, np.float32), np.linspace(0, 1, n, dtype=np.float32)
    lamp, fog = airlight.Emitter((0, 1, 3)), airlight.Medium(0.1, 0.3, 0.6)
    arguments = (zero, zero, zero), (zero, zero, one), zero, one, lamp, fog
    samples = airlight.sample(*arguments, u, weight=False, r=False)
    last = airlight.sample((0, 0, 0), (0, 0, 1), 0, 1, lamp, fog, u[-9:])
    assert samples.counts.sampled == n and np.array_equal(samples.t[-9:], last.t)
