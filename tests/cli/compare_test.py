"""tessera compare: numbers that can be told beforehand, exit codes, layers, seeds, and what cannot be compared."""

import json
import random
import shutil
import subprocess
import unittest

from exr_writer import exr_bytes, grey
from support import OUTPUT, SCENE, USAGE, TesseraTest

DIFFERS = 10
W, H = 24, 16
NAN, INF = float("nan"), float("inf")
OIIOTOOL = shutil.which("oiiotool")


class CompareTest(TesseraTest):
    def picture(self, name, channels, width=W, height=H, **options):
        return self.write(name, exr_bytes(channels, width, height, **options))

    def noisy(self, name, spread, seed, value=1.0, texts=None):
        """Grey with noise: one seed of a render."""
        numbers = random.Random(seed)
        channels = {c: [value + numbers.gauss(0, spread) for _ in range(W * H)] for c in "RGB"}
        self.picture(name, channels, texts=texts)

    def compare(self, *args, code=0):
        """Compares and gives the JSON."""
        run = self.expect(code, "compare", *args, "--json", "out.json")
        result = json.loads((self.folder / "out.json").read_text())
        self.assertEqual(result["passed"], code == 0)
        self.assertEqual(result["exceeded"] == [], code == 0)
        return result, run

    def metrics(self, result, layer="beauty", side="a"):
        (found,) = [l for l in result["layers"] if l["name"] == layer]
        return {name: m["value"] for name, m in found[side]["metrics"].items()}


class Numbers(CompareTest):
    def test_an_offset_is_told_by_every_metric(self):
        self.picture("a.exr", grey(2.5, W, H))
        self.picture("b.exr", grey(2.0, W, H))
        result, run = self.compare("a.exr", "b.exr")
        m = self.metrics(result)
        self.assertAlmostEqual(m["rmse"], 0.5)
        self.assertAlmostEqual(m["relmse"], 0.25 / 4.04)
        self.assertAlmostEqual(m["psnr"], 12.0412, places=4)
        self.assertAlmostEqual(m["max_abs"], 0.5)
        self.assertAlmostEqual(m["bias"], 0.25)
        self.assertEqual(m["different"], 1)
        self.assertGreater(m["flip"], 0)
        self.assertLess(m["ssim"], 1)
        self.assertEqual([c["mean_ratio"] for c in result["layers"][0]["a"]["channels"]], [1.25] * 3)
        self.assertIn("0.5", run.out)
        self.assertIn("R 1.2500", run.out)

    def test_equal_pictures_are_equal_by_every_metric(self):
        self.noisy("a.exr", 0.1, 1)
        shutil.copy(self.folder / "a.exr", self.folder / "b.exr")
        m = self.metrics(self.compare("a.exr", "b.exr", "--fail-above", "different=0", "--fail-above", "flip=0")[0])
        self.assertIsNone(m.pop("psnr"), "JSON has no infinity")
        self.assertEqual(m.pop("ssim"), 1)
        self.assertEqual(set(m.values()), {0})

    def test_epsilon_can_be_given(self):
        self.picture("a.exr", grey(2.5, W, H))
        self.picture("b.exr", grey(2.0, W, H))
        m = self.metrics(self.compare("a.exr", "b.exr", "--epsilon", 1)[0])
        self.assertAlmostEqual(m["relmse"], 0.05)

    def test_nothing_depends_on_threads(self):
        self.noisy("a.exr", 0.1, 1)
        self.noisy("b.exr", 0.1, 2)
        one, two = (self.compare("a.exr", "b.exr", "-t", n)[0] for n in (1, 2))
        self.assertEqual(one, two)

    def test_eight_bits_are_taken_as_a_display_takes_them(self):
        for name, value in (("a.ppm", 0), ("b.ppm", 255)):
            self.write(name, b"P6\n16 16\n255\n" + bytes([value]) * 768)
            subprocess.run([OIIOTOOL, name, "-o", name[0] + ".png"], cwd=self.folder, check=True)
        result, run = self.compare("a.png", "b.png")
        m = self.metrics(result)
        self.assertEqual((m["rmse"], m["psnr"], result["values"]), (1, 0, "srgb"))
        self.assertAlmostEqual(m["flip"], 0.9674, places=4)  # tests/unit/flip_test.cpp has the arithmetic
        self.assertIn("sRGB", run.out)
        self.picture("c.exr", grey(1, 16, 16), 16, 16)
        refused = self.expect(SCENE, "compare", "a.png", "c.exr")
        self.assertIn("a.png: has integers for a display", refused.err)


class Limits(CompareTest):
    def setUp(self):
        super().setUp()
        self.picture("a.exr", grey(1.1, W, H))
        self.picture("b.exr", grey(1.0, W, H))

    def test_above_and_below_end_with_a_code_of_their_own(self):
        self.expect(0, "compare", "a.exr", "b.exr")
        self.expect(0, "compare", "a.exr", "b.exr", "--fail-above", "rmse=0.11", "--fail-below", "psnr=19")
        run = self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-above", "rmse=0.09")
        self.assertIn("compare: rmse of 'beauty' is 0.1, at most 0.09 is allowed", run.err)
        self.assertIn("at least 21", self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-below", "psnr=21").err)

    def test_each_of_several_counts(self):
        args = ("--fail-above", "flip=1", "--fail-above", "different=0", "--fail-above", "bias=0.05")
        run = self.expect(DIFFERS, "compare", *args, "a.exr", "b.exr", "-q")
        self.assertEqual(len(run.err.splitlines()), 2)
        self.assertEqual(run.out, "")

    def test_a_limit_can_be_of_a_layer(self):
        both = {**grey(1.0, W, H), **grey(3.0, W, H, "diffuse.")}
        other = {**grey(1.0, W, H), **grey(4.0, W, H, "diffuse.")}
        self.picture("a.exr", both)
        self.picture("b.exr", other)
        self.expect(0, "compare", "a.exr", "b.exr", "--fail-above", "beauty:rmse=0")
        self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-above", "diffuse:rmse=0")
        self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-above", "rmse=0")
        self.expect(0, "compare", "a.exr", "b.exr", "--fail-above", "rmse=0", "--layer", "beauty")

    def test_what_is_no_limit_is_refused(self):
        for text, saying in (
            ("rmse", "METRIC=VALUE"),
            ("rsme=1", "did you mean 'rmse'"),
            ("rmse=x", "no number"),
            ("rmse=nan", "no number"),
            ("rmse=", "no number"),
            ("psnr=30", "--fail-below"),
        ):
            run = self.expect(USAGE, "compare", "a.exr", "b.exr", "--fail-above", text)
            self.assertIn(saying, run.err, text)
        self.assertIn("--fail-above", self.expect(USAGE, "compare", "a.exr", "b.exr", "--fail-below", "rmse=1").err)
        # a limit by which nothing is measured must not pass
        self.expect(USAGE, "compare", "a.exr", "b.exr", "--fail-above", "direct:rmse=1")

    def test_pixels_that_are_not_finite_are_counted_and_fail(self):
        bad = grey(1.0, W, H)
        bad["R"][5], bad["G"][5], bad["B"][77] = NAN, -1, INF
        self.picture("a.exr", bad)
        result, run = self.compare("a.exr", "b.exr", "--fail-above", "rmse=1", code=DIFFERS)
        self.assertIn("leaves out 2 pixels that are not finite", run.err)
        self.assertIn("'beauty' R of A: 1 NaN", run.out)
        self.assertIn("'beauty' G of A: 1 negative", run.out)
        self.assertEqual(self.metrics(result)["non_finite"], 2)
        self.assertEqual(self.metrics(result)["rmse"], 0)
        counts = [c["values"] for c in result["layers"][0]["a"]["channels"]]
        self.assertEqual(counts[0], {"nan": 1, "infinite": 0, "negative": 0})
        self.assertEqual(counts[2], {"nan": 0, "infinite": 1, "negative": 0})
        self.expect(0, "compare", "a.exr", "b.exr", "--fail-above", "rmse=1", "--ignore-non-finite")
        self.expect(DIFFERS, "compare", "b.exr", "a.exr", "--fail-above", "rmse=1")
        # sameness can be told of what is not finite too
        self.expect(0, "compare", "a.exr", "a.exr", "--fail-above", "different=0")

    def test_without_a_finite_pixel_no_limit_holds(self):
        self.picture("a.exr", grey(NAN, W, H))
        run = self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-above", "rmse=9", "--ignore-non-finite")
        self.assertIn("no pixel is finite in both", run.err)


class Layers(CompareTest):
    def layered(self, name, **changes):
        channels = {**grey(1.0, W, H), "A": [1.0] * (W * H), "Z": [5.0] * (W * H)}
        channels |= {f"N.{c}": [0.5] * (W * H) for c in "XYZ"}
        channels |= {f"CryptoObject00.{c}": [0.25] * (W * H) for c in "RGBA"}
        channels |= grey(0.3, W, H, "diffuse.")
        for key, value in changes.items():
            channel, at = key.rsplit("_", 1)
            channels[channel.replace("__", ".")][int(at)] = value
        self.picture(name, channels)

    def test_each_layer_is_compared_by_what_it_holds(self):
        self.layered("a.exr", CryptoObject00__R_7=0.5, N__Y_3=0.75, Z_9=4.0)
        self.layered("b.exr")
        result, _ = self.compare("a.exr", "b.exr")
        kinds = {l["name"]: l["content"] for l in result["layers"]}
        self.assertEqual(
            kinds, {"beauty": "colour", "diffuse": "colour", "Z": "data", "N": "data", "CryptoObject00": "ids"}
        )
        self.assertEqual(self.metrics(result, "CryptoObject00"), {"different": 1 / (W * H)})
        self.assertEqual(self.metrics(result, "N")["max_abs"], 0.25)
        self.assertEqual(self.metrics(result, "Z")["max_abs"], 1)
        self.assertNotIn("flip", self.metrics(result, "Z"))
        self.assertEqual(self.metrics(result, "beauty")["different"], 0)

    def test_one_layer_can_be_chosen(self):
        self.layered("a.exr", N__Y_3=0.75)
        self.layered("b.exr")
        result, _ = self.compare("--layer", "diffuse", "--layer", "Z", "a.exr", "b.exr", "--fail-above", "different=0")
        self.assertEqual([l["name"] for l in result["layers"]], ["Z", "diffuse"])
        run = self.expect(SCENE, "compare", "a.exr", "b.exr", "--layer", "specular")
        self.assertIn("a.exr: has no layer 'specular' (it has beauty", run.err)

    def test_what_only_one_has_is_listed_and_passes_no_limit(self):
        self.layered("a.exr")
        self.picture("b.exr", {**grey(1.0, W, H), **grey(1.0, W, H, "coat.")})
        result, run = self.compare("a.exr", "b.exr")
        lone = {(l["name"], l["file"]) for l in result["only_in"]}
        self.assertEqual(
            lone,
            {(n, "a.exr") for n in ("Z", "N", "CryptoObject00", "diffuse", "beauty.A")} | {("coat", "b.exr")},
        )
        self.assertIn("only in    b.exr: coat", run.out)
        self.expect(DIFFERS, "compare", "a.exr", "b.exr", "--fail-above", "rmse=1")

    def test_parts_and_single_files_of_one_picture_are_equal(self):
        self.write_scene()
        args = ("--spp", 2, "--aov", "compositing", "--aov", "cryptomatte", "--deterministic-metadata")
        self.render(*args, output="one.exr")
        self.expect(0, "render", "scene.toml", "-o", "parts.exr", *args, "--exr", "multipart")
        run = self.expect(0, "compare", "one.exr", "parts.exr", "--fail-above", "different=0")
        self.assertIn("CryptoObject02", run.out)
        self.expect(0, "compare", "parts.exr", "one.exr", "--fail-above", "different=0", "--layer", "Z")
        self.assertNotIn("only in", run.out)

    def test_bare_channels_of_later_parts_are_layers_by_the_name_of_the_part(self):
        self.layered("one.exr")
        for i, (layer, channels) in enumerate((("rgba", "R,G,B,A"), ("N", "N.X,N.Y,N.Z"))):
            bare = ",".join(c.split(".")[-1] for c in channels.split(","))
            args = ("one.exr", "--ch", channels, "--chnames", bare, "--attrib", "oiio:subimagename", layer)
            subprocess.run([OIIOTOOL, *args, "-o", f"part{i}.exr"], cwd=self.folder, check=True)
        args = ("part0.exr", "part1.exr", "--siappend", "-o", "parts.exr")
        subprocess.run([OIIOTOOL, *args], cwd=self.folder, check=True)
        both = ("--layer", "beauty", "--layer", "N")
        self.expect(0, "compare", "parts.exr", "one.exr", *both, "--fail-above", "different=0")

    def test_windows_of_one_frame_are_compared_where_they_overlap(self):
        display = (0, 0, W - 1, H - 1)
        self.picture("a.exr", grey(1.0, W, H))
        part = {c: [1.0] * 32 for c in "RGB"}
        part["R"][0] = 3.0
        self.picture("b.exr", part, 8, 4, window=(4, 6, 11, 9), display=display)
        result, run = self.compare("a.exr", "b.exr")
        self.assertIn("only 4,6,12,10 is compared", run.out)
        self.assertEqual(result["layers"][0]["pixels"], 32)
        self.assertEqual(self.metrics(result)["different"], 1 / 32)
        self.picture("c.exr", part, 8, 4, window=(14, 11, 21, 14), display=display)
        self.assertIn("none in common", self.expect(SCENE, "compare", "b.exr", "c.exr").err)

    def test_other_sizes_are_refused(self):
        self.picture("a.exr", grey(1.0, W, H))
        self.picture("b.exr", grey(1.0, H, W), H, W)
        run = self.expect(SCENE, "compare", "a.exr", "b.exr")
        self.assertIn("a.exr: is 24 x 16 pixels, b.exr is 16 x 24", run.err)

    def test_other_scenes_are_told_by_their_hashes(self):
        for name, scene, seed in (("a.exr", "1" * 16, "0"), ("b.exr", "2" * 16, "0"), ("c.exr", "3" * 16, "7")):
            self.picture(name, grey(1.0, W, H), texts={"tessera/sceneHash": scene, "tessera/seed": seed})
        self.assertIn("scene hashes differ", self.expect(0, "compare", "a.exr", "b.exr").out)
        # another seed is another hash
        self.assertNotIn("hashes", self.expect(0, "compare", "a.exr", "c.exr").out)
        self.assertNotIn("hashes", self.expect(0, "compare", "a.exr", "a.exr").out)


class Seeds(CompareTest):
    def setUp(self):
        super().setUp()
        self.picture("ref.exr", grey(1.0, W, H))
        for seed in range(4):
            self.noisy(f"a_{seed}.exr", 0.1, seed, texts={"tessera/seed": str(seed)})
            self.noisy(f"b_{seed}.exr", 0.1, 10 + seed, texts={"tessera/seed": str(10 + seed)})
            self.noisy(f"c_{seed}.exr", 0.2, 20 + seed)

    def test_a_difference_is_told(self):
        result, run = self.compare("a_*.exr", "c_*.exr", "--reference", "ref.exr")
        (layer,) = result["layers"]
        for name in ("rmse", "relmse", "flip", "psnr", "ssim"):
            self.assertEqual(layer["verdicts"][name], "a", name)
        self.assertIn("A is closer by RMSE, relMSE", run.out)
        self.assertIn("B is closer", self.expect(0, "compare", "c_*.exr", "a_*.exr", "--reference", "ref.exr").out)
        m = layer["a"]["metrics"]["rmse"]
        self.assertTrue(m["low"] < 0.1 < m["high"])

    def test_no_verdict_where_there_is_no_difference(self):
        result, run = self.compare("a_*.exr", "b_*.exr", "--reference", "ref.exr")
        self.assertEqual(set(result["layers"][0]["verdicts"].values()), {"none"})
        self.assertIn("no difference can be told by RMSE", run.out)
        self.assertNotIn("closer", run.out)

    def test_one_file_a_side_has_no_interval_and_no_verdict(self):
        result, run = self.compare("a_0.exr", "c_0.exr", "--reference", "ref.exr")
        (layer,) = result["layers"]
        self.assertNotIn("low", layer["a"]["metrics"]["rmse"])
        self.assertEqual(layer["verdicts"], {})
        self.assertNotIn("closer by", run.out)
        # of one side alone neither
        self.assertNotIn("closer by", self.compare("a_*.exr", "c_0.exr", "--reference", "ref.exr")[1].out)

    def test_lists_are_patterns_are_lists(self):
        one, _ = self.compare("a_*.exr", "ref.exr")
        two, _ = self.compare("a_0.exr,a_1.exr,a_2.exr,a_3.exr", "ref.exr")
        self.assertEqual(one, two)
        self.assertEqual(len(one["a"]), 4)

    def test_a_seed_that_is_there_twice_is_no_seed(self):
        self.noisy("a_4.exr", 0.1, 4, texts={"tessera/seed": "3"})
        result, run = self.compare("a_*.exr", "c_*.exr", "--reference", "ref.exr")
        self.assertIn("seed 3 is that of another file", run.out)
        self.assertNotIn("low", result["layers"][0]["a"]["metrics"]["rmse"])
        self.assertEqual(result["layers"][0]["verdicts"], {})
        self.assertIn("given twice", self.expect(USAGE, "compare", "a_0.exr,./a_0.exr", "ref.exr").err)

    def test_limits_are_of_the_mean_of_both_sides(self):
        self.expect(0, "compare", "a_*.exr", "c_*.exr", "--reference", "ref.exr", "--fail-above", "rmse=0.25")
        run = self.expect(DIFFERS, "compare", "a_*.exr", "c_*.exr", "--reference", "ref.exr", "--fail-above", "rmse=0.15")
        self.assertIn("rmse of 'beauty' of B", run.err)
        self.assertNotIn("of A", run.err)

    def test_seeds_must_be_of_one_kind(self):
        self.picture("a_9.exr", {**grey(1.0, W, H), **grey(1.0, W, H, "coat.")})
        self.picture("ref.exr", {**grey(1.0, W, H), **grey(1.0, W, H, "coat.")})
        run = self.expect(SCENE, "compare", "a_*.exr", "ref.exr")
        self.assertIn("a_9.exr: its layers are not those of a_0.exr", run.err)

    def test_what_is_no_side_is_refused(self):
        self.assertIn("no file matches", self.expect(SCENE, "compare", "x_*.exr", "ref.exr").err)
        self.assertIn("without --reference", self.expect(USAGE, "compare", "ref.exr", "a_*.exr").err)
        self.assertIn("empty", self.expect(USAGE, "compare", "a_0.exr,", "ref.exr").err)


class Files(CompareTest):
    def setUp(self):
        super().setUp()
        self.noisy("a.exr", 0.1, 1)
        self.noisy("b.exr", 0.1, 2)

    def test_heat_maps_are_pictures_of_the_frame(self):
        for metric, name in (("relative", "r.png"), ("flip", "f.png")):
            self.expect(0, "compare", "a.exr", "b.exr", "--heatmap", name, "--heatmap-metric", metric)
            info = subprocess.run([OIIOTOOL, "--info", name], cwd=self.folder, capture_output=True, text=True).stdout
            self.assertIn(f"{W} x   {H}, 3 channel", info)
        self.expect(0, "compare", "a.exr", "b.exr", "--reference", "b.exr", "--heatmap", "two.png")
        info = subprocess.run([OIIOTOOL, "--info", "two.png"], cwd=self.folder, capture_output=True, text=True).stdout
        self.assertIn(f"{2 * W} x   {H}", info)

    def test_a_heat_map_shows_where(self):
        numbers = grey(1.0, W, H)
        self.picture("b.exr", numbers)
        numbers["G"][5 * W + 9] = 2.0
        self.picture("a.exr", numbers)
        self.expect(0, "compare", "a.exr", "b.exr", "--heatmap", "h.png")
        subprocess.run([OIIOTOOL, "h.png", "-o", "h.ppm"], cwd=self.folder, check=True)
        pixels = (self.folder / "h.ppm").read_bytes()[-3 * W * H :]
        lit = [i // 3 for i in range(0, len(pixels), 3) if any(pixels[i : i + 3])]
        self.assertEqual(lit, [5 * W + 9])

    def test_outputs_are_checked_first_and_replace_no_picture(self):
        self.expect(USAGE, "compare", "a.exr", "b.exr", "--heatmap", "h.exr")
        self.expect(OUTPUT, "compare", "a.exr", "b.exr", "--heatmap", "nowhere/h.png")
        self.expect(USAGE, "compare", "a.exr", "b.exr", "--json", "b.exr")
        self.expect(USAGE, "compare", "a.exr", "b.exr", "--heatmap-metric", "ssim", "--heatmap", "h.png")
        self.assertEqual(self.files(), ["a.exr", "b.exr"])

    def test_json_goes_to_standard_output_alone(self):
        run = self.expect(0, "compare", "a.exr", "b.exr", "--json", "-")
        self.assertEqual(json.loads(run.out)["format"], 1)

    def test_what_is_no_picture_is_refused_by_name(self):
        self.write("text.exr", "no picture")
        whole = (self.folder / "a.exr").read_bytes()
        self.write("cut.exr", whole[: len(whole) // 2])
        self.write("part.tsf", "x")
        for name in ("text.exr", "cut.exr", "missing.exr", "part.tsf", "."):
            for args in ((name, "b.exr"), ("b.exr", name), ("a.exr", "b.exr", "--reference", name)):
                run = self.expect(SCENE, "compare", *args)
                self.assertIn(name, run.err)
        self.expect(USAGE, "compare", "a.exr")
        self.expect(USAGE, "compare")

    def test_names_in_files_do_not_reach_the_terminal_raw(self):
        for name in ("a.exr", "b.exr"):
            self.picture(name, {**grey(1.0, W, H), "\x1b[31mred.R": [1.0] * (W * H)})
        self.assertNotIn("\x1b", self.expect(0, "compare", "a.exr", "b.exr").out)


class Renders(CompareTest):
    def test_samples_bring_a_render_closer_and_equal_renders_are_equal(self):
        self.write_scene()
        self.render("--spp", 256, "--seed", 9, "--aov", "beauty", output="ref.exr")
        for seed in range(3):
            self.render("--spp", 2, "--seed", seed, "--aov", "beauty", output=f"few_{seed}.exr")
            self.render("--spp", 32, "--seed", seed, "--aov", "beauty", output=f"many_{seed}.exr")
        result, run = self.compare("few_*.exr", "many_*.exr", "--reference", "ref.exr", "--heatmap", "h.png")
        (layer,) = result["layers"]
        for name in ("rmse", "relmse", "trimmed_relmse", "psnr", "ssim", "flip"):
            self.assertEqual(layer["verdicts"][name], "b", name)
        self.render("--spp", 2, "--seed", 0, "--aov", "beauty", "-t", 2, "--tile", 8, output="again.exr")
        self.expect(0, "compare", "few_0.exr", "again.exr", "--fail-above", "different=0")
        self.expect(DIFFERS, "compare", "few_0.exr", "few_1.exr", "--fail-above", "different=0")


if __name__ == "__main__":
    unittest.main()
