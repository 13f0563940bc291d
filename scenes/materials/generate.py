#!/usr/bin/env python3
"""Writes the shader ball and what it stands on: generate.py [FOLDER]

ball.obj takes the material on show: a sphere of radius 1 with a large smooth side, a raised ring, a groove, and a flat
cut with a bowl in it. base.obj is neutral: a pin in the bowl and a foot below, both clear of the ball by a small gap.
stage.obj is a checkered floor that bends up into a wall. Turned parts have u around and v along the profile."""

import math
import pathlib
import sys

CENTRE = (0.0, 1.22, 0.0)
LEAN = (0.42, 0.75, 0.5)  # the ball's axis: the cut looks up, to the right and to the camera
AROUND = 96
CUT, RIM = 35, 0.34  # the cut's edge in degrees from the axis; the bowl's radius at its rim
RING, RING_HEIGHT = (82, 89), 0.045
GROOVE, GROOVE_DEPTH = (96, 102), 0.08
SINK, GAP = 0.13, 0.025  # how far below the cut the pin's middle lies; between pin and bowl
BEVEL = 0.016
FOOT_GAP = 0.006
TILE, HALF_TILES, BACK, BEND, WALL = 0.5, 24, -4.0, 2.0, 7.0


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def arc(radius, start, stop, step, height=0.0):
    """(point, normal) along a circle about (0, height) on the axis; degrees from the axis."""
    count = max(1, round(abs(stop - start) / step))
    angles = [math.radians(start + (stop - start) * i / count) for i in range(count + 1)]
    return [((radius * math.sin(a), height + radius * math.cos(a)), (math.sin(a), math.cos(a))) for a in angles]


def line(a, b):
    """A straight side from a to b, with its normal to the left of that way."""
    along = unit((b[0] - a[0], b[1] - a[1]))
    normal = (-along[1], along[0])
    return [(a, normal), (b, normal)]


def trimmed(side, at_end):
    """The side, shortened by the bevel at one end."""
    points = side[::-1] if at_end else side
    left = BEVEL
    while len(points) > 2 and math.dist(points[0][0], points[1][0]) <= left:
        left -= math.dist(points[0][0], points[1][0])
        points = points[1:]
    (a, na), (b, nb) = points[:2]
    t = left / math.dist(a, b)
    cut = tuple(tuple(p + (q - p) * t for p, q in zip(*pair)) for pair in ((a, b), (na, nb)))
    points = [(cut[0], unit(cut[1]))] + points[1:]
    return points[::-1] if at_end else points


def joined(sides):
    """One profile of several sides; where two meet, a quadratic curve that touches both takes the corner's place."""
    profile = trimmed(sides[0], True)
    for n, side in enumerate(sides[1:], 2):
        side = trimmed(side, False)
        (a, na), (b, nb) = profile[-1], side[0]
        # The corner: p with (p - a) . na = 0 and (p - b) . nb = 0.
        det = na[0] * nb[1] - na[1] * nb[0]
        da, db = na[0] * a[0] + na[1] * a[1], nb[0] * b[0] + nb[1] * b[1]
        p = ((da * nb[1] - db * na[1]) / det, (na[0] * db - nb[0] * da) / det)
        for t in (0.25, 0.5, 0.75):
            point = tuple((1 - t) ** 2 * x + 2 * t * (1 - t) * y + t * t * z for x, y, z in zip(a, p, b))
            tangent = [(1 - t) * (y - x) + t * (z - y) for x, y, z in zip(a, p, b)]
            profile.append((point, unit((-tangent[1], tangent[0]))))
        profile += trimmed(side, True) if n < len(sides) else side
    return profile


def sphere_point(radius, degrees):
    a = math.radians(degrees)
    return radius * math.sin(a), radius * math.cos(a)


def pin():
    """(middle, radius) of the pin, along the ball's axis."""
    below = math.cos(math.radians(CUT)) - SINK
    return below, math.hypot(RIM, SINK) - GAP


def ball_profile():
    """From the cut's bowl over the cut and round to the far pole. The outside lies to the left."""
    high, deep = 1 + RING_HEIGHT, 1 - GROOVE_DEPTH
    middle, radius = pin()
    rim = math.degrees(math.atan2(RIM, SINK))
    bowl = [(p, (-n[0], -n[1])) for p, n in arc(radius + GAP, 180, rim, 12, middle)]
    ends = [sphere_point(r, a) for a, s, t in ((RING[0], 1, high), (RING[1], high, 1)) for r in (s, t)]
    walls = [sphere_point(r, a) for a, s, t in ((GROOVE[0], 1, deep), (GROOVE[1], deep, 1)) for r in (s, t)]
    return joined([
        bowl, line((RIM, middle + SINK), sphere_point(1, CUT)), arc(1, CUT, RING[0], 4),
        line(*ends[:2]), arc(high, *RING, 2.4), line(*ends[2:]), arc(1, RING[1], GROOVE[0], 2.4),
        line(*walls[:2]), arc(deep, *GROOVE, 2), line(*walls[2:]), arc(1, GROOVE[1], 180, 5)])


def foot_profile():
    edge = math.degrees(math.asin(0.4))
    dish = [(p, (-n[0], -n[1])) for p, n in arc(1 + FOOT_GAP, 180, 180 - edge, 6)]
    top = dish[-1][0][1]
    return joined([dish, line(dish[-1][0], (0.44, top)), line((0.44, top), (0.62, -CENTRE[1] - 0.01))])


class Obj:
    def __init__(self):
        self.lines, self.points, self.uvs = ["# Written by generate.py."], 0, 0

    def turned(self, profile, axis, centre, around, material):
        """A profile turned about an axis through `centre`. A point on the axis is one point with many u."""
        w = unit(axis)
        u = unit((w[2], 0.0, -w[0])) if abs(w[1]) < 0.999 else (1.0, 0.0, 0.0)
        v = (w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0])
        length, rows = 0.0, []
        total = sum(math.dist(a[0], b[0]) for a, b in zip(profile, profile[1:]))
        for n, ((r, h), (nr, nh)) in enumerate(profile):
            length += math.dist(profile[n - 1][0], (r, h)) if n else 0.0
            count = around if r > 1e-9 else 1
            for k in range(count):
                a = 2 * math.pi * k / around
                out = [math.cos(a) * x + math.sin(a) * y for x, y in zip(u, v)]
                p = [c + r * o + h * x for c, o, x in zip(centre, out, w)]
                d = [(nr if count > 1 else 0.0) * o + nh * x for o, x in zip(out, w)]
                self.lines += ["v " + " ".join(f"{x:.4f}" for x in p), "vn " + " ".join(f"{x:.3f}" for x in unit(d))]
            for k in range(around + 1):
                self.lines.append(f"vt {(k if count > 1 else k + 0.5) / around:.4g} {1 - length / total:.4f}")
            rows.append((self.points + 1, count, self.uvs + 1))
            self.points, self.uvs = self.points + count, self.uvs + around + 1
        self.lines.append(f"usemtl {material}")
        for (a, na, ta), (b, nb, tb) in zip(rows, rows[1:]):
            for k in range(around):
                j = k + 1
                corners = [(a + k % na, ta + k), (b + k % nb, tb + k), (b + j % nb, tb + j), (a + j % na, ta + j)]
                kept = [c for n, c in enumerate(corners) if c[0] not in [d[0] for d in corners[:n]]]
                self.lines.append("f " + " ".join(f"{i}/{t}/{i}" for i, t in kept))

    def write(self, path):
        path.write_text("\n".join(self.lines) + "\n")


def stage():
    """Squares along a profile of floor, quarter circle and wall; neighbours differ in material."""
    floor = round((HALF_TILES * TILE - BACK - BEND) / TILE)
    path = [(HALF_TILES * TILE - i * TILE, 0.0) for i in range(floor + 1)]
    bend = round(BEND * math.pi / 2 / TILE) * 3
    turns = [math.pi / 2 * i / bend for i in range(1, bend + 1)]
    path += [(BACK + BEND - BEND * math.sin(a), BEND - BEND * math.cos(a)) for a in turns]
    path += [(BACK, BEND + i * TILE) for i in range(1, round((WALL - BEND) / TILE) + 1)]
    owner = list(range(floor)) + [floor + i // 3 for i in range(bend)]
    owner += [owner[-1] + 1 + i for i in range(len(path) - 1 - len(owner))]
    across = 2 * HALF_TILES + 1
    lines = ["# Written by generate.py."]
    lines += [f"v {(k - HALF_TILES) * TILE:g} {y:.4f} {z:.4f}" for z, y in path for k in range(across)]
    for parity, material in enumerate(("tile_light", "tile_dark")):
        lines += [f"usemtl {material}", "s 1"]
        for row in range(len(path) - 1):
            for k in range(across - 1):
                if (owner[row] + k) % 2 == parity:
                    a = row * across + k + 1
                    lines.append(f"f {a} {a + 1} {a + across + 1} {a + across}")
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    ball = Obj()
    ball.turned(ball_profile(), LEAN, CENTRE, AROUND, "ball")
    ball.write(folder / "ball.obj")
    base = Obj()
    middle, radius = pin()
    base.turned(arc(radius, 0, 180, 7.5, middle), LEAN, CENTRE, 48, "grey")
    base.turned(foot_profile(), (0, 1, 0), CENTRE, 48, "grey")
    base.write(folder / "base.obj")
    (folder / "stage.obj").write_text(stage())


if __name__ == "__main__":
    main()
