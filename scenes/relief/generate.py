#!/usr/bin/env python3
"""Writes ball.obj, a cube of quads blown up to the unit sphere, to be subdivided: generate.py [FOLDER]"""

import math
import pathlib
import sys

SIDE = 12  # quads along an edge of the cube


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    lines, known, faces = ["# Written by generate.py."], {}, []

    def point(at):
        if at not in known:
            p = [math.tan(math.pi / 4 * (2 * c / SIDE - 1)) for c in at]  # even angles across a side
            length = math.sqrt(sum(c * c for c in p))
            lines.append("v " + " ".join(f"{c / length:.5f}" for c in p))
            known[at] = len(known) + 1
        return known[at]

    for axis in range(3):
        for side in (0, SIDE):
            for v in range(SIDE):
                for u in range(SIDE):
                    corners = [(u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)]
                    if side == 0:
                        corners.reverse()
                    at = [{axis: side, (axis + 1) % 3: a, (axis + 2) % 3: b} for a, b in corners]
                    faces.append("f " + " ".join(str(point((c[0], c[1], c[2]))) for c in at))
    (folder / "ball.obj").write_text("\n".join([*lines, "s 1", *faces]) + "\n")


if __name__ == "__main__":
    main()
