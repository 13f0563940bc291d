#!/usr/bin/env python3
"""Writes drum.obj, an oil drum in metres, and stencil.png, what is painted on it: generate.py [FOLDER]"""

import math
import pathlib
import struct
import sys
import zlib

SIDES = 56


def arc(r, y, radius, begin, end, steps):
    """Points about (r, y), angles in degrees from outward to upward."""
    return [(r + radius * math.cos(math.radians(begin + (end - begin) * i / steps)),
             y + radius * math.sin(math.radians(begin + (end - begin) * i / steps)))
            for i in range(steps + 1)]


def hoop(y):
    """A rolled hoop: fillet, bulge, fillet."""
    return [(0.286, y - 0.024), (0.2868, y - 0.018)] + arc(0.286, y, 0.0115, -70, 70, 6) + \
        [(0.2868, y + 0.018), (0.286, y + 0.024)]


# Runs of the profile, from the middle of the bottom to that of the lid; smooth within, sharp between.
PROFILE = [
    [(0.0, 0.012), (0.14, 0.012), (0.276, 0.012)],
    [(0.276, 0.012), (0.279, 0.004)],
    arc(0.2865, 0.006, 0.0065, -150, 60, 6),
    [(0.28975, 0.01163), (0.286, 0.014)],
    [(0.286, 0.014), (0.286, 0.10), (0.286, 0.19)] + hoop(0.29) + [(0.286, 0.36), (0.286, 0.43), (0.286, 0.50)] +
    hoop(0.58) + [(0.286, 0.66), (0.286, 0.76), (0.286, 0.861)],
    [(0.286, 0.861), (0.28975, 0.86337)],
    arc(0.2865, 0.869, 0.0065, -60, 150, 6),
    [(0.279, 0.870), (0.277, 0.860)],
    [(0.277, 0.860), (0.20, 0.860), (0.10, 0.860), (0.0, 0.860)],
]
CAPS = [((0.175, 0.0), 0.034), ((-0.16, 0.07), 0.019)]  # bungs on the lid


def lathe(out, runs, center=(0.0, 0.0), sides=SIDES, first=1):
    length, total = 0.0, sum(math.dist(a, b) for run in runs for a, b in zip(run, run[1:]))
    for run in runs:
        rows = []
        for k, (r, y) in enumerate(run):
            if k:
                length += math.dist(run[k - 1], run[k])
            before, after = run[max(k - 1, 0)], run[min(k + 1, len(run) - 1)]
            nr, ny = after[1] - before[1], before[0] - after[0]
            scale = math.hypot(nr, ny)
            for i in range(sides + 1):
                a = 2 * math.pi * i / sides
                s, c = math.sin(a), math.cos(a)
                out.append("v %.6f %.6f %.6f" % (center[0] + r * s, y, center[1] + r * c))
                out.append("vt %.5f %.5f" % (i / sides, length / total))
                out.append("vn %.4f %.4f %.4f" % (nr / scale * s, ny / scale, nr / scale * c))
            rows.append(first)
            first += sides + 1
        for low, high in zip(rows, rows[1:]):
            for i in range(sides):
                corners = [low + i, low + i + 1, high + i + 1, high + i]
                out.append("f " + " ".join("%d/%d/%d" % (n, n, n) for n in corners))
    return first


def drum(folder):
    out = ["# by generate.py", "o drum"]
    first = lathe(out, PROFILE)
    for center, radius in CAPS:
        runs = [[(radius, 0.858), (radius, 0.869)], [(radius, 0.869), (radius - 0.004, 0.872)],
                [(radius - 0.004, 0.872), (radius * 0.55, 0.872)], [(radius * 0.55, 0.872), (radius * 0.5, 0.866)],
                [(radius * 0.5, 0.866), (0.0, 0.866)]]
        first = lathe(out, runs, center, 32, first)
    (folder / "drum.obj").write_text("\n".join(out) + "\n")


def stencil(folder, width=512, height=256):
    """A diamond and bars, white where there is paint; the alpha is the mask, frayed by a hash."""
    rows = []
    for y in range(height):
        row = bytearray([0])
        for x in range(width):
            u, v = (x + 0.5) / height, (y + 0.5) / height
            d = abs(u - 0.5) + abs(v - 0.5)
            ring = 0.40 < d < 0.46 or (d < 0.36 and (abs(u - 0.5) < 0.035 and -0.02 < 0.5 - v + 0.06 < 0.24))
            dot = math.hypot(u - 0.5, v - 0.68) < 0.042
            bars = 1.05 < u < 1.9 and any(abs(v - c) < 0.045 and u < end
                                          for c, end in ((0.22, 1.9), (0.40, 1.6), (0.58, 1.75), (0.76, 1.45)))
            h = (x * 374761393 + y * 668265263) & 0xFFFFFFFF
            h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
            paint = 255 if (ring or dot or bars) and (h >> 24) > 24 else 0
            row += bytes((238, 232, 215, paint))
        rows.append(bytes(row))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    (folder / "stencil.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    drum(target)
    stencil(target)
