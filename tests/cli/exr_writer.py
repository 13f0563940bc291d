"""Writes small uncompressed EXR files, whatever values they are to have."""

import struct

CODES = {"uint": (0, "I"), "half": (1, "e"), "float": (2, "f")}


def _attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def exr_bytes(channels, width, height, window=None, display=None, kind="float", texts=None):
    """channels: name -> values, rows from the top; window, display: x0, y0, x1, y1 (the last ones included)."""
    window = window or (0, 0, width - 1, height - 1)
    display = display or (0, 0, width - 1, height - 1)
    code, letter = CODES[kind]
    names = sorted(channels)
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iiii", code, 0, 1, 1) for n in names) + b"\0"
    header = b"\x76\x2f\x31\x01" + struct.pack("<i", 2)
    header += _attribute("channels", "chlist", listed)
    header += _attribute("compression", "compression", b"\0")
    header += _attribute("dataWindow", "box2i", struct.pack("<4i", *window))
    header += _attribute("displayWindow", "box2i", struct.pack("<4i", *display))
    header += _attribute("lineOrder", "lineOrder", b"\0")
    header += _attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += _attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += _attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    for name, text in (texts or {}).items():
        header += _attribute(name, "string", text.encode())
    header += b"\0"
    rows = []
    for y in range(height):
        row = b"".join(struct.pack(f"<{width}{letter}", *channels[n][y * width : (y + 1) * width]) for n in names)
        rows.append(struct.pack("<ii", window[1] + y, len(row)) + row)
    at, table = len(header) + 8 * height, b""
    for row in rows:
        table += struct.pack("<Q", at)
        at += len(row)
    return header + table + b"".join(rows)


def grey(value, width, height, layer=""):
    """R, G, B of one value."""
    return {layer + c: [value] * (width * height) for c in "RGB"}
