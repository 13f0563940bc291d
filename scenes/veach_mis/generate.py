#!/usr/bin/env python3
"""Writes plates.obj, four plates each tilted to mirror the lights into the camera: generate.py [FOLDER]"""

import math
import pathlib
import sys

CAMERA = (1.4, 14.0)  # y, z of veach_mis.toml
LIGHTS = (3.0, -1.5)
PLATES = [(-0.3, -0.6), (-0.95, 0.9), (-1.6, 2.6), (-2.35, 4.4)]  # their middles, from the back
HALF_WIDTH, HALF_DEPTH = 4.0, 0.72


def towards(a, b):
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    return (b[0] - a[0]) / length, (b[1] - a[1]) / length


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    lines = ["# Written by generate.py."]
    for number, middle in enumerate(PLATES):
        a, b = towards(middle, CAMERA), towards(middle, LIGHTS)
        # The normal halves the angle; the plate runs across it, forward and down.
        y, z = towards((0, 0), (a[0] + b[0], a[1] + b[1]))
        dy, dz = -z * HALF_DEPTH, y * HALF_DEPTH
        lines += [f"o plate{number + 1}", f"usemtl plate{number + 1}"]
        for x, s in ((-1, 1), (1, 1), (1, -1), (-1, -1)):
            lines.append(f"v {x * HALF_WIDTH:g} {middle[0] + s * dy:.4f} {middle[1] + s * dz:.4f}")
        lines.append("f -4 -3 -2 -1")
    (folder / "plates.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
