"""Deep files: --deep beside the picture, flatten back to it, what other tools make of them, and broken ones."""

import os
import shutil
import subprocess
import unittest

from exr import Exr
from support import OUTPUT, SCENE, SCENE_TOML, USAGE, TesseraTest

OIIOTOOL = shutil.which("oiiotool")
# A veil before the fin, a bright sky, a lens.
DEEP_TOML = (
    SCENE_TOML.replace("fov_deg = 40", "fov_deg = 40\n    aperture_radius = 0.05")
    + """\
    [environment]
    radiance = [0.2, 0.4, 4.0]
    [material.veil]
    geometry_opacity = 0.4
    [[disc]]
    material = "veil"
    center = [0.3, 0.5, 0.5]
    normal = [0, 0, 1]
    radius = 0.4
    """
)


class Deep(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene(DEEP_TOML)

    def assert_near(self, a, b, tolerance):
        for name in "RGBA":
            for one, other in zip(a.values(name), b.values(name), strict=True):
                self.assertLessEqual(abs(one - other), tolerance * max(1, abs(other)), name)

    def test_flattened_it_is_beauty(self):
        beauty = self.render("--deep", "deep.exr", "--float", "--spp", "32")
        self.expect(0, "flatten", "deep.exr", "-o", "flat.exr", "--float")
        flat = Exr(self.folder / "flat.exr")
        self.assert_near(flat, beauty, 1e-6)
        self.assertEqual(flat.values("Z"), beauty.values("Z"))
        self.assertEqual(flat.text("chromaticities"), beauty.text("chromaticities"))

    def test_as_halves_it_is_beauty_to_their_rounding(self):
        beauty = self.render("--deep", "deep.exr", "--spp", "32")
        self.expect(0, "flatten", "deep.exr", "-o", "flat.exr")
        self.assert_near(Exr(self.folder / "flat.exr"), beauty, 2**-10)  # two roundings

    def test_the_picture_keeps_its_bits(self):
        self.assert_same_bits(self.render(), self.render("--deep", "deep.exr", output="b.exr"))

    def test_threads_and_tiles_make_the_same_file(self):
        for name, args in (("a", ("-t", "1", "--tile", "8")), ("b", ("-t", "2"))):
            self.render("--deep", name + ".exr", "--deterministic-metadata", *args)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_a_crop_and_overscan_have_the_pixels_of_the_whole(self):
        self.render("--deep", "whole.exr", "--float")
        self.render("--deep", "crop.exr", "--float", "--crop", "8,4,40,20")
        self.render("--deep", "wide.exr", "--float", "--overscan", "5px")
        self.render("--deep", "padded.exr", "--float", "--crop", "8,4,40,20", "--crop-pad")
        flat = {}
        for name in ("whole", "crop", "wide", "padded"):
            self.expect(0, "flatten", name + ".exr", "-o", "flat.exr", "--float")
            flat[name] = Exr(self.folder / "flat.exr")
        self.assertEqual(flat["crop"].data_window, (8, 4, 39, 19))
        self.assertEqual(flat["wide"].data_window, (-5, -5, 52, 36))
        self.assertEqual(flat["padded"].data_window, flat["whole"].data_window)
        self.assertEqual(flat["padded"].value("B", 0, 0), 0)
        window = (8, 4, 40, 20)
        for name in ("crop", "wide", "padded"):
            self.assert_same_pixels(flat[name].pixels(window), flat["whole"].pixels(window), name)

    @unittest.skipUnless(OIIOTOOL, "no oiiotool")
    def test_oiiotool_flattens_it_to_the_same(self):
        beauty = self.render("--deep", "deep.exr", "--float", "--spp", "32")
        subprocess.run([OIIOTOOL, "--flatten", "deep.exr", "-o", "flat.exr"], cwd=self.folder, check=True)
        self.assert_near(Exr(self.folder / "flat.exr"), beauty, 2e-6)  # sums in float

    def test_exrcheck_finds_nothing_wrong(self):
        self.render("--deep", "deep.exr")
        run = self.expect(0, "exrcheck", "deep.exr", "--strict")
        self.assertEqual(run.out.count("[deep]"), 1)
        self.assertEqual(run.out.count("deep.exr:"), 1)

    def test_names_that_cannot_be(self):
        self.expect(USAGE, "render", "scene.toml", "-o", "a.exr", "--deep", "a.exr")
        self.expect(USAGE, "render", "scene.toml", "-o", "a.exr", "--deep", "a.png")
        self.expect(OUTPUT, "render", "scene.toml", "-o", "a.exr", "--deep", "nowhere/a.exr")
        self.expect(USAGE, "render", "scene.toml", "-o", "a.exr", "--deep", "d.exr", "--checkpoint", "c.film")
        self.render("--deep", "deep.exr")
        self.expect(USAGE, "flatten", "deep.exr")
        self.expect(USAGE, "flatten", "-o", "flat.exr")
        self.expect(USAGE, "flatten", "deep.exr", "-o", "flat.png")
        self.expect(OUTPUT, "flatten", "deep.exr", "-o", "nowhere/flat.exr")


class BrokenDeep(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene(DEEP_TOML)
        self.render("--deep", "deep.exr")
        self.good = (self.folder / "deep.exr").read_bytes()

    def refuse(self, *files, message):
        run = self.expect(SCENE, "flatten", *files, "-o", "flat.exr")
        self.assertIn(files[-1], run.err)
        self.assertRegex(run.err, message)
        self.assertFalse((self.folder / "flat.exr").exists())

    def test_a_deep_file_is_not_replaced_by_its_flat_picture(self):
        self.render("--deep", "deep.exr", "--spp", "1")
        before = (self.folder / "deep.exr").read_bytes()
        self.assertIn("replace one of the deep files", self.expect(USAGE, "flatten", "deep.exr", "-o", "./deep.exr").err)
        self.assertEqual((self.folder / "deep.exr").read_bytes(), before)

    def test_missing_foreign_and_flat_files(self):
        self.refuse("nowhere.exr", message="nowhere.exr")
        self.write("text.exr", "no picture")
        self.refuse("text.exr", message=r"^image 'text.exr': cannot read: not one of")
        self.refuse("out.exr", message="not deep")

    def test_truncated_files(self):
        for size in (0, 3, 100, len(self.good) // 2, len(self.good) - 1):
            self.write("cut.exr", self.good[:size])
            self.refuse("cut.exr", message="cut.exr")
        self.refuse("cut.exr", message="missing|cut short")
        self.assertIn("[truncated]", self.expect(SCENE, "exrcheck", "cut.exr").out)

    def test_files_that_do_not_belong_together(self):
        self.render("--deep", "small.exr", "--res", "16x16")
        self.refuse("deep.exr", "small.exr", message="frame is 16x16")
        self.render("--deep", "aces.exr", "--set", "film.working_space=acescg")
        self.refuse("deep.exr", "aces.exr", message="primaries")

    def test_counts_beyond_memory(self):
        # The first chunk's counts, stored as they are: every pixel has 2^28 samples more than the one before.
        self.render("--deep", "plain.exr", "--compression", "none")
        data = bytearray((self.folder / "plain.exr").read_bytes())
        (first,) = [i for i in range(len(data) - 8) if data[i : i + 8] == b"\0\0\0\0" + (48 * 4).to_bytes(4, "little")][:1]
        for x in range(48):
            data[first + 28 + 4 * x : first + 32 + 4 * x] = min((x + 1) << 25, 2**31 - 1).to_bytes(4, "little")
        self.write("huge.exr", bytes(data))
        self.refuse("huge.exr", message="huge.exr")


if __name__ == "__main__":
    unittest.main()
