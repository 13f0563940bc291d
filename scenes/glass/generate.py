#!/usr/bin/env python3
"""Writes tumbler.obj, a glass of water turned on a lathe: generate.py [FOLDER]

Each surface lies between two media and faces the second: glass to air, glass to water, water to air."""

import math
import pathlib
import sys

AROUND = 48
ROUND = [math.radians(a) for a in (0, 22.5, 45, 67.5, 90)]
# (radius, height) from the middle of the foot outward, up, over the rim and down inside to the water.
OUTSIDE = [(0, 0.01), (0.24, 0.01)] + [(0.3 + 0.04 * math.sin(a), 0.04 - 0.04 * math.cos(a)) for a in ROUND]
OUTSIDE += [(0.34 + 0.06 * t / 6, 0.04 + 0.96 * t / 6) for t in range(1, 7)]
OUTSIDE += [(0.385 + 0.015 * math.cos(a), 1.0 + 0.015 * math.sin(a)) for a in ROUND[1:]]
OUTSIDE += [(0.385 - 0.015 * math.sin(a), 1.0 + 0.015 * math.cos(a)) for a in ROUND[1:]]
INSIDE = [(0.37 - 0.012 * t, 1.0 - 0.2 * t) for t in (1, 1.4)]
WET = [(0.37 - 0.012 * t, 1.0 - 0.2 * t) for t in (1.4, 2, 3, 4)]
WET += [(0.262 + 0.06 * math.cos(a), 0.16 - 0.06 * math.sin(a)) for a in ROUND] + [(0, 0.1)]
LEVEL = [(0, INSIDE[-1][1]), INSIDE[-1]]


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    lines, count = ["# Written by generate.py."], 0
    surfaces = [("glass", OUTSIDE + INSIDE), ("glass_to_water", WET), ("water", LEVEL[::-1])]
    for group, (material, profile) in enumerate(surfaces, 1):
        rings = []
        for radius, height in profile:
            points = AROUND if radius > 0 else 1
            for k in range(points):
                a = 2 * math.pi * k / AROUND
                lines.append(f"v {radius * math.cos(a):.4f} {height:.4f} {radius * math.sin(a):.4f}")
            rings.append([count + 1 + k % points for k in range(AROUND)])
            count += points
        lines += [f"usemtl {material}", f"s {group}"]
        for low, high in zip(rings, rings[1:]):
            for k in range(AROUND):
                corners = [low[k], high[k], high[k - AROUND + 1], low[k - AROUND + 1]]
                lines.append("f " + " ".join(str(c) for n, c in enumerate(corners) if c not in corners[:n]))
    (folder / "tumbler.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
