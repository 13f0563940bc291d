#!/usr/bin/env python3
"""How far off the forecasts of --error are: scripts/bench/error_forecast.py [--seeds N] [--error E] [SCENE...]

Renders each scene (default: tests/error_scenes) by N seeds until E is reached, and compares what the latest look within the
first tenth of the run foretold with what came.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def curve_of(tessera, scene, seed, error, size, folder):
    """The looks at the error of one render, and whether it reached its target."""
    stats = folder / "stats.json"
    command = [tessera, "render", scene, "--seed", str(seed), "--error", str(error), "--res", size, "--aov", "beauty"]
    subprocess.run([*command, "-o", folder / "a.exr", "--stats", stats, "-q", "--no-progress"], check=True)
    found = json.loads(stats.read_text())["error"]
    return found["beauty"]["curve"], found["target"]["reached"]


def misses(curve):
    """Relative misses of samples and seconds, whether the seconds lay in the interval, and whether it was called reliable."""
    last = curve[-1]
    early = [p for p in curve if p["spp"] <= 0.1 * last["spp"]]
    if not early:
        return None
    foretold = early[-1]["forecast"]
    wall = foretold["wall"]
    return (
        abs(foretold["spp"]["value"] / last["spp"] - 1),
        abs(wall["value"] / last["wall"] - 1),
        wall["low"] <= last["wall"] <= wall["high"],
        wall["reliable"],
    )


def summary(rows):
    if not rows:
        return f"{0:5}      -        -        -        -        -"
    ninth = max(0, -(-9 * len(rows) // 10) - 1)
    samples, seconds = (sorted(r[k] for r in rows) for k in (0, 1))
    held = sum(r[2] for r in rows) / len(rows)
    numbers = (statistics.median(samples), samples[ninth], statistics.median(seconds), seconds[ninth], held)
    return f"{len(rows):5} " + " ".join(f"{100 * n:6.1f} %" for n in numbers)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--error", default="0.0005")
    parser.add_argument("--res", default="96x64")
    parser.add_argument("--tessera", default=ROOT / "build/release/bin/tessera")
    options = parser.parse_intermixed_args()
    scenes = options.scenes or sorted((ROOT / "tests/error_scenes").glob("*.toml"))
    print(f"{'':16} {'':11} samples: median, 90th  seconds: median, 90th  held")
    everything = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            rows = []
            for seed in range(1, options.seeds + 1):
                curve, reached = curve_of(options.tessera, scene, seed, options.error, options.res, pathlib.Path(folder))
                row = misses(curve) if reached else None
                if row:
                    rows.append(row)
            everything += rows
            print(f"{scene.stem:16} all      {summary(rows)}")
            print(f"{'':16} reliable {summary([r for r in rows if r[3]])}", flush=True)
    print(f"{'all':16} all      {summary(everything)}")
    print(f"{'':16} reliable {summary([r for r in everything if r[3]])}")


if __name__ == "__main__":
    main()
