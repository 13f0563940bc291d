#!/usr/bin/env python3
"""Writes board.png, the four squares that the floor repeats: generate.py [FOLDER]"""

import pathlib
import struct
import sys
import zlib

RED, YELLOW = bytes((214, 24, 20)), bytes((245, 214, 35))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(rows):
    """8-bit RGB rows to a PNG. Stored, not compressed: the same bytes from every zlib."""
    raw = b"".join(b"\0" + row for row in rows)
    width = len(rows[0]) // 3
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 0)) + chunk(b"IEND", b"")


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    # Squares of 16 texels keep their edges sharp: filtering blurs one texel, not a whole square.
    side = 16
    rows = [(RED + YELLOW if y < side else YELLOW + RED) for y in range(2 * side)]
    rows = [row[:3] * side + row[3:] * side for row in rows]
    (folder / "board.png").write_bytes(png(rows))


if __name__ == "__main__":
    main()
