#!/usr/bin/env python3
"""How wrong a picture is: in the log, the statistics and the header; --error, and what it takes."""

import json
import struct
import unittest

from exr import Exr
from support import USAGE, TesseraTest

SCENE = """
tessera = 1
[camera]
position = [0, 1.5, 5]
look_at = [0, 0.6, 0]
fov_deg = 40
[film]
resolution = [48, 32]
[render]
spp = 16
[environment]
radiance = [0.5, 0.6, 0.7]
[[sphere]]
center = [0, 0.7, 0]
radius = 0.7
[[disc]]
normal = [0, 1, 0]
radius = 8
"""


class Errors(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write("a.toml", SCENE)

    def statistics(self, *arguments):
        run = self.expect(0, "render", "a.toml", "-o", "a.exr", "--stats", "a.json", "--no-progress", *arguments)
        return run, json.loads((self.folder / "a.json").read_text())

    def number(self, file, name):
        return struct.unpack("<f", Exr(self.folder / file).attributes["tessera/error/" + name][1])[0]

    def test_every_picture_says_how_wrong_it_is(self):
        run, statistics = self.statistics()
        beauty = statistics["error"]["beauty"]
        for metric in ("rmse", "relmse", "worst_tile"):
            error = beauty[metric]
            self.assertLess(0, error["low"])
            self.assertLess(error["low"], error["value"])
            self.assertLess(error["value"], error["high"])
        self.assertRegex(run.err, r"error    relMSE [0-9.e-]+ \([0-9.e-]+ to [0-9.e-]+")
        spp = [p["spp"] for p in beauty["curve"]]
        self.assertEqual(spp, [4, 16])
        self.assertLess(beauty["curve"][1]["rmse"]["value"], beauty["curve"][0]["rmse"]["value"])
        self.assertIsNone(statistics["error"]["target"])
        self.assertAlmostEqual(self.number("a.exr", "relmse"), beauty["relmse"]["value"], places=6)
        self.assertAlmostEqual(self.number("a.exr", "rmseHigh"), beauty["rmse"]["high"], places=6)

    def test_its_causes_are_told_when_asked_for_or_when_it_is_unreliable(self):
        run, statistics = self.statistics("--spp", "64", "--error-causes")
        causes = statistics["error"]["beauty"]["causes"]
        self.assertIn(causes[0]["light"], ("environment", ""))
        self.assertAlmostEqual(1, sum(c["share"] for c in causes), places=4)  # no more than eight
        self.assertRegex(run.err, r"cause    [0-9]+ % of the error: ")
        self.assertIn("remedy   " + causes[0]["remedy"], run.err)
        run, statistics = self.statistics("--spp", "64")
        estimate = statistics["error"]["beauty"]
        reliable = estimate["rmse"]["reliable"] and estimate["relmse"]["reliable"]
        self.assertEqual(reliable, estimate["causes"] == [])
        self.expect(USAGE, "render", "a.toml", "-o", "a.exr", "--error-causes", "--no-error-estimate")

    def test_it_can_be_left_out_and_the_picture_is_the_same(self):
        _, with_it = self.statistics("--float")
        first = Exr(self.folder / "a.exr")
        run, without = self.statistics("--float", "--no-error-estimate")
        self.assertIsNone(without["error"]["beauty"])
        self.assertNotIn("error ", run.err)
        self.assertLess(without["memory_bytes"]["film"], with_it["memory_bytes"]["film"])
        second = Exr(self.folder / "a.exr")
        self.assert_same_bits(first, second)

    def test_fewer_than_four_samples_say_nothing(self):
        run, statistics = self.statistics("--spp", "3")
        self.assertIsNone(statistics["error"]["beauty"])
        self.assertIn("unknown: fewer than 4 samples", run.err)

    def test_a_target_is_reached_and_not_by_more_than_need_be(self):
        run, statistics = self.statistics("--error", "0.0005")
        error = statistics["error"]
        self.assertEqual(error["target"], {"metric": "relmse", "value": 0.0005, "reached": True})
        self.assertLessEqual(error["beauty"]["relmse"]["high"], 0.0005)
        self.assertGreater(statistics["spp"], 16)  # more than the scene's
        before = error["beauty"]["curve"][-2]
        self.assertGreater(before["relmse"]["high"], 0.0005)
        self.assertRegex(run.err, r"relMSE 0.0005 takes about [0-9]+ spp")

    def test_samples_or_seconds_end_it_before(self):
        run, statistics = self.statistics("--error", "rmse=1e-9", "--spp", "32")
        self.assertEqual(statistics["spp"], 32)
        self.assertEqual(statistics["error"]["target"]["reached"], False)
        self.assertIn("was not reached: 32 samples a pixel or the time were used up", run.err)
        _, statistics = self.statistics("--error", "rmse=1e-9", "--time", "1")
        self.assertEqual(statistics["error"]["target"]["reached"], False)

    def test_equal_bits_for_any_number_of_threads(self):
        _, one = self.statistics("-t", "1")
        _, two = self.statistics("-t", "2", "--tile", "8")
        for metric in ("rmse", "relmse", "worst_tile"):
            self.assertEqual(one["error"]["beauty"][metric], two["error"]["beauty"][metric])

    def test_merged_parts_say_what_the_whole_says(self):
        _, whole = self.statistics()
        for part in ("0:6", "6:16"):
            self.expect(0, "render", "a.toml", "--samples", part, "-o", part[0] + ".tsf", "-q")
        self.expect(0, "merge", "0.tsf", "6.tsf", "-o", "m.exr")
        self.assertAlmostEqual(self.number("m.exr", "relmse"), whole["error"]["beauty"]["relmse"]["value"], places=7)

    def test_bad_targets_are_refused(self):
        for text in ("0", "-1", "nan", "inf", "x", "relmse=", "psnr=3", "0.1x"):
            run = self.expect(USAGE, "render", "a.toml", "--error", text, "-o", "a.exr")
            self.assertIn("is no error above 0", run.err)
        self.expect(USAGE, "render", "a.toml", "--error", "0.1", "--no-error-estimate", "-o", "a.exr")


if __name__ == "__main__":
    unittest.main()
