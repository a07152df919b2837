from collections.abc import Sequence
from typing import final

from numpy import uint32
from numpy.typing import ArrayLike, NDArray

from . import Channels, Floats, Vectors

__all__ = [
    "Emitter",
    "Emitters",
    "Media",
    "Medium",
    "backend",
    "cdf",
    "choose",
    "evaluate",
    "forked",
    "pdf",
    "radiance",
    "sample",
    "version",
]

version: str
backend: str

@final
class Emitter:
    """A point that lights the medium: alike in all directions, as a piece of a surface, or into a cone (`spot`).

    position: (3,), where it is [m].
    normal: (3,), of unit length: it shines to that side alone, with the cosine. None: alike in all directions.
    """

    def __new__(cls, position: ArrayLike, normal: ArrayLike | None = None) -> Emitter: ...
    @staticmethod
    def spot(position: ArrayLike, axis: ArrayLike, cos_outer: float, cos_inner: float) -> Emitter:
        """A point that shines into the cone around the unit vector `axis`.

        Dark beyond the angle of cosine `cos_outer`, in full up to that of `cos_inner`, 0 <= cos_outer <= cos_inner <= 1. In
        between the intensity falls off as `s^2 (3 - 2 s)`, with `s` linear in the cosine.
        """

    @property
    def position(self) -> tuple[float, float, float]: ...
    @property
    def normal(self) -> tuple[float, float, float] | None: ...
    @property
    def cone(self) -> tuple[tuple[float, float, float], float, float] | None:
        """Axis, cos_outer and cos_inner of a spot."""

@final
class Emitters:
    """An emitter for each ray."""

    @staticmethod
    def each(position: Vectors, normal: Vectors | None = None) -> Emitters:
        """From columns: (n, 3) or a tuple of three; the normal (0, 0, 0) stands for none."""

    @staticmethod
    def each_spot(position: Vectors, axis: Vectors, cos_outer: ArrayLike, cos_inner: ArrayLike) -> Emitters:
        """Spots among them: both cosines are -1 where the emitter is no spot, and its axis a normal."""

    @staticmethod
    def table(table: Sequence[Emitter], index: ArrayLike) -> Emitters:
        """`table[index[i]]` for ray i; an index out of range makes its ray invalid."""

@final
class Medium:
    """A homogeneous medium with the Henyey-Greenstein phase function.

    mu_a, mu_s: absorption and scattering coefficient [1/m]; one number, or one for each of 3 or 4 channels.
    g: mean cosine of the scattering angle, from -1 to 1; g > 0 scatters forward.
    """

    def __new__(cls, mu_a: ArrayLike, mu_s: ArrayLike, g: float) -> Medium: ...
    @property
    def mu_a(self) -> float | tuple[float, ...]: ...
    @property
    def mu_s(self) -> float | tuple[float, ...]: ...
    @property
    def g(self) -> float: ...
    @property
    def channels(self) -> int: ...

@final
class Media:
    """A medium for each ray."""

    @staticmethod
    def each(mu_a: Channels, mu_s: Channels, g: ArrayLike) -> Media:
        """From columns: (n,) each, or one number; mu_a and mu_s of coloured media (n, c) or a tuple of c columns."""

    @staticmethod
    def table(table: Sequence[Medium], index: ArrayLike) -> Media:
        """`table[index[i]]` for ray i; an index out of range makes its ray invalid."""

_Scene = tuple[Vectors, Vectors, ArrayLike, ArrayLike, Emitter | Emitters, Medium | Media]
_Counts = tuple[int, int, int, int]

def sample(
    scene: _Scene, u: ArrayLike, strategy: str, precision: str, threads: int | None, weight: bool, r: bool
) -> tuple[Floats, Floats, Floats | None, Floats | None, _Counts]: ...
def pdf(scene: _Scene, t: ArrayLike, strategy: str, precision: str, threads: int | None) -> Floats: ...
def cdf(scene: _Scene, t: ArrayLike, strategy: str, precision: str, threads: int | None) -> Floats: ...
def evaluate(scene: _Scene, t: ArrayLike, precision: str, threads: int | None) -> Floats: ...
def radiance(scene: _Scene, nodes: int, precision: str, threads: int | None) -> Floats: ...
def choose(
    scene: _Scene,
    table: Sequence[Emitter],
    weights: ArrayLike,
    u: ArrayLike,
    nodes: int,
    precision: str,
    threads: int | None,
) -> tuple[NDArray[uint32], Floats, _Counts]: ...
def forked() -> None: ...
