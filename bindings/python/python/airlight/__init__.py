"""Scattering distances along rays for single scattering in homogeneous media, sampled in batches.

Lengths are in metres, coefficients per metre. Every function takes rays, an emitter and a medium:

origin, direction
    Where the rays start and where they go, of unit length: an array of shape (n, 3), or three columns x, y, z in a tuple or
    as attributes of these names; of shape (3,), or a tuple of three numbers, for all rays.
t_min, t_max
    (n,), the part of the ray that lies in the medium, from 0 on; t_max may be inf. One number is that of all rays.
emitter
    An Emitter, or one for each ray: Emitters.
medium
    A Medium, or one for each ray: Media.

In coloured media, whose mu_a and mu_s are of 3 or 4 channels, weights, integrands and radiances have an axis more, the
last, with one value for each channel.

Contiguous arrays of float32 are read where they lie, columns of them fastest; other dtypes, float64 among them, and other
strides are converted. Arrays of other libraries come by DLPack, or as numpy takes them. Results are float32.

A malformed call raises ValueError, or TypeError for an object of another kind, and names the argument. A bad ray (a NaN,
a direction that is none) is no error: its results are 0, and it is counted.

While a call runs, so do other threads of Python; they must not write to its arguments. Results are the same to the bit
for any number of threads, and the same as those of Rust.
"""

import os
from collections.abc import Sequence
from typing import Literal, NamedTuple

from numpy import float32, uint32
from numpy.typing import ArrayLike, NDArray

from . import _airlight
from ._airlight import Emitter, Emitters, Media, Medium

Floats = NDArray[float32]
Vectors = ArrayLike | tuple[ArrayLike, ArrayLike, ArrayLike]
Channels = ArrayLike | tuple[ArrayLike, ...]
Strategy = Literal[
    "transmittance",
    "equi-angular",
    "point-normal",
    "taylor-transmittance",
    "taylor-phase",
    "product-3",
    "product-5",
    "product-9",
    "product-17",
]
Precision = Literal["exact", "fast"]
Nodes = Literal[4, 6, 8, 12]

__all__ = [
    "Choice",
    "Counts",
    "Emitter",
    "Emitters",
    "Media",
    "Medium",
    "Samples",
    "backend",
    "cdf",
    "choose",
    "evaluate",
    "pdf",
    "radiance",
    "sample",
]

__version__: str = _airlight.version

backend: str = _airlight.backend
"""The instructions that calls use here: "avx512", "avx2" or "portable"."""

# The threads of a pool are not in a forked process: there calls stay on the calling thread.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_airlight.forked)


class Counts(NamedTuple):
    """What became of the rays; of several variates for each ray every one counts."""

    sampled: int
    """Those with a sample."""
    empty: int
    """Valid ones without: t_min = t_max, or nothing of the ray is lit."""
    invalid: int
    """Those with a value that is NaN or out of range."""
    bisected: int
    """Of the sampled, those whose iteration fell back to bisection, or took many steps."""


class Samples(NamedTuple):
    """What `sample` returns: arrays of float32 of the shape of `u`, 0 where there is no sample.

    The weights of coloured media have one axis more, of the channels.
    """

    t: Floats
    """Distances along the rays [m]."""
    pdf: Floats
    """Probability densities over distance [1/m]."""
    weight: Floats | None
    """`mu_s T rho N / (r^2 pdf)` [1/m^2]: times the emitter's intensity, an estimate of the ray's radiance."""
    r: Floats | None
    """Distances from the samples to the emitters [m], exact also where `t` cannot resolve them."""
    counts: Counts


class Choice(NamedTuple):
    """What `choose` returns: arrays of the shape of `u`, 0 where nothing lights the ray."""

    index: NDArray[uint32]  # type: ignore[assignment]
    """Which emitter of the table, uint32."""
    probability: Floats
    """With which probability, float32."""
    counts: Counts


def sample(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    emitter: Emitter | Emitters,
    medium: Medium | Media,
    u: ArrayLike,
    *,
    strategy: Strategy = "product-5",
    precision: Precision = "exact",
    threads: int | None = None,
    weight: bool = True,
    r: bool = True,
) -> Samples:
    """Draw a distance along each ray for each variate.

    Rays, emitter and medium are described in `help(airlight)`.

    u
        (n,) or (n, k), uniform variates in [0, 1]. The k variates of a ray share the set-up of its density. The inverse
        is monotone: stratified and low-discrepancy variates keep their evenness.
    strategy
        The density; "product-5" follows nearly the whole integrand, those with more points have less variance.
    precision
        "exact", or "fast" for "equi-angular", "point-normal", "product-5" and "product-9".
    threads
        At most so many threads; 1 is the calling one, None is one per core.
    weight, r
        Whether these are computed; None is returned else.
    """
    scene = (origin, direction, t_min, t_max, emitter, medium)
    samples = _airlight.sample(scene, u, strategy, precision, threads, weight, r)
    return Samples(*samples[:4], Counts(*samples[4]))


def pdf(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    emitter: Emitter | Emitters,
    medium: Medium | Media,
    t: ArrayLike,
    *,
    strategy: Strategy = "product-5",
    precision: Precision = "exact",
    threads: int | None = None,
) -> Floats:
    """The density of `sample` at distances `t` [m], (n,) or (n, k), for multiple importance sampling.

    Returns an array of the shape of `t` [1/m]: 0 outside the sampled interval and for bad rays.
    """
    scene = (origin, direction, t_min, t_max, emitter, medium)
    return _airlight.pdf(scene, t, strategy, precision, threads)


def cdf(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    emitter: Emitter | Emitters,
    medium: Medium | Media,
    t: ArrayLike,
    *,
    strategy: Strategy = "product-5",
    precision: Precision = "exact",
    threads: int | None = None,
) -> Floats:
    """The distribution function of `sample` at distances `t` [m], (n,) or (n, k): from t back to u.

    Returns an array of the shape of `t`: 0 before the sampled interval, 1 beyond it, and 0 for bad rays.
    """
    scene = (origin, direction, t_min, t_max, emitter, medium)
    return _airlight.cdf(scene, t, strategy, precision, threads)


def evaluate(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    emitter: Emitter | Emitters,
    medium: Medium | Media,
    t: ArrayLike,
    *,
    precision: Precision = "exact",
    threads: int | None = None,
) -> Floats:
    """The integrand `mu_s T rho N / r^2` at distances `t` [m], (n,) or (n, k).

    Returns an array of the shape of `t` [1/m^3]: 0 outside [t_min, t_max] and for bad rays.
    """
    scene = (origin, direction, t_min, t_max, emitter, medium)
    return _airlight.evaluate(scene, t, precision, threads)


def radiance(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    emitter: Emitter | Emitters,
    medium: Medium | Media,
    *,
    nodes: Nodes = 8,
    precision: Precision = "exact",
    threads: int | None = None,
) -> Floats:
    """The single-scattered radiance of each ray per unit of the emitter's intensity, where nothing casts a shadow.

    It is the mean of the weights of `sample`, by quadrature with `nodes` evaluations for each ray.

    Returns an array of shape (n,) [1/m^2]: 0 for bad rays.
    """
    scene = (origin, direction, t_min, t_max, emitter, medium)
    return _airlight.radiance(scene, nodes, precision, threads)


def choose(
    origin: Vectors,
    direction: Vectors,
    t_min: ArrayLike,
    t_max: ArrayLike,
    table: Sequence[Emitter],
    weights: ArrayLike,
    medium: Medium | Media,
    u: ArrayLike,
    *,
    nodes: Nodes = 4,
    precision: Precision = "exact",
    threads: int | None = None,
) -> Choice:
    """Choose an emitter of a table for each ray, in proportion to its weight times its `radiance`.

    table
        A list of Emitter.
    weights
        One for each emitter, such as its intensity; 0 or more.
    u
        (n,), uniform variates in [0, 1], independent of those that distances are then sampled with.

    `Emitters.table(table, index)` are the chosen ones, for `sample`. Intensity times weight over probability then is an
    estimate of the radiance.
    """
    if len(table) == 0:
        raise ValueError("table is empty")
    scene = (origin, direction, t_min, t_max, table[0], medium)
    index, probability, counts = _airlight.choose(scene, table, weights, u, nodes, precision, threads)
    return Choice(index, probability, Counts(*counts))
