#!/usr/bin/env python3
"""Reads Cryptomatte mattes out of an EXR, by the specification and nothing of Tessera's:

read_cryptomatte.py FILE                            lists the types and the names of each
read_cryptomatte.py FILE TYPE NAME -o MATTE.pfm     writes the coverage of a name, as floats
read_cryptomatte.py FILE --check                    every id must be in the manifest, coverages sum to A and to at most 1
"""

import argparse
import json
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from exr import Exr  # noqa: E402


def murmur3_32(data, seed=0):
    """MurmurHash3_x86_32 (Appleby)."""

    def rotated(x, by):
        return (x << by | x >> (32 - by)) & 0xFFFFFFFF

    def mixed(k):
        return rotated(k * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF

    h = seed
    body = len(data) // 4 * 4
    for (k,) in struct.iter_unpack("<I", data[:body]):
        h = (rotated(h ^ mixed(k), 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    h ^= mixed(int.from_bytes(data[body:], "little")) ^ len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        h = (h ^ h >> shift) * factor & 0xFFFFFFFF
    return h


def id_of(name):
    h = murmur3_32(name.encode())
    return h ^ 1 << 23 if h >> 23 & 255 in (0, 255) else h


def bits_of(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


class Cryptomatte:
    """One type of a file: manifest is name -> id, ranks are lists of (ids as bits, coverages), pixel by pixel."""

    def __init__(self, exr, name, manifest):
        self.name, self.manifest = name, manifest
        self.size = exr.size
        self.ranks = []
        for layer in sorted({c.rsplit(".", 1)[0] for c in exr.channels}):
            if not (layer.startswith(name) and layer[len(name) :].isdigit()):
                continue
            for ids, coverage in ("RG", "BA"):
                for channel in (ids, coverage):
                    if exr.channels[f"{layer}.{channel}"] != "float":
                        raise ValueError(f"{layer}.{channel} is {exr.channels[f'{layer}.{channel}']}, not float")
                self.ranks.append((exr.words(f"{layer}.{ids}"), exr.values(f"{layer}.{coverage}")))
        if not self.ranks:
            raise ValueError(f"there are no layers {name}00, {name}01 ...")

    def matte(self, wanted):
        """The coverage of one id, row after row."""
        result = [0.0] * (self.size[0] * self.size[1])
        for ids, coverage in self.ranks:
            for i, found in enumerate(ids):
                if found == wanted:
                    result[i] += coverage[i]
        return result

    def all_mattes(self):
        """Ids -> coverage, of whatever is in the picture."""
        result = {}
        for ids, coverage in self.ranks:
            for i, found in enumerate(ids):
                if coverage[i] > 0:
                    result.setdefault(found, [0.0] * len(ids))[i] += coverage[i]
        return result


class File(Exr):
    def words(self, channel):
        return [w for row in self._rows[channel] for w in struct.unpack(f"<{self.size[0]}I", row)]

    def cryptomattes(self):
        """Type name -> Cryptomatte."""
        found = {}
        for attribute in self.attributes:
            if not (attribute.startswith("cryptomatte/") and attribute.endswith("/name")):
                continue
            prefix = attribute[: -len("name")]
            if self.text(prefix + "hash") != "MurmurHash3_32":
                raise ValueError(f"{prefix}hash is unknown")
            if self.text(prefix + "conversion") != "uint32_to_float32":
                raise ValueError(f"{prefix}conversion is unknown")
            name = self.text(attribute)
            found[name] = Cryptomatte(self, name, self.manifest(prefix))
        return found

    def manifest(self, prefix):
        if prefix + "manifest" in self.attributes:
            text = self.text(prefix + "manifest")
        else:
            sidecar = pathlib.PurePosixPath(self.text(prefix + "manif_file"))
            if sidecar.is_absolute() or {".", ".."} & set(sidecar.parts):
                raise ValueError(f"manif_file is '{sidecar}', must be beside the picture")
            text = (self.path.parent / sidecar).read_text(encoding="utf-8")
        return {name: int(value, 16) for name, value in json.loads(text).items()}

    def __init__(self, path):
        self.path = pathlib.Path(path)
        super().__init__(path)


def write_pfm(path, size, values):
    width, height = size
    rows = [values[y * width : (y + 1) * width] for y in range(height)]
    with open(path, "wb") as out:
        out.write(f"Pf\n{width} {height}\n-1.0\n".encode())
        for row in reversed(rows):  # a PFM starts at the bottom
            out.write(struct.pack(f"<{width}f", *row))


def check(file, matte, tolerance):
    """What is wrong with a type, as lines."""
    problems = []
    for name, value in matte.manifest.items():
        if id_of(name) != value and "\ufffd" not in name:
            problems.append(f"{matte.name}: '{name}' is {value:08x} in the manifest, its hash says {id_of(name):08x}")
    known = set(matte.manifest.values())
    mattes = matte.all_mattes()
    for found in sorted(set(mattes) - known):
        problems.append(f"{matte.name}: id {found:08x} is in the picture, but not in the manifest")
    for i in range(1, len(matte.ranks)):
        if any(a < b for a, b in zip(matte.ranks[i - 1][1], matte.ranks[i][1])):
            problems.append(f"{matte.name}: rank {i} covers more than rank {i - 1}")
    alpha = file.values("A")
    worst = (0, None)
    for i, opacity in enumerate(alpha):
        total = sum(m[i] for m in mattes.values())
        if total < opacity and matte.ranks[-1][1][i] > 0:
            continue  # all ranks are taken, what came after them is not in the file
        if total > 1:
            problems.append(f"{matte.name}: coverages of pixel {i} sum to {total}")
        # A half float alpha has 11 bits.
        allowed = tolerance if file.channels["A"] == "float" else max(tolerance, opacity * 2**-11)
        if abs(total - opacity) > max(allowed, worst[0]):
            worst = (abs(total - opacity), i)
    if worst[1] is not None:
        x, y = worst[1] % file.size[0], worst[1] // file.size[0]
        problems.append(f"{matte.name}: at {x},{y} of the window coverages and alpha differ by {worst[0]:g}")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("type", nargs="?")
    parser.add_argument("name", nargs="?")
    parser.add_argument("-o", "--output")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of the sum of coverages against alpha")
    options = parser.parse_args()

    file = File(options.file)
    types = file.cryptomattes()
    if options.check:
        problems = [line for matte in types.values() for line in check(file, matte, options.tolerance)]
        if not types:
            problems.append("the file holds no Cryptomatte")
        print("\n".join(problems) or f"{len(types)} types in order: {', '.join(types)}")
        return 1 if problems else 0
    if options.name is None:
        for matte in types.values():
            present = matte.all_mattes()
            for name, value in matte.manifest.items():
                pixels = sum(present.get(value, ()))
                print(f"{matte.name}\t{value:08x}\t{pixels:.2f}\t{name}")
        return 0
    if options.type not in types:
        sys.exit(f"no type '{options.type}' (there are: {', '.join(types) or 'none'})")
    if options.name not in types[options.type].manifest:
        sys.exit(f"'{options.name}' is not in the manifest")
    values = types[options.type].matte(id_of(options.name))
    print(f"{sum(values):.4f} pixels")
    if options.output:
        write_pfm(options.output, types[options.type].size, values)
    return 0


if __name__ == "__main__":
    sys.exit(main())
