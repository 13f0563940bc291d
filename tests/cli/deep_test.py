"""Deep files: --deep beside the picture, flatten back to it, what other tools make of them, and broken ones."""

import json
import shutil
import subprocess
import time
import unittest

from exr import Exr
from support import OUTPUT, SCENE, SCENE_TOML, SLOWDOWN, USAGE, TesseraTest, command

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

    def test_the_scene_may_name_the_file(self):
        self.render("--deep", "asked.exr", "--deterministic-metadata")
        asked = (self.folder / "asked.exr").read_bytes()
        (self.folder / "shots").mkdir()
        named = ("--set", "output.deep=depths.exr", "--deterministic-metadata")
        self.render(*named, output="shots/a.exr")
        self.assertEqual((self.folder / "shots" / "depths.exr").read_bytes(), asked)
        self.render(*named, "--deep", "other.exr", output="shots/b.exr")
        self.assertEqual((self.folder / "other.exr").read_bytes(), asked)
        # Of a part it is kept for the merge: parts would overwrite each other's.
        (self.folder / "shots" / "depths.exr").unlink()
        self.expect(0, "render", "scene.toml", "-o", "shots/p.tsf", *named)
        self.assertFalse((self.folder / "shots" / "depths.exr").exists())
        self.expect(0, "merge", "shots/p.tsf", "-o", "c.exr", "--deep", "merged.exr", "--deterministic-metadata")
        self.assertEqual((self.folder / "merged.exr").read_bytes(), asked)

    def test_names_in_the_scene_that_cannot_be(self):
        self.write_scene(DEEP_TOML + '[output]\ndeep = "deep.png"\n')
        run = self.expect(SCENE, "render", "scene.toml", "-o", "a.exr")
        self.assertRegex(run.err, r"scene\.toml:\d+:\d+: output: deep is 'deep\.png', must end in \.exr")
        self.write_scene(DEEP_TOML + '[output]\ndeep = "a.exr"\n')
        self.assertIn("--output too", self.expect(USAGE, "render", "scene.toml", "-o", "a.exr").err)
        self.write_scene(DEEP_TOML + '[output]\ndeep = "nowhere/a.exr"\n')
        self.expect(OUTPUT, "render", "scene.toml", "-o", "a.exr")
        self.assertEqual([n for n in self.files() if n.endswith(".exr")], [])

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
        self.expect(USAGE, "render", "scene.toml", "-o", "a.exr", "--deep", "a.tsf")
        self.expect(USAGE, "render", "scene.toml", "-o", "a.tsf", "--deep", "b.tsf")
        self.assertEqual([n for n in self.files() if n.endswith((".tsf", ".exr"))], [])
        self.render("--deep", "deep.exr")
        self.expect(USAGE, "flatten", "deep.exr")
        self.expect(USAGE, "flatten", "-o", "flat.exr")
        self.expect(USAGE, "flatten", "deep.exr", "-o", "flat.png")
        self.expect(OUTPUT, "flatten", "deep.exr", "-o", "nowhere/flat.exr")


class DeepInPieces(TesseraTest):
    """The deep file of a render in several runs has the bytes of one run's."""

    ARGS = ("--float", "--deterministic-metadata", "--aov", "Z", "--aov", "cryptomatte")

    def setUp(self):
        super().setUp()
        self.write_scene(DEEP_TOML)

    def whole(self, *args):
        self.render("--deep", "whole.exr", *self.ARGS, *args, output="flat.exr")
        return (self.folder / "whole.exr").read_bytes()

    def deep(self, *args):
        """Of a command that writes deep.exr."""
        self.expect(0, *args, timeout=60)
        return (self.folder / "deep.exr").read_bytes()

    def test_killed_and_resumed(self):
        whole = self.whole("--spp", "1500")
        args = ("render", "scene.toml", "-o", "out.exr", "--deep", "deep.exr", "--spp", "1500", *self.ARGS)
        again = ("--checkpoint", "c.tsf", "--checkpoint-every", "0.02", "--resume", "c.tsf")
        checkpoint = self.folder / "c.tsf"
        for kill in range(3):
            before = checkpoint.stat().st_mtime_ns if kill else 0
            process = subprocess.Popen(command(*args, *again), cwd=self.folder, stderr=subprocess.DEVNULL)
            self.addCleanup(process.kill)
            deadline = time.monotonic() + 20 * SLOWDOWN
            while not checkpoint.exists() or checkpoint.stat().st_mtime_ns == before:
                self.assertLess(time.monotonic(), deadline, "no checkpoint")
                time.sleep(0.005)
            process.kill()
            process.wait()
        resumed = self.deep(*args, *again, "-t", "1", "--stats", "s.json")
        self.assertGreater(json.loads((self.folder / "s.json").read_text())["resumed"]["spp"], 0)
        self.assertEqual(resumed, whole)

    def test_ranges_and_crops_merged_in_any_order(self):
        whole = self.whole("--spp", "21")
        parts = []
        for samples in ("0:5", "5:6", "6:21"):
            for crop in ("0,0,22,32", "22,0,48,32"):
                parts.insert(0, f"p{len(parts)}.tsf")
                self.expect(0, "render", "scene.toml", "-o", parts[0], "--deep", parts[0], "--samples", samples,
                            "--crop", crop, *self.ARGS)  # fmt: skip
        merge = ("-o", "out.exr", "--deep", "deep.exr", "--float", "--deterministic-metadata")
        self.assertEqual(self.deep("merge", *parts, *merge), whole)
        self.assertEqual(self.deep("merge", *reversed(parts), *merge), whole)
        self.assert_same_bits(Exr(self.folder / "flat.exr"), Exr(self.folder / "out.exr"))
        # By way of a merged film file that goes on.
        self.expect(0, "merge", *parts[2:], "-o", "early.tsf")
        self.assertEqual(self.deep("render", "scene.toml", "-o", "out.exr", "--deep", "deep.exr", "--spp", "21",
                                   "--resume", "early.tsf", *self.ARGS), whole)  # fmt: skip

    def test_a_part_may_have_a_deep_file_of_its_own(self):
        part = self.deep("render", "scene.toml", "-o", "a.tsf", "--deep", "deep.exr", "--samples", "0:4", *self.ARGS)
        self.assertEqual(part, self.whole("--spp", "4"))

    def test_depths_that_were_not_kept(self):
        self.render("--deep", "d.exr", "--checkpoint", "with.tsf", *self.ARGS)
        self.render("--checkpoint", "without.tsf", *self.ARGS)
        out = ("-o", "no.exr")
        for resume, args, text in (
            ("without.tsf", ("--deep", "no_deep.exr"), "(--deep) is not kept, this render's is kept"),
            ("with.tsf", (), "(--deep) is kept, this render's is not kept"),
        ):
            run = self.expect(SCENE, "render", "scene.toml", *out, "--resume", resume, *args, *self.ARGS)
            self.assertIn(resume + ": cannot go on from it: its set of depths " + text, run.err)
        run = self.expect(SCENE, "merge", "without.tsf", *out, "--deep", "no_deep.exr")
        self.assertIn("without.tsf keeps no depths", run.err)
        run = self.expect(SCENE, "merge", "with.tsf", "without.tsf", *out)
        self.assertIn("set of depths (--deep)", run.err)
        self.assertEqual([n for n in self.files() if n.startswith("no")], [])


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
