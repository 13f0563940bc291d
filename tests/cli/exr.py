"""Reads single-part scanline EXR files (none, ZIPS, ZIP), bits untouched: enough to compare what Tessera writes."""

import struct
import zlib

TYPES = {0: ("uint", 4), 1: ("half", 2), 2: ("float", 4)}
COMPRESSIONS = {0: ("none", 1), 2: ("zips", 1), 3: ("zip", 16)}


class Exr:
    """attributes: name -> (type, bytes); channels: name -> 'half'|'float'|'uint'; rows of raw bytes per channel."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self._data = file.read()
        if self._data[:4] != b"\x76\x2f\x31\x01":
            raise ValueError(f"{path}: not an EXR file")
        flags = self._data[5] | self._data[6] << 8
        if flags & 0x1A:
            raise ValueError(f"{path}: tiled, deep or multi-part")
        offset = self._read_header(8)
        self.display_window = struct.unpack("<4i", self.attributes["displayWindow"][1])
        self.data_window = struct.unpack("<4i", self.attributes["dataWindow"][1])
        self.compression, self._block_rows = COMPRESSIONS[self.attributes["compression"][1][0]]
        self._read_pixels(offset)

    @property
    def size(self):
        x0, y0, x1, y1 = self.data_window
        return x1 - x0 + 1, y1 - y0 + 1

    def text(self, name):
        """An attribute as a Python value: string, number or the tuple of its numbers."""
        kind, data = self.attributes[name]
        if kind == "string":
            return data.decode()
        codes = {"int": "i", "float": "f", "double": "d", "chromaticities": "8f", "box2i": "4i", "v2f": "2f"}
        values = struct.unpack("<" + codes[kind], data)
        return values[0] if len(values) == 1 else values

    def bits(self, channel, x, y):
        """The raw bytes of one pixel, in absolute coordinates."""
        size = {"half": 2, "float": 4, "uint": 4}[self.channels[channel]]
        at = (x - self.data_window[0]) * size
        return self._rows[channel][y - self.data_window[1]][at : at + size]

    def value(self, channel, x, y):
        code = {"half": "e", "float": "f", "uint": "I"}[self.channels[channel]]
        return struct.unpack("<" + code, self.bits(channel, x, y))[0]

    def values(self, channel):
        code = {"half": "e", "float": "f", "uint": "I"}[self.channels[channel]]
        width = self.size[0]
        return [v for row in self._rows[channel] for v in struct.unpack(f"<{width}{code}", row)]

    def pixels(self, window=None):
        """channel -> bytes of the pixels x0 <= x < x1, y0 <= y < y1 (default: all): equal bits, equal result."""
        left, top, right, bottom = self.data_window
        x0, y0, x1, y1 = window or (left, top, right + 1, bottom + 1)
        result = {}
        for name, kind in self.channels.items():
            size = {"half": 2, "float": 4, "uint": 4}[kind]
            rows = self._rows[name][y0 - top : y1 - top]
            result[name] = b"".join(row[(x0 - left) * size : (x1 - left) * size] for row in rows)
        return result

    def _read_header(self, offset):
        self.attributes = {}
        while self._data[offset]:
            name, offset = self._string(offset)
            kind, offset = self._string(offset)
            (size,) = struct.unpack_from("<i", self._data, offset)
            self.attributes[name] = (kind, self._data[offset + 4 : offset + 4 + size])
            offset += 4 + size
        self.channels = {}
        data = self.attributes["channels"][1]
        at = 0
        while data[at]:
            end = data.index(b"\0", at)
            (kind,) = struct.unpack_from("<i", data, end + 1)
            self.channels[data[at:end].decode()] = TYPES[kind][0]
            at = end + 17
        return offset + 1

    def _string(self, offset):
        end = self._data.index(b"\0", offset)
        return self._data[offset:end].decode(), end + 1

    def _read_pixels(self, offset):
        width, height = self.size
        sizes = {name: width * {"half": 2, "float": 4, "uint": 4}[kind] for name, kind in self.channels.items()}
        row_size = sum(sizes.values())
        self._rows = {name: [None] * height for name in self.channels}
        blocks = -(-height // self._block_rows)
        for start in struct.unpack_from(f"<{blocks}Q", self._data, offset):
            y, size = struct.unpack_from("<ii", self._data, start)
            first = y - self.data_window[1]
            rows = min(self._block_rows, height - first)
            block = _unpack(self._data[start + 8 : start + 8 + size], rows * row_size, self.compression)
            at = 0
            for row in range(first, first + rows):
                for name, length in sizes.items():
                    self._rows[name][row] = block[at : at + length]
                    at += length


def _unpack(block, size, compression):
    # A block that would not shrink is stored as it is.
    if compression != "none" and len(block) < size:
        coded = bytearray(zlib.decompress(block))
        for i in range(1, len(coded)):
            coded[i] = (coded[i - 1] + coded[i] - 128) & 255
        block = bytearray(len(coded))
        half = (len(coded) + 1) // 2
        block[0::2] = coded[:half]
        block[1::2] = coded[half:]
    if len(block) != size:
        raise ValueError(f"block of {len(block)} bytes, expected {size}")
    return bytes(block)
