"""Times airlight.sample beside the same call in Rust, which takes turns with it; needs cargo.

python speed.py [--rays N] [--rounds N]
"""

import argparse
import pathlib
import subprocess
import time
from functools import partial

import airlight
import numpy as np


def best(rounds, call, repeat=1):
    """The shortest time of a call [s]."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        for _ in range(repeat):
            call()
        times.append((time.perf_counter() - start) / repeat)
    return min(times)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=int, default=1 << 20)
    parser.add_argument("--rounds", type=int, default=10)
    arguments = parser.parse_args()
    n, rounds = arguments.rays, arguments.rounds

    manifest = pathlib.Path(__file__).parent.parent / "Cargo.toml"
    cargo = ["cargo", "run", "--quiet", "--release", "--example", "speed", "--manifest-path", str(manifest), "--"]

    def rust(threads):
        """Its times, in columns that are there and in new ones."""
        command = [*cargo, str(n), str(threads), str(rounds)]
        return np.array(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split(), float)

    lamp, fog = airlight.Emitter((0, 1, 3), (0, -1, 0)), airlight.Medium(0.01, 0.1, 0.6)
    u = ((np.arange(n, dtype=np.float32) + np.float32(0.5)) / np.float32(n)).astype(np.float32)
    zero, t_max = np.zeros(n, np.float32), np.full(n, 10, np.float32)
    columns = (u, zero, zero), (np.full(n, 0.6, np.float32), zero, np.full(n, 0.8, np.float32))
    arrays = [np.stack(vector, axis=1) for vector in columns]
    cases = {
        "columns": lambda threads: airlight.sample(*columns, zero, t_max, lamp, fog, u, threads=threads),
        "t_min, t_max as numbers": lambda threads: airlight.sample(*columns, 0, 10, lamp, fog, u, threads=threads),
        "arrays (n, 3)": lambda threads: airlight.sample(*arrays, 0, 10, lamp, fog, u, threads=threads),
    }
    print(f"{n} rays, {airlight.backend}: ms, shortest of {rounds} times 4")
    for threads in (1, 2):
        least = {}
        for _ in range(4):
            times = dict(zip(["Rust, in old columns", "Rust, in new columns"], rust(threads), strict=True))
            times |= {name: best(rounds, partial(call, threads)) for name, call in cases.items()}
            least = {name: min(least.get(name, np.inf), value) for name, value in times.items()}
        for name, value in least.items():
            print(f"threads={threads}  {name:24} {1e3 * value:7.2f}  {value / least['Rust, in old columns']:.3f}")

    numbers = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, 4.0, lamp, fog, 0.25
    zero, direction, u = np.zeros((1, 3), np.float32), np.float32([[0, 0, 1]]), np.float32([0.25])
    for name, ray in {"numbers": numbers, "arrays": (zero, direction, 0.0, 4.0, lamp, fog, u)}.items():
        print(f"one ray, {name}: {1e6 * best(rounds, partial(airlight.sample, *ray), 10000):.2f} us")


if __name__ == "__main__":
    main()
