"""How pictures lie on the disk: parts, files per layer, codecs, overscan, padding, headers; and exrcheck."""

import json
import os
import unittest

from exr import Exr
from support import OUTPUT, SCENE, SCENE_TOML, USAGE, TesseraTest


class Layouts(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_split_files_hold_the_bits_of_the_single_file(self):
        whole = self.render()
        self.expect(0, "render", "scene.toml", "-o", "s_<aov>.exr", "--exr", "split")
        names = [f for f in self.files() if f.startswith("s_")]
        self.assertEqual(names, ["s_N.exr", "s_P.exr", "s_Z.exr", "s_albedo.exr", "s_beauty.exr"])
        pixels = whole.pixels()
        for name, layer, channels in (("s_N.exr", "N.", "XYZ"), ("s_P.exr", "P.", "XYZ"),
                                      ("s_albedo.exr", "albedo.", "RGB"), ("s_beauty.exr", "", "RGB")):
            part = Exr(self.folder / name).pixels()
            for ours, theirs in zip("RGB", channels):
                self.assertEqual(part[ours], pixels[layer + theirs], name)
        self.assertEqual(Exr(self.folder / "s_Z.exr").pixels()["Z"], pixels["Z"])

    def test_without_a_place_for_the_pass_beauty_keeps_the_name(self):
        self.expect(0, "render", "scene.toml", "-o", "out.exr", "--exr", "split", "--aov", "Z")
        self.assertIn("out.exr", self.files())
        self.assertIn("out.Z.exr", self.files())

    def test_lossy_codec_with_data_is_refused_before_the_render(self):
        run = self.expect(USAGE, "render", "scene.toml", "--compression", "dwaa", "--spp", "1000000")
        self.assertIn("multipart", run.err)
        self.expect(USAGE, "render", "scene.toml", "--compression", "dwaa", "--float", "--aov", "beauty")
        self.expect(0, "render", "scene.toml", "-o", "c.exr", "--compression", "dwaa", "--aov", "albedo")
        self.expect(0, "render", "scene.toml", "-o", "m.exr", "--compression", "dwab", "--exr", "multipart")

    def test_scene_file_says_how_and_the_option_wins(self):
        self.write_scene(SCENE_TOML + '    [output]\n    compression = "zips"\n    float = true\n')
        self.assertEqual(self.render().compression, "zips")
        self.assertEqual(self.render().channels["R"], "float")
        self.assertEqual(self.render("--compression", "none").compression, "none")
        self.assertEqual(self.render("--set", "output.compression=zip").compression, "zip")

    def test_mistyped_output_key_is_located(self):
        self.write_scene(SCENE_TOML + '    [output]\n    exr = "parts"\n')
        run = self.expect(SCENE, "render", "scene.toml")
        self.assertRegex(run.err, r"scene.toml:\d+:\d+: output: exr is 'parts'")

    def test_split_never_replaces_what_the_scene_is_read_from(self):
        self.expect(0, "render", "scene.toml", "-o", "map.N.exr", "--aov", "beauty", "--res", "16x8")
        self.write_scene(SCENE_TOML + '    [environment]\n    file = "map.N.exr"\n')
        run = self.expect(USAGE, "render", "scene.toml", "-o", "map.exr", "--exr", "split")
        self.assertIn("map.N.exr", run.err)

    def test_failed_split_leaves_the_old_files(self):
        self.expect(0, "render", "scene.toml", "-o", "out.exr", "--exr", "split")
        before = {f: (self.folder / f).read_bytes() for f in self.files()}
        os.remove(self.folder / "out.P.exr")
        (self.folder / "out.P.exr").mkdir()
        self.expect(OUTPUT, "render", "scene.toml", "-o", "out.exr", "--exr", "split", "--seed", "9")
        for name in self.files():
            self.assertEqual((self.folder / name).read_bytes(), before[name], name)


class Windows(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_overscan_keeps_the_bits_of_the_frame(self):
        frame = self.render()
        for overscan, dx, dy in (("7px", 7, 7), ("0.1", 5, 4)):
            for tile in (8, 32):
                wide = self.render("--overscan", overscan, "--tile", tile, output="wide.exr")
                self.assertEqual(wide.display_window, frame.display_window)
                self.assertEqual(wide.data_window, (-dx, -dy, 47 + dx, 31 + dy))
                self.assert_same_pixels(wide.pixels((0, 0, 48, 32)), frame.pixels())

    def test_overscan_shows_what_a_wider_camera_does(self):
        wide = self.render("--overscan", "16px", "--spp", "16")
        lit = [wide.value("A", x, 31) for x in range(-16, 0)]
        self.assertGreater(max(lit), 0)  # the floor goes on beyond the frame

    def test_overscan_does_not_depend_on_tiles(self):
        a = self.render("--overscan", "5px", "--tile", "4")
        b = self.render("--overscan", "5px", "--tile", "64", output="b.exr")
        self.assert_same_bits(a, b)

    def test_overscan_of_the_scene_file(self):
        self.write_scene(SCENE_TOML.replace("[film]", "[film]\n    overscan_px = 3"))
        self.assertEqual(self.render().data_window, (-3, -3, 50, 34))
        self.assertEqual(self.render("--crop", "8,8,16,16").data_window, (8, 8, 15, 15))
        self.write_scene(SCENE_TOML.replace("[film]", "[film]\n    overscan_px = 3\n    overscan = 0.5"))
        self.assertIn("not both", self.expect(SCENE, "render", "scene.toml").err)

    def test_overscan_that_cannot_be(self):
        for text in ("-1", "2", "1.5px", "px", "nan", "10%", "99999px"):
            self.expect(USAGE, "render", "scene.toml", "--overscan", text)
        self.expect(USAGE, "render", "scene.toml", "--camera", "latlong", "--overscan", "0.1")

    def test_padded_crop_is_the_frame_with_black_around(self):
        frame = self.render()
        padded = self.render("--crop", "8,4,40,20", "--crop-pad", output="padded.exr")
        self.assertEqual(padded.data_window, frame.data_window)
        window = (8, 4, 40, 20)
        self.assert_same_pixels(padded.pixels(window), frame.pixels(window))
        self.assertEqual(padded.value("R", 7, 4), 0)
        self.assertEqual(padded.value("A", 40, 10), 0)
        self.assertAlmostEqual(padded.value("Z", 0, 0), 1e10, delta=1e3)


class Headers(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_deterministic_metadata_makes_equal_files(self):
        self.expect(0, "render", "scene.toml", "-o", "a.exr", "--deterministic-metadata", "-t", "1")
        environment = dict(os.environ, SOURCE_DATE_EPOCH="0")
        self.expect(0, "render", "scene.toml", "-o", "b.exr", "-t", "2", env=environment)
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())
        for name in ("host", "seconds", "threads", "command"):
            self.assertNotIn("tessera/" + name, Exr(self.folder / "a.exr").attributes)
        self.assertNotIn("capDate", Exr(self.folder / "a.exr").attributes)

    def test_header_says_when_where_and_in_which_colour_space(self):
        picture = self.render("--set", "film.working_space=acescg")
        self.assertRegex(picture.text("capDate"), r"^\d{4}:\d\d:\d\d \d\d:\d\d:\d\d$")
        self.assertEqual(picture.text("tessera/colorSpace"), "acescg")
        self.assertAlmostEqual(picture.text("chromaticities")[0], 0.713, places=5)
        self.assertTrue(picture.text("tessera/host"))


class Check(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_our_files_are_clean(self):
        self.render()
        self.expect(0, "render", "scene.toml", "-o", "parts.exr", "--exr", "multipart")
        run = self.expect(0, "exrcheck", "out.exr", "parts.exr", "--strict")
        self.assertEqual(run.out, "out.exr: clean\nparts.exr: clean\n")

    def test_findings_name_the_rule_and_the_remedy(self):
        self.render("--crop", "8,8,16,16")
        run = self.expect(0, "exrcheck", "out.exr")
        self.assertIn("warning", run.out)
        self.assertIn("[window-offset]", run.out)
        self.assertIn("--crop-pad", run.out)
        self.expect(SCENE, "exrcheck", "out.exr", "--strict")

    def test_json(self):
        self.render()
        (self.folder / "cut.exr").write_bytes((self.folder / "out.exr").read_bytes()[:3000])
        run = self.expect(SCENE, "exrcheck", "--json", "out.exr", "cut.exr")
        files = json.loads(run.out)["files"]
        self.assertEqual([f["errors"] for f in files], [0, 1])
        self.assertEqual(files[1]["findings"][0]["rule"], "truncated")

    def test_what_is_no_exr(self):
        self.write("text.exr", "text")
        for path in ("text.exr", "missing.exr", ".", "/dev/zero"):
            run = self.expect(SCENE, "exrcheck", path)
            self.assertIn("[unreadable]", run.out)
        self.expect(USAGE, "exrcheck")


if __name__ == "__main__":
    unittest.main()
