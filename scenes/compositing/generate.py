#!/usr/bin/env python3
"""Writes still_life.obj, a vase and a candle turned on a lathe before a swept backdrop: generate.py [FOLDER]"""

import math
import pathlib
import sys

AROUND = 48
# (radius, height), from the middle of the foot outward and up.
VASE = [(0, 0), (0.13, 0), (0.15, 0.02), (0.14, 0.05), (0.19, 0.12), (0.255, 0.24), (0.275, 0.36), (0.25, 0.48),
        (0.185, 0.58), (0.12, 0.66), (0.095, 0.74), (0.105, 0.82), (0.145, 0.88), (0.15, 0.895), (0.14, 0.9),
        (0.09, 0.82), (0.08, 0.74), (0.1, 0.66), (0.16, 0.57), (0.2, 0.4), (0, 0.3)]
CANDLE = [(0, 0), (0.13, 0), (0.135, 0.006), (0.135, 0.4), (0.128, 0.418), (0.115, 0.42), (0.07, 0.405), (0, 0.4)]
FLAME = [(0, 0.43), (0.03, 0.436), (0.052, 0.458), (0.06, 0.49), (0.055, 0.525), (0.04, 0.57), (0.02, 0.62), (0, 0.66)]
# (z, height) of the backdrop: floor, quarter of a circle, wall.
SWEEP = [(4, 0), (-0.7, 0)] + [(-0.7 - 0.9 * math.sin(a), 0.9 - 0.9 * math.cos(a))
                               for a in (math.radians(7.5 * k) for k in range(1, 13))] + [(-1.6, 4)]


def rounded(profile):
    """A Catmull-Rom spline through the points, four steps between two of them."""
    ends = [profile[0], *profile, profile[-1]]
    points = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for t in (0, 0.25, 0.5, 0.75):
            points.append(tuple(
                p1 + 0.5 * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)))
                for p0, p1, p2, p3 in zip(a, b, c, d)))
    return [(max(r, 0), h) for r, h in points] + [profile[-1]]


def lathe(lines, count, name, material, profile, x, z):
    """Adds a turned thing; returns the number of vertices so far."""
    lines += [f"o {name}", f"usemtl {material}", "s 1"]
    rings = []
    for radius, height in profile:
        points = AROUND if radius > 0 else 1
        for k in range(points):
            a = 2 * math.pi * k / AROUND
            lines.append(f"v {x + radius * math.cos(a):.4f} {height:.4f} {z + radius * math.sin(a):.4f}")
        rings.append([count + 1 + k % points for k in range(AROUND)])
        count += points
    for low, high in zip(rings, rings[1:]):
        for k in range(AROUND):
            corners = [low[k], high[k], high[k - AROUND + 1], low[k - AROUND + 1]]
            lines.append("f " + " ".join(str(c) for n, c in enumerate(corners) if c not in corners[:n]))
    return count


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    lines = ["# Written by generate.py."]
    count = lathe(lines, 0, 'vase "bleu"', "blue glaze", rounded(VASE), -0.42, -0.28)
    count = lathe(lines, count, "bougie allumée", "cire dorée", CANDLE, 0.2, -0.2)
    count = lathe(lines, count, "flame", "flame", rounded(FLAME), 0.2, -0.2)
    lines += ["o backdrop", "usemtl paper", "s 1"]
    for z, height in SWEEP:
        lines += [f"v -5 {height:.4f} {z:.4f}", f"v 5 {height:.4f} {z:.4f}"]
    for k in range(len(SWEEP) - 1):
        a = count + 2 * k + 1
        lines.append(f"f {a} {a + 1} {a + 3} {a + 2}")
    (folder / "still_life.obj").write_text("\n".join(lines) + "\n", "utf-8")


if __name__ == "__main__":
    main()
