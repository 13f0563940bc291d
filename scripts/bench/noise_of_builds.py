#!/usr/bin/env python3
"""How noisy two builds are at equal samples: scripts/bench/noise_of_builds.py OTHER_TESSERA [--seeds N] [--spp N] [SCENE...]

Squared error and relMSE of this build over those of the other one, against a reference of many samples, with 95 % intervals over
seeds. It measured what the four replicates of a picture cost, against the last build without them (docs/error.md).
"""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def render(tessera, scene, out, seed, spp, size):
    command = [tessera, "render", scene, "-o", out, "--seed", str(seed), "--spp", str(spp), "--res", size]
    subprocess.run([*command, "--aov", "beauty", "--float", "-q", "--no-progress"], check=True)


def metrics(tessera, pictures, reference):
    """(value, standard error) of the squared error and of relMSE, means over the pictures."""
    names = ",".join(str(p) for p in pictures)
    found = subprocess.run(
        [tessera, "compare", names, reference, "--json", "-"],
        check=True,
        capture_output=True,
    )
    of = json.loads(found.stdout)["layers"][0]["a"]["metrics"]
    rows = []
    for name, power in (("rmse", 2), ("relmse", 1)):
        m = of[name]
        half = (m["high"] - m["low"]) / 2
        rows.append((m["value"] ** power, power * m["value"] ** (power - 1) * half))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference-spp", type=int, default=16384)
    parser.add_argument("--res", default="48x32")
    parser.add_argument("--tessera", type=pathlib.Path, default=ROOT / "build/release/bin/tessera")
    o = parser.parse_intermixed_args()
    logs = ([], [])
    print(f"{'':16} squared error           relMSE        (this build over the other)")
    for scene in o.scenes or sorted((ROOT / "tests/error_scenes").glob("*.toml")):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            render(o.tessera, scene, folder / "reference.exr", 999983, o.reference_spp, o.res)
            sides = []
            for side, program in enumerate((o.tessera, o.other)):
                pictures = [folder / f"{side}_{seed}.exr" for seed in range(1, o.seeds + 1)]
                for seed, picture in enumerate(pictures, 1):
                    render(program, scene, picture, seed, o.spp, o.res)
                sides.append(metrics(o.tessera, pictures, folder / "reference.exr"))
        text = ""
        for k, ((a, da), (b, db)) in enumerate(zip(*sides)):
            spread = math.hypot(da / a, db / b)
            logs[k].append(math.log(a / b))
            text += f"  {a / b:6.3f} ({a / b * math.exp(-spread):5.3f} to {a / b * math.exp(spread):5.3f})"
        print(f"{scene.stem:16}{text}", flush=True)
    print(f"{'geometric mean':16}" + "".join(f"  {math.exp(sum(v) / len(v)):6.3f}" + " " * 17 for v in logs))


if __name__ == "__main__":
    main()
