"""Single scattering in fog: Mitsuba 3 traces the rays, airlight samples the distances, numpy adds up.

The picture is compared with that of Mitsuba's own `volpath` at equal time. All surfaces are black, so that what `volpath`
sees with two segments is single scattering too.

    pip install ./bindings/python[mitsuba] && python bindings/python/examples/mitsuba_fog.py --help

The vectorised variant of Mitsuba needs libLLVM; DRJIT_LIBLLVM_PATH names it (Debian: package libllvm19; on a CPU with
AVX-512 versions 14 and 15 cannot compile the scene). Without it the scalar one is used, ray by ray.
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

import drjit as dr  # noqa: E402
from mitsuba import ScalarTransform4f as To  # noqa: E402

MU_A, MU_S, G = 0.1, 0.6, 0.5
FOG = airlight.Medium(MU_A, MU_S, G)
LAMP_AT, LAMP_SIZE, LAMP_RADIANCE = (0, 0.5, -0.3), 0.4, (90, 65, 35)
# Position, direction, intensity; and degrees from the axis to where it is dark, and up to where it is bright.
SPOTS = [((-0.6, 0.6, -0.4), (0.3, -1, -0.1), (18, 10, 4)), ((0.6, 0.65, -0.3), (-0.3, -1, -0.1), (4, 10, 18))]
CUTOFF, BEAM = 25, 15
# Rays of a pixel in one pass, and pixels along the side of a tile.
SPP, TILE = 16, 8


def scene(lights, size):
    """A box of 2 m with two blocks in it, black and full of fog; the camera is inside, above the lamp's back."""
    black = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": 0}}
    to_world = To().look_at(origin=(0, 0.6, 0.95), target=(0, -0.2, -1), up=(0, 1, 0))
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
            "medium": {"type": "ref", "id": "fog"},
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
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": LAMP_RADIANCE}},
        }
    else:
        for k, (position, towards, intensity) in enumerate(SPOTS):
            parts[f"spot{k}"] = {
                "type": "spot",
                "to_world": To().look_at(origin=position, target=np.add(position, towards), up=(0, 0, 1)),
                "cutoff_angle": CUTOFF,
                "beam_width": BEAM,
                "intensity": {"type": "rgb", "value": intensity},
            }
    return mi.load_dict(parts)


def for_all(function, *columns):
    """The results of a function of numbers, for all rows at once, or one after the other in the scalar variant."""
    if "scalar" not in mi.variant():
        return [np.from_dlpack(result) for result in function(*map(mi.Float, columns))]
    rows = [function(*map(float, row)) for row in zip(*columns, strict=True)]
    return [np.array(column, np.float32) for column in zip(*rows, strict=True)]


class Tracer:
    """What Mitsuba does for airlight: primary rays, points on emitters, shadows."""

    def __init__(self, scene):
        self.scene = scene
        self.camera = scene.sensors()[0]

    def primary(self, x, y):
        """The rays through points of the film: origin, direction, and where they end."""
        ray, _ = self.camera.sample_ray(0, 0.5, mi.Point2f(x, y), mi.Point2f(0.5))
        return *ray.o, *ray.d, self.scene.ray_intersect(ray).t

    def occluded(self, *ends):
        """Whether something is between two points; 1 or 0."""
        start, end = mi.Point3f(*ends[:3]), mi.Point3f(*ends[3:])
        distance = dr.norm(end - start)
        ray = mi.Ray3f(start, (end - start) / distance, distance * (1 - 1e-4), 0, [])
        return (dr.select(self.scene.ray_test(ray), mi.Float(1), mi.Float(0)),)


class AreaLamp:
    """A point of it for each ray: its intensity is radiance times area."""

    def __init__(self, emitter):
        self.shape = emitter.get_shape()
        self.colour = np.multiply(LAMP_RADIANCE, LAMP_SIZE**2)

    def emitters(self, rng, n):
        """Positions, and what airlight knows of them."""
        position_normal = for_all(self.point, *rng.random((2, n), np.float32))
        position, normal = tuple(position_normal[:3]), tuple(position_normal[3:])
        return position, airlight.Emitters.each(position, normal)

    def point(self, u, v):
        sample = self.shape.sample_position(0, mi.Point2f(u, v))
        return *sample.p, *sample.n

    def falloff(self, _):
        return 1


class Spot:
    """A spot of Mitsuba, whose falloff is linear in the angle: what airlight does not know of it is a factor."""

    def __init__(self, emitter, spot):
        self.emitter = emitter
        self.position, axis, self.colour = spot
        edge = np.cos(np.radians(CUTOFF))
        self.known = airlight.Emitter.spot(self.position, axis / np.linalg.norm(axis), edge, edge)

    def emitters(self, _, n):
        return tuple(np.full(n, x, np.float32) for x in self.position), self.known

    def falloff(self, points):
        return for_all(self.share, *points)[0]

    def share(self, *point):
        """The share of the intensity that goes to a point."""
        interaction = dr.zeros(mi.SurfaceInteraction3f)
        interaction.p = mi.Point3f(*point)
        sample, light = self.emitter.sample_direction(interaction, mi.Point2f(0))
        return (light[0] * dr.square(sample.dist) / self.colour[0],)


def lamps(scene, lights):
    if lights == "area":
        return [AreaLamp(emitter) for emitter in scene.emitters()]
    return [Spot(emitter, spot) for emitter, spot in zip(scene.emitters(), SPOTS, strict=True)]


def airlight_pass(tracer, lights, size, seed):
    """A picture with SPP rays for each pixel, and for each of them one distance for each lamp."""
    rng = np.random.default_rng(seed)
    n = size * size * SPP
    pixel = np.arange(n) // SPP
    x, y = (np.stack([pixel % size, pixel // size]) + rng.random((2, n), np.float32)) / np.float32(size)
    *ray, t_max = for_all(tracer.primary, x.astype(np.float32), y.astype(np.float32))
    origin, direction = tuple(ray[:3]), tuple(ray[3:])
    picture = 0
    for lamp in lights:
        position, emitters = lamp.emitters(rng, n)
        samples = airlight.sample(origin, direction, 0, t_max, emitters, FOG, rng.random(n, np.float32))
        points = [o + samples.t * d for o, d in zip(origin, direction, strict=True)]
        occluded = for_all(tracer.occluded, *points, *position)[0]
        light = samples.weight * (1 - occluded) * lamp.falloff(points)
        picture = picture + light.reshape(size, size, SPP).mean(axis=2)[..., None] * lamp.colour
    return picture


def volpath_pass(scene, integrator, seed):
    """A picture by Mitsuba itself, with SPP rays for each pixel."""
    return np.array(mi.render(scene, integrator=integrator, spp=SPP, seed=seed))


class Pictures:
    """The mean of many passes, and the means of tiles of each pass."""

    def __init__(self, render, seconds, seed):
        # Seeds that follow each other make passes of Mitsuba that are not quite independent.
        seeds = np.random.default_rng(seed)
        render(0)  # compiles
        self.sum, self.tiles, start = 0, [], time.perf_counter()
        while len(self.tiles) < 2 or time.perf_counter() - start < seconds:
            picture = render(int(seeds.integers(1 << 32)))
            side = len(picture) // TILE
            self.sum = self.sum + picture
            self.tiles.append(picture.reshape(side, TILE, side, TILE, 3).mean(axis=(1, 3, 4)))
        self.seconds = time.perf_counter() - start

    @property
    def mean(self):
        return self.sum / len(self.tiles)

    def mean_and_variance_of_tiles(self):
        return np.mean(self.tiles, axis=0), np.var(self.tiles, axis=0, ddof=1) / len(self.tiles)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", choices=["area", "spots"], default="area")
    parser.add_argument("--size", type=int, default=128, help=f"pixels along a side, a multiple of {TILE}")
    parser.add_argument("--time", type=float, default=5, help="seconds for each of the two pictures")
    parser.add_argument("--reference", type=float, default=60, help="seconds for each of the two references")
    parser.add_argument("--out", default="mitsuba_fog", help="start of the names of the pictures")
    arguments = parser.parse_args()
    size = arguments.size

    world = scene(arguments.scene, size)
    tracer, lights = Tracer(world), lamps(world, arguments.scene)
    integrator = mi.load_dict({"type": "volpath", "max_depth": 2})
    renderers = {
        "airlight": lambda seed: airlight_pass(tracer, lights, size, seed),
        "volpath": lambda seed: volpath_pass(world, integrator, seed),
    }
    print(f"{mi.variant()}, {size} x {size}, {arguments.scene}; airlight {airlight.__version__}, {airlight.backend}")
    references = {name: Pictures(render, arguments.reference, seed=1) for name, render in renderers.items()}
    reference = references["airlight"].mean

    # In darkness next to none of the light is, a relative error says little.
    bright = reference > 0.1 * np.median(reference[reference > 0])
    rmse, relative = {}, {}
    for name, render in renderers.items():
        pictures = Pictures(render, arguments.time, seed=2)
        error = (pictures.mean - reference) ** 2
        rmse[name] = np.sqrt(error.mean()) / reference.mean()
        relative[name] = np.sqrt(np.mean(error[bright] / reference[bright] ** 2))
        effort = f"{pictures.seconds:5.1f} s {SPP * len(pictures.tiles):6} rays/pixel"
        print(f"{name:8} {effort}  RMSE {rmse[name]:.4f} of the mean, {relative[name]:.4f} relative")
        mi.util.write_bitmap(f"{arguments.out}-{name}.png", pictures.mean.astype(np.float32))
    ratios = [(errors["volpath"] / errors["airlight"]) ** 2 for errors in (rmse, relative)]
    print(f"equal time: volpath has {ratios[0]:.1f} times the squared error, {ratios[1]:.1f} times the relative one")

    # Where single rays bring most of the light, as at the tip of a cone, variances of so few passes mean nothing.
    (a, var_a), (b, var_b) = (references[name].mean_and_variance_of_tiles() for name in renderers)
    known = (var_a < (0.05 * a) ** 2) & (var_b < (0.05 * b) ** 2)
    z = (a - b)[known] / np.sqrt((var_a + var_b)[known])
    largest, rms = abs(z).max(), np.sqrt(np.mean(z**2))
    print(f"references, {z.size} of {known.size} tiles known to 5 %: max |z| {largest:.2f}, rms {rms:.2f}")
    assert largest < 4, "the two do not agree"


if __name__ == "__main__":
    main()
