"""Single scattering in fog: Mitsuba 3 traces the rays, airlight samples the distances, numpy adds up.

The picture is compared with that of Mitsuba's own `volpath` at equal time. All surfaces are black, so that what `volpath`
sees with two segments is single scattering too.

    pip install ./bindings/python[mitsuba] && python bindings/python/examples/mitsuba_fog.py --help

The vectorised variant of Mitsuba needs libLLVM; DRJIT_LIBLLVM_PATH names it. Without it the scalar one is used.
"""

import argparse
import time

import airlight
import mitsuba as mi
import numpy as np

for variant in ("llvm_ad_rgb", "scalar_rgb"):
    try:
        mi.set_variant(variant)
        mi.Float(0) + 1
        break
    except (ImportError, RuntimeError) as error:
        print(f"{variant}: {error}")

from mitsuba import ScalarTransform4f as To  # noqa: E402

MU_A, MU_S, G = 0.1, 0.6, 0.5
FOG = airlight.Medium(MU_A, MU_S, G)
LAMP_AT, LAMP_SIZE = (0, 0.9, -0.1), 0.3
SPOTS = [((-0.8, 0.9, 0.3), (0.3, -1, -0.8)), ((0.8, 0.9, 0.1), (-0.2, -1, -0.6))]
CUTOFF, BEAM = 25, 15


def scene(lights, size):
    """A box of 2 m with two blocks in it, black and full of fog; the camera is inside and sees no light."""
    black = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": 0}}
    to_world = To().look_at(origin=(0, -0.1, 0.95), target=(0, -0.2, -1), up=(0, 1, 0))
    film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}, "pixel_format": "rgb"}
    parts = {
        "type": "scene",
        "fog": {
            "type": "homogeneous",
            "albedo": MU_S / (MU_A + MU_S),
            "sigma_t": MU_A + MU_S,
            "phase": {"type": "hg", "g": G},
        },
        "camera": {
            "type": "perspective",
            "fov": 65,
            "to_world": to_world,
            "film": film,
            "fog": {"type": "ref", "id": "fog"},
        },
        "box": {"type": "cube", "bsdf": black},
        "tall": {
            "type": "cube",
            "to_world": To().translate((-0.35, -0.4, -0.45)).rotate((0, 1, 0), 17).scale((0.28, 0.6, 0.28)),
            "bsdf": black,
        },
        "short": {
            "type": "cube",
            "to_world": To().translate((0.4, -0.7, 0)).rotate((0, 1, 0), -16).scale((0.28, 0.3, 0.28)),
            "bsdf": black,
        },
    }
    if lights == "area":
        parts["lamp"] = {
            "type": "rectangle",
            "to_world": To().translate(LAMP_AT).rotate((1, 0, 0), 90).scale(LAMP_SIZE / 2),
            "bsdf": black,
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": (17, 12, 6)}},
        }
    else:
        for k, (position, towards) in enumerate(SPOTS):
            parts[f"spot{k}"] = {
                "type": "spot",
                "to_world": To().look_at(origin=position, target=np.add(position, towards), up=(0, 0, 1)),
                "cutoff_angle": CUTOFF,
                "beam_width": BEAM,
                "intensity": {"type": "rgb", "value": [(9, 5, 2), (2, 5, 9)][k]},
            }
    return mi.load_dict(parts)


def for_all(function, *columns):
    """The results of a function of numbers, for all rows at once, or one after the other in the scalar variant."""
    if "scalar" not in mi.variant():
        return tuple(np.asarray(result) for result in function(*map(mi.Float, columns)))
    return tuple(np.float32(result) for result in zip(*(function(*map(float, row)) for row in zip(*columns))))
