"""Textures from the command line: --frame, --texture-memory, --auto-tx, --tx-cache."""

import json
import os
import struct
import unittest

from support import SCENE, USAGE, TesseraTest


def tiff(width, height, pixels):
    """An uncompressed TIFF of 8-bit RGB in one strip."""
    count = len(pixels)
    entries = [
        (256, 4, 1, width), (257, 4, 1, height), (258, 3, 3, 8 + count), (259, 3, 1, 1), (262, 3, 1, 2),
        (273, 4, 1, 8), (277, 3, 1, 3), (278, 4, 1, height), (279, 4, 1, count),
    ]  # fmt: skip
    tail = struct.pack("<3H", 8, 8, 8) + b"\0\0" + struct.pack("<H", len(entries))
    tail += b"".join(struct.pack("<HHII", *e) for e in entries) + b"\0\0\0\0"
    return b"II*\0" + struct.pack("<I", 8 + count + 8) + pixels + tail


TOML = """\
    tessera = 1
    [camera]
    projection = "orthographic"
    position = [0, 0, 5]
    look_at = [0, 0, 0]
    ortho_height = 1
    [film]
    resolution = [24, 24]
    aovs = ["albedo"]
    [render]
    spp = 4
    [environment]
    [[mesh]]
    file = "quad.obj"
    material = "m"
    [material.m]
    specular_weight = 0
    base_color = { file = "FILE", color_space = "raw" }
    """
QUAD = "v -.5 -.5 0\nv .5 -.5 0\nv .5 .5 0\nv -.5 .5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"


class Textures(TesseraTest):
    def scene(self, file, name="scene.toml"):
        self.write("quad.obj", QUAD)
        self.write(name, TOML.replace("FILE", file))

    def statistics(self, *args):
        self.expect(0, "render", "scene.toml", "-o", "out.exr", "--stats", "stats.json", *args)
        return json.loads((self.folder / "stats.json").read_text())

    def test_frame_picks_the_file(self):
        for frame, level in ((1, 51), (3, 204)):
            self.write(f"a.{frame:04}.tif", tiff(2, 2, bytes([level] * 12)))
        self.scene("a.####.tif")
        for frame, level in ((None, 51), (3, 204)):
            picture = self.render(*([] if frame is None else ["--frame", frame]))
            self.assertAlmostEqual(picture.value("albedo.R", 12, 12), level / 255, places=3)

    def test_a_missing_frame_is_a_located_error(self):
        self.write("a.0001.tif", tiff(2, 2, bytes(12)))
        self.scene("a.####.tif")
        run = self.expect(SCENE, "render", "scene.toml", "-o", "out.exr", "--frame", 2)
        self.assertIn("scene.toml:18:16: ", run.err)
        self.assertIn("'a.0002.tif' is missing (there are frames 1)", run.err)
        self.expect(0, "render", "scene.toml", "-o", "out.exr", "--frame", 2, "--lenient")
        self.expect(USAGE, "render", "scene.toml", "-o", "out.exr", "--frame", "two")

    def test_texture_memory_is_a_number_of_at_least_32(self):
        self.scene("a.tif")
        for wrong in ("0", "31", "-1", "much"):
            self.expect(USAGE, "info", "scene.toml", "--texture-memory", wrong)

    def test_auto_tx_makes_files_once_and_changes_no_bit(self):
        # Two of 16 MiB each do not both fit in 32 MiB with their coarser levels.
        size = 2400
        row = bytes((i * 7 + i // 11) & 255 for i in range(size * 3))
        for name in "ab":
            pixels = b"".join(row[y % 97 * 3 :] + row[: y % 97 * 3] for y in range(size))
            self.write(f"{name}.tif", tiff(size, size, pixels))
        self.scene("a.tif")
        with (self.folder / "scene.toml").open("a") as file:
            file.write('geometry_opacity = { file = "b.tif", factor = 0.9 }\n')
        tx = self.folder / "tx"
        memory = self.render("--threads", 2)
        small = ("--texture-memory", 32, "--auto-tx", "--tx-cache", tx)
        stats = self.statistics(*small)
        self.assertEqual(stats["textures"]["in_cache"], 2)
        self.assertLessEqual(stats["memory_bytes"]["textures"], 32 << 20)
        made = sorted(p.name for p in tx.iterdir())
        self.assertEqual([n.split(".")[0] + n[-3:] for n in made], ["a.tx", "b.tx"])
        again = self.render(*small)
        self.assert_same_bits(memory, again)
        self.assertEqual(sorted(p.name for p in tx.iterdir()), made)

    def test_without_auto_tx_what_does_not_fit_is_halved_and_named(self):
        size = 3600  # 49 MiB with its coarser levels
        self.write("a.tif", tiff(size, size, bytes(size * size * 3)))
        self.scene("a.tif")
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--stats", "stats.json", "--texture-memory", 32)
        self.assertRegex(run.err, r"warning: scene\.toml:18:\d+: texture '.*/a\.tif': .*1800x1800.*--auto-tx")
        stats = json.loads((self.folder / "stats.json").read_text())
        self.assertLessEqual(stats["memory_bytes"]["textures"], 32 << 20)
        self.expect(SCENE, "render", "scene.toml", "-o", "out.exr", "--texture-memory", 32, "--strict")

    def test_the_cache_folder_follows_the_environment(self):
        size = 3600
        self.write("a.tif", tiff(size, size, bytes(size * size * 3)))
        self.scene("a.tif")
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")}
        self.expect(0, "info", "scene.toml", "--texture-memory", 32, "--auto-tx", env=environment)
        self.assertEqual(len(list((self.folder / "cache/tessera/tx").iterdir())), 1)


if __name__ == "__main__":
    unittest.main()
