#!/usr/bin/env python3
"""What the error estimate costs in time: scripts/bench/error_cost.py [--pairs N] [SCENE... and options of render]

Renders each scene with and without --no-error-estimate, in turn, and prints medians and quartiles of the ratio of CPU seconds, of wall
seconds of rendering, and of peak memory. Give the samples: scripts/bench/error_cost.py scenes/cornell/cornell.toml --spp 64
"""

import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(command, stats):
    """CPU seconds of the process, wall seconds of rendering, peak memory."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([*command, "--stats", stats, "-q", "--no-progress"], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    told = json.loads(stats.read_text())
    return cpu, told["seconds"]["render"], told["memory_bytes"]["peak"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/bin/tessera")
    o, options = parser.parse_known_args()
    print(f"{'':16} CPU seconds           wall seconds          peak memory   (with over without)")
    for scene in o.scenes:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            base = [o.tessera, "render", scene, "-o", folder / "a.exr", *options]
            ratios = []
            for pair in range(o.pairs):
                both = {}
                for without in (pair % 2, 1 - pair % 2):
                    extra = ["--no-error-estimate"] if without else []
                    both[without] = run([*base, *extra], folder / "stats.json")
                ratios.append([a / b for a, b in zip(both[0], both[1])])
            row = f"{scene.stem:16}"
            for column in zip(*ratios):
                low, middle, high = statistics.quantiles(column, n=4)
                row += f" {middle:.3f} ({low:.3f} to {high:.3f})"
            print(row)


if __name__ == "__main__":
    main()
