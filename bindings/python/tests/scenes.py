"""Random rays, as `tests/dependent` of the library makes them."""

from typing import NamedTuple

import airlight
import numpy as np

RAYS = 20_003


class Columns(NamedTuple):
    """Columns of float32, a few of them of bad rays."""

    origin: tuple
    direction: tuple
    t_min: np.ndarray
    t_max: np.ndarray
    position: tuple
    normal: tuple
    medium: tuple
    u: np.ndarray

    def scene(self, rays):
        """The arguments of a call for the first rays."""

        def first(columns):
            return tuple(column[:rays] for column in columns)

        emitters = airlight.Emitters.each(first(self.position), first(self.normal))
        media = airlight.Media.each(*first(self.medium))
        return first(self.origin), first(self.direction), self.t_min[:rays], self.t_max[:rays], emitters, media


def columns():
    """The same ones at every call: 18 variates for each ray."""
    state, bits = 1, []
    for _ in range(18 * RAYS):
        state = (state * 6_364_136_223_846_793_005 + 1_442_695_040_888_963_407) % 2**64
        bits.append(state >> 40)
    uniform = np.array(bits, np.float32).reshape(RAYS, 18).T / np.float32(2**24)
    i = np.arange(RAYS)

    def point(first):
        return uniform[first : first + 3] * np.float32(10) - np.float32(5)

    def unit(v):
        return v / np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])

    direction, normal = unit(point(3)), unit(point(9))
    normal[:, i % 7 == 0] = 0
    direction[:, i % 501 == 0] = np.nan
    t_min = uniform[12]
    t_max = np.where(i % 11 == 0, np.float32(np.inf), t_min + np.float32(9) * uniform[13])
    medium = uniform[14], uniform[15], np.float32(2) * uniform[16] - np.float32(1)
    vectors = tuple(map(tuple, (point(0), direction)))
    return Columns(*vectors, t_min, t_max, tuple(point(6)), tuple(normal), medium, uniform[17])
