#!/usr/bin/env python3
"""Writes the traffic jam's large files: generate.py [FOLDER] [--triangles N] [--rows N]

The car is a body lofted along its length with wheel arches cut into its sides, a cabin of glass and roof over seats, and
four wheels: paint.obj is what the scene colours, rest.obj with car.mtl all else. x is across, y up, the car faces -z,
the origin lies on the road under its middle."""

import argparse
import math
import pathlib
import random
import struct

LENGTH, HALF_WIDTH, SILL, FLOOR = 4.5, 0.9, 0.24, 0.17
WHEEL_Z, WHEEL_R, TYRE_WIDTH, ARCH_R = 1.33, 0.325, 0.22, 0.385
ARCH_DEPTH = 0.32

# Side view: (z, height). The hood and deck line, and the cabin's line from the windscreen's foot over the roof.
DECK = [(-2.25, 0.62), (-2.22, 0.7), (-2.12, 0.745), (-1.6, 0.82), (-1.0, 0.89), (-0.7, 0.92),
        (0.5, 0.94), (1.4, 0.97), (1.75, 0.985), (2.1, 0.965), (2.2, 0.9), (2.25, 0.8)]
ROOF = [(-0.98, 0.88), (-0.2, 1.33), (0.05, 1.405), (0.35, 1.43), (0.8, 1.41), (1.1, 1.355),
        (1.72, 0.98)]
# Plan view: (z, half width) of the body at the shoulder.
PLAN = [(-2.25, 0.62), (-2.2, 0.74), (-2.05, 0.82), (-1.7, 0.875), (-1.0, 0.9), (1.0, 0.9), (1.7, 0.88), (2.1, 0.82),
        (2.2, 0.76), (2.25, 0.68)]

LANES = (-16.9, -13.3, -9.7, -6.1, 6.1, 9.7, 13.3, 16.9)  # middles; the road's two halves
ROAD_LENGTH = 1000.0


def along(table, z):
    """A smooth curve through the points of a table (monotone cubic, so that it does not overshoot)."""
    if z <= table[0][0]:
        return table[0][1]
    for i in range(len(table) - 1):
        (z0, a), (z1, b) = table[i], table[i + 1]
        if z > z1:
            continue
        slope = (b - a) / (z1 - z0)

        def tangent(k):
            if k == 0 or k == len(table) - 1:
                return slope
            left = (table[k][1] - table[k - 1][1]) / (table[k][0] - table[k - 1][0])
            right = (table[k + 1][1] - table[k][1]) / (table[k + 1][0] - table[k][0])
            return 0 if left * right <= 0 else 2 * left * right / (left + right)

        h, t = z1 - z0, (z - z0) / (z1 - z0)
        m0, m1 = tangent(i) * h, tangent(i + 1) * h
        return (a * (1 + 2 * t) + m0 * t) * (1 - t) ** 2 + (b * (3 - 2 * t) - m1 * (1 - t)) * t * t
    return table[-1][1]


def spread(count):
    return [i / count for i in range(count + 1)]


class Mesh:
    """Grids of points as quads of an OBJ; every grid is smooth in itself and has an edge to the next."""

    def __init__(self):
        self.points, self.faces, self.triangles = [], {}, 0
        self.group = 0

    def grid(self, material, rows, closed=False):
        self.group += 1
        first, width = len(self.points) + 1, len(rows[0])
        for row in rows:
            self.points += row
        lines = self.faces.setdefault(material, [])
        lines.append(f"s {self.group}")
        for r in range(len(rows) - 1):
            for c in range(width if closed else width - 1):
                d = (c + 1) % width
                corners = [first + r * width + c, first + r * width + d, first + (r + 1) * width + d, first + (r + 1) * width + c]
                places = [tuple(round(v, 3) for v in self.points[k - 1]) for k in corners]
                kept = [k for n, k in enumerate(corners) if places[n] not in places[:n]]
                if len(kept) >= 3:
                    lines.append("f " + " ".join(map(str, kept)))
                    self.triangles += len(kept) - 2

    def both(self, material, rows, closed=False):
        """The grid and its mirror image across the middle of the car."""
        self.grid(material, rows, closed)
        self.grid(material, [[(-x, y, z) for x, y, z in reversed(row)] for row in rows], closed)

    def text(self, library):
        def number(value):
            return f"{value:.3f}".rstrip("0").rstrip(".").replace("-0.", "-.").removeprefix("0") or "0"

        lines = ["# Written by generate.py.", f"mtllib {library}"] if library else ["# Written by generate.py."]
        lines += ["v " + " ".join(number(value + 0.0) for value in p) for p in self.points]
        for material, faces in self.faces.items():
            lines += [f"usemtl {material}", *faces] if library else faces
        return "\n".join(lines) + "\n"


class Car:
    def __init__(self, detail):
        self.detail = detail
        self.paint, self.rest = Mesh(), Mesh()
        self.body()
        self.cabin()
        self.inside()
        self.wheels()
        self.fittings()

    def n(self, count):
        return max(2, round(count * self.detail))

    def stations(self):
        """z along the body: even, and close together around the arches."""
        edge = [z for w in (-WHEEL_Z, WHEEL_Z) for z in (w - ARCH_R - 0.012, w + ARCH_R + 0.012)]
        places = []
        spans = [(-LENGTH / 2, -2.1, 5), (-2.1, edge[0], 4), (edge[0], edge[1], 20), (edge[1], edge[2], 16), (edge[2], edge[3], 20), (edge[3], 2.1, 4), (2.1, LENGTH / 2, 5)]
        for a, b, count in spans:
            steps = spread(self.n(count))
            if count == 20:  # the arch: even in angle
                steps = [0.5 - 0.5 * math.cos(math.pi * t) for t in steps]
            places += [a + (b - a) * t for t in steps][: None if b == LENGTH / 2 else -1]
        return places

    def bottom(self, z):
        """The lower edge of the side: the sill, or the arch over a wheel."""
        d = min(abs(z - WHEEL_Z), abs(z + WHEEL_Z))
        ends = SILL + 0.05 * max(0, (abs(z) - 2.0) / 0.25) ** 2
        return max(ends, WHEEL_R + math.sqrt(ARCH_R**2 - d * d)) if d < ARCH_R else ends

    def section(self, z):
        """Points from the lower edge up the side, over the shoulder, to the middle of the deck."""
        wide, top, low = along(PLAN, z), along(DECK, z), self.bottom(z)
        shoulder = top - 0.07
        side = []
        for t in spread(self.n(12)):
            y = low + (shoulder - low) * t
            h = (y - 0.55) / 0.45  # fullest at bumper height, drawn in below and above
            crease = 0.012 * math.exp(-(((y - 0.72) / 0.03) ** 2))
            flare = 0.0
            d = min(abs(z - WHEEL_Z), abs(z + WHEEL_Z))
            if d < ARCH_R + 0.1:
                rim = math.hypot(d, max(0.0, y - WHEEL_R)) - ARCH_R
                flare = 0.018 * max(0.0, 1 - max(0.0, rim) / 0.09) ** 2
            side.append((wide - 0.05 * h * h + crease + flare, y, z))
        x0 = side[-1][0]
        for t in spread(self.n(5))[1:]:
            a = t * math.pi / 2
            side.append((x0 - 0.1 * (1 - math.cos(a)), shoulder + 0.055 * math.sin(a), z))
        x1 = side[-1][0]
        over = [(x1 * (1 - t), top - 0.015 * (1 - t) ** 2, z) for t in spread(self.n(8))[1:]]
        return side + over

    def body(self):
        places = self.stations()
        sections = [self.section(z) for z in places]
        self.paint.both("paint", sections)
        # Nose and tail: from the outline of the end to its middle, bulging.
        for section, way in ((sections[0], -1), (sections[-1], 1)):
            rows = []
            middle = 0.5 * (section[0][1] + section[-1][1])
            for t in spread(self.n(5)):
                row = [(x * (1 - t), middle + (y - middle) * (1 - t), z + way * 0.05 * (1 - (1 - t) ** 2)) for x, y, z in section]
                rows.append(row[::-1] if way > 0 else row)
            self.paint.both("paint", [r[::-1] for r in rows] if way < 0 else [r[::-1] for r in rows])
        # Arches and floor in black plastic.
        inner = [[(x - ARCH_DEPTH * t, y, z) for t in spread(1)] for x, y, z in (s[0] for s in sections)]
        self.rest.both("plastic", [row[::-1] for row in inner])
        self.rest.grid("plastic", [[(-row[1][0], row[1][1], row[1][2]), (row[1][0], row[1][1], row[1][2])] for row in inner])

    def cabin_section(self, z):
        """Half a cabin section, from the belt up to the middle of the roof, and where the window ends."""
        belt, roof = along(DECK, z) - 0.03, along(ROOF, z)
        foot = along(PLAN, z) - 0.13
        high = max(0.0, roof - belt)
        lean = 0.36 * high
        n = self.n(10)
        points = []
        for t in spread(n):
            points.append((foot - lean * t * 0.86 - 0.03 * t * t, belt + (high - 0.055) * t, z))
        x0, y0, _ = points[-1]
        for t in spread(self.n(9))[1:]:
            a = t * math.pi / 2
            points.append((x0 * (1 - math.sin(a) ** 1.6) if t < 1 else 0.0, y0 + (roof - y0) * math.sin(a) ** 0.85, z))
        return points

    def cabin(self):
        first, last = ROOF[0][0], ROOF[-1][0]
        n = self.n(10)
        # Columns of glass and of pillars along the side: windscreen, A, front door, B, rear door, C, rear window.
        front, rear = -0.16, 1.1
        cuts = [(front, -0.02, "paint"), (-0.02, 0.48, "glass"), (0.48, 0.57, "trim"), (0.57, 1.02, "glass"), (1.02, rear, "paint")]
        for a, b, material in cuts:
            rows = [self.cabin_section(a + (b - a) * t) for t in spread(self.n(max(2, (b - a) * 18)))]
            sides = [row[: n + 1] for row in rows]
            mesh = self.paint if material == "paint" else self.rest
            mesh.both(material, sides)
        count = self.n(26)
        rows = [self.cabin_section(front + (rear - front) * t) for t in spread(count)]
        self.paint.both("paint", [row[n:] for row in rows])
        self.screen(first, front, 1)
        self.screen(rear, last, -1)

    def screen(self, a, b, way):
        """Windscreen or rear window: the cabin's ends, with the pillars painted at their edges."""
        rows = [self.cabin_section(a + (b - a) * t) for t in spread(self.n(12))]
        n = self.n(10)
        keep = n - max(1, round(n * 0.2))
        low = [row[: n + 1] for row in rows]
        # Seen from the front, the side of such a section is the pillar with the door's corner, the top of it the screen.
        corner = [row for row in low]
        self.paint.both("paint", [r[keep:] for r in corner])
        self.rest.both("glass", [r[: keep + 1] for r in corner])
        self.rest.both("glass", [row[n:] for row in rows])

    def inside(self):
        def box(middle, half, round_off=0.05):
            """A cushion: a box with round edges."""
            rows = []
            for v in spread(self.n(6)):
                lat = math.pi * (v - 0.5)
                row = []
                for u in range(4 * self.n(3)):
                    lon = 2 * math.pi * u / (4 * self.n(3))
                    d = (math.cos(lat) * math.cos(lon), math.sin(lat), math.cos(lat) * math.sin(lon))
                    p = [math.copysign(abs(c) ** 0.35, c) * h for c, h in zip(d, half)]
                    row.append(tuple(m + q for m, q in zip(middle, p)))
                rows.append(row[::-1])
            self.rest.grid("seat", rows[::-1], True)

        for x in (-0.37, 0.37):
            box((x, 0.5, 0.28), (0.25, 0.1, 0.25))
            box((x, 0.78, 0.52), (0.24, 0.3, 0.07))
            box((x, 1.13, 0.54), (0.13, 0.08, 0.05))
        box((0, 0.5, 1.05), (0.62, 0.1, 0.22))
        box((0, 0.76, 1.28), (0.62, 0.26, 0.07))
        box((0, 0.74, -0.62), (0.66, 0.13, 0.25))
        self.rest.grid("seat", [[(-0.7, 0.4, z), (0.7, 0.4, z)] for z in (1.4, -0.7)])

    def lathe(self, material, profile, middle, side):
        """A profile of (offset along the axle, radius) turned about the axle; it faces outward."""
        around = self.n(26)
        rows = []
        for offset, radius in profile:
            row = []
            for i in range(around):
                a = 2 * math.pi * i / around
                row.append((middle[0] + side * offset, middle[1] + radius * math.cos(a), middle[2] + radius * math.sin(a)))
            rows.append(row if side > 0 else row[::-1])
        self.rest.grid(material, rows, True)

    def wheels(self):
        w = TYRE_WIDTH / 2
        tyre = [(w - 0.03, 0.205), (w, 0.225), (w + 0.004, 0.26), (w - 0.012, 0.3), (w - 0.04, WHEEL_R - 0.005), (w - 0.07, WHEEL_R), (0.07 - w, WHEEL_R), (0.04 - w, WHEEL_R - 0.005), (0.012 - w, 0.3), (-w, 0.225)]
        rim = [(w - 0.11, 0.0), (w - 0.11, 0.19), (w - 0.05, 0.195), (w - 0.018, 0.2), (w - 0.018, 0.21), (w - 0.03, 0.212)]
        hub = [(w - 0.03, 0.0), (w - 0.03, 0.035), (w - 0.045, 0.055), (w - 0.11, 0.06)]
        for side in (-1, 1):
            for z in (-WHEEL_Z, WHEEL_Z):
                middle = (side * (HALF_WIDTH - w - 0.035), WHEEL_R, z)
                self.lathe("tyre", tyre[::-1], middle, side)
                self.lathe("rim_dark", rim[:2][::-1], middle, side)
                self.lathe("rim", rim[1:][::-1], middle, side)
                self.lathe("rim", hub[::-1], middle, side)
                self.spokes(middle, side, w)

    def spokes(self, middle, side, w):
        for k in range(5):
            a = 2 * math.pi * k / 5 + 0.3
            c, s = math.cos(a), math.sin(a)
            rows = []
            for t in spread(self.n(3)):
                radius, half = 0.04 + 0.158 * t, 0.027 - 0.006 * t
                out = w - 0.035 - 0.012 * t
                row = [(-half, out - 0.05), (-half * 0.8, out), (half * 0.8, out), (half, out - 0.05)]
                points = [(middle[0] + side * o, middle[1] + radius * c - h * s, middle[2] + radius * s + h * c) for h, o in row]
                rows.append(points if side < 0 else points[::-1])
            self.rest.grid("rim", rows)

    def patch(self, material, z, x0, x1, y0, y1, out=0.012):
        """A plate that follows the nose or tail at a small distance: a lamp, a grille, a number plate."""
        way = -1 if z < 0 else 1
        end = LENGTH / 2
        across = sorted((half, abs(at)) for at, half in PLAN if at * z > 0 and abs(at) > 1.6)
        upward = sorted((high, abs(at)) for at, high in DECK if at * z > 0 and abs(at) > 2.05)
        wide, low, top = across[0][0], self.bottom(end), upward[0][0]

        def depth(x, y):
            """Where the body is at (x, y), seen from its end."""
            u, v = abs(x) / wide, abs(2 * y - low - top) / (top - low)
            bulge = 0.05 * max(0.0, 1 - max(u, v) ** 2)
            return min(along(across, abs(x)) if u > 1 else end, along(upward, y) if y > top else end) + bulge + out

        nx, ny = self.n(8), self.n(4)
        rows = []
        for y in (y0 + (y1 - y0) * v for v in spread(ny)):
            row = [(x, y, way * depth(x, y)) for x in (x0 + (x1 - x0) * u for u in spread(nx))]
            rows.append(row if way > 0 else row[::-1])
        self.rest.grid(material, rows)
        # A rim that closes the gap to the body.
        loop = rows[0] + [r[-1] for r in rows[1:]] + rows[-1][-2::-1] + [r[0] for r in rows[-2:0:-1]]
        self.rest.grid(material, [loop, [(x, y, z1 - way * 0.16) for x, y, z1 in loop]][::-1], True)

    def fittings(self):
        front, rear = -LENGTH / 2, LENGTH / 2
        for side in (-1, 1):
            a, b = sorted((side * 0.47, side * 0.76))
            self.patch("headlamp", front, a, b, 0.565, 0.665)
            a, b = sorted((side * 0.45, side * 0.78))
            self.patch("taillamp", rear, a, b, 0.7, 0.84)
            # Mirrors.
            rows = []
            for v in spread(self.n(6)):
                lat = math.pi * (v - 0.5)
                row = []
                for u in range(self.n(12)):
                    lon = 2 * math.pi * u / self.n(12)
                    row.append((side * 0.93 + 0.1 * math.cos(lat) * math.cos(lon), 0.98 + 0.065 * math.sin(lat), -0.5 + 0.05 * math.cos(lat) * math.sin(lon)))
                rows.append(row[::-1])
            self.paint.grid("paint", rows[::-1], True)
        self.patch("grille", front, -0.42, 0.42, 0.575, 0.655, 0.004)
        self.patch("grille", front, -0.55, 0.55, 0.29, 0.4, 0.004)
        self.patch("plate", front, -0.26, 0.26, 0.44, 0.54, 0.016)
        self.patch("plate", rear, -0.26, 0.26, 0.55, 0.66, 0.016)
        self.patch("plastic", rear, -0.6, 0.6, 0.3, 0.42, 0.004)


def car(triangles):
    """The car nearest to a number of triangles."""
    low, high = 0.2, 12.0
    for _ in range(14):
        middle = math.sqrt(low * high)
        made = Car(middle)
        if made.paint.triangles + made.rest.triangles < triangles:
            low = middle
        else:
            high = middle
    return made


def road():
    """Asphalt, dashed lines, barrier and verge."""
    mesh = Mesh()
    end = ROAD_LENGTH / 2 + 60

    def strip(material, x0, x1, y, z0=-end, z1=end):
        mesh.grid(material, [[(x0, y, z), (x1, y, z)] for z in (z1, z0)])

    for side in (-1, 1):
        a, b = sorted((side * 1.6, side * 22.0))
        strip("asphalt", a, b, 0.0)
        a, b = sorted((side * 22.0, side * 400.0))
        strip("grass", a, b, -0.05)
        for x in (4.2, 18.8):
            strip("line", side * x - 0.1, side * x + 0.1, 0.004)
        for x in (7.9, 11.5, 15.1):
            for k in range(int(-end / 12), int(end / 12)):
                strip("line", side * x - 0.075, side * x + 0.075, 0.004, 12.0 * k, 12.0 * k + 6)
    strip("grass", -1.6, 1.6, -0.05)
    profile = [(-0.3, 0), (-0.28, 0.08), (-0.12, 0.33), (-0.08, 0.85), (0.08, 0.85), (0.12, 0.33), (0.28, 0.08), (0.3, 0)]
    for a, b in zip(profile, profile[1:]):
        mesh.grid("concrete", [[(a[0], a[1], z), (b[0], b[1], z)] for z in (end, -end)])
    return mesh


def placements(rows):
    """Per colour the cars of the jam, as rows of 3x4."""
    dice = random.Random(1886)
    names = ["white", "silver", "grey", "black", "blue", "red", "green", "sand"]
    weights = [22, 18, 18, 20, 9, 7, 3, 3]
    cars = {name: [] for name in names}
    for x in LANES:
        z = -ROAD_LENGTH / 2 + dice.uniform(0, 4)
        for _ in range(rows):
            turn = dice.gauss(0, 0.012) + (math.pi if x < 0 else 0)
            c, s = math.cos(turn), math.sin(turn)
            size = dice.uniform(0.96, 1.05)
            tall = size * dice.uniform(0.98, 1.06)
            where = x + dice.gauss(0, 0.16)
            name = dice.choices(names, weights)[0]
            cars[name].append((size * c, 0, size * s, where, 0, tall, 0, 0, -size * s, 0, size * c, z))
            z += 6.2 + min(6.0, dice.expovariate(0.9))
    return cars


def sky():
    """A clear sky with haze over a dull ground, as a Radiance picture of 128 by 64."""
    width, height = 128, 64
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode())
    for y in range(height):
        up = math.sin(math.pi * (0.5 - (y + 0.5) / height))
        if up > 0:
            t = up**0.45
            colour = [h * (1 - t) + z * t for h, z in zip((0.95, 0.97, 1.0), (0.16, 0.33, 0.72))]
        else:
            colour = (0.2, 0.2, 0.19)
        mantissa, exponent = math.frexp(max(colour))
        scale = mantissa * 256 / max(colour)
        data += bytes([*(int(c * scale) for c in colour), exponent + 128]) * width
    return bytes(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    parser.add_argument("--triangles", type=int, default=12000, help="of the car (about)")
    parser.add_argument("--rows", type=int, default=130, help="cars in each of the eight lanes")
    options = parser.parse_args()
    made = car(options.triangles)
    (options.folder / "paint.obj").write_text(made.paint.text(""))
    (options.folder / "rest.obj").write_text(made.rest.text("car.mtl"))
    (options.folder / "road.obj").write_text(road().text("car.mtl"))
    (options.folder / "sky.hdr").write_bytes(sky())
    for name, cars in placements(options.rows).items():
        data = b"".join(struct.pack("<12f", *row) for row in cars)
        (options.folder / f"{name}.f32").write_bytes(data)
    print(f"car: {made.paint.triangles + made.rest.triangles} triangles; {8 * options.rows} cars")


if __name__ == "__main__":
    main()
