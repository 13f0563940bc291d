"""tessera converge: curves that agree with compare and render, files that agree with each other, and what fails is named."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from exr import Exr
from support import OUTPUT, PARTIAL, PROGRAM, SCENE, SCENE_TOML, SLOWDOWN, SOURCE, USAGE, TesseraTest, command

try:
    import jsonschema
except ImportError:
    jsonschema = None

# Another tessera, older than --passes.
OLD_PROGRAM = f"""\
#!/bin/sh
case "$*" in
    *--help*) "{PROGRAM}" "$@" | grep -v -e --passes; exit 0 ;;
    *--passes*) echo "the old one: what is --passes?" >&2; exit 2 ;;
esac
echo "$*" >> old.log
exec "{PROGRAM}" "$@"
"""


class Converge(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def converge(self, *args, code=0, scenes=("scene.toml",), out="out", timeout=200):
        run = self.expect(code, "converge", *scenes, "-o", out, "-t", "2", *args, timeout=timeout)
        return run, self.report(out)

    def report(self, out="out"):
        path = self.folder / out / "report.json"
        return json.loads(path.read_text(), parse_constant=self.fail) if path.exists() else None

    def rows(self, out="out"):
        with open(self.folder / out / "curves.csv", newline="") as file:
            return list(csv.DictReader(file))

    def assert_used(self, run, seconds):
        """Most of the time was rendered, not more: the render's own promise has tests of its own, on idle machines."""
        wall = run["curve"][-1]["wall"]
        self.assertGreater(wall, 0.4 * seconds)
        self.assertLess(wall, 1.2 * seconds)

    def program(self, name, text):
        path = self.write(name, text)
        path.chmod(0o755)
        return path


class Curves(Converge):
    def test_every_point_is_the_picture_of_so_many_samples(self):
        _, report = self.converge("--spp", "24", "--reference-spp", "256", "--vary", "max_depth=1,8")
        (scene,) = report["scenes"]
        self.assertEqual([r["series"] for r in scene["runs"]], ["max_depth=1", "max_depth=8"])
        for run in scene["runs"]:
            self.assertEqual([p["spp"] for p in run["curve"]], [1, 2, 4, 8, 16, 24])
            self.assertTrue(all(a["wall"] < b["wall"] for a, b in zip(run["curve"], run["curve"][1:])))
            self.assertIsNone(run["curve"][0]["estimate"])
            self.assertGreater(run["curve"][2]["estimate"]["relmse"]["value"], 0)
        for spp, index in ((8, 3), (24, 5)):
            self.render("--spp", spp, "--float", "--set", "render.max_depth=1", "--aov", "beauty", output="x.exr")
            compared = self.expect(0, "compare", "x.exr", scene["reference"]["file"], "--json", "-")
            metrics = json.loads(compared.out)["layers"][0]["a"]["metrics"]
            for name, value in scene["runs"][0]["curve"][index]["error"].items():
                self.assertEqual(value, metrics[name]["value"], (spp, name))

    def test_what_no_sample_can_find_stays_in_the_error(self):
        cornell = SOURCE / "scenes" / "cornell" / "cornell.toml"
        args = ("--res", "24x24", "--spp", "256", "--reference-spp", "2048", "--vary", "max_depth=1,12")
        _, report = self.converge(*args, scenes=(cornell,))
        for run, falls in zip(report["scenes"][0]["runs"], (False, True)):
            errors = {p["spp"]: p["error"]["relmse"] for p in run["curve"]}
            self.assertEqual(errors[256] < 0.6 * errors[64], falls, run["series"])

    def test_files_agree_with_each_other_and_with_their_schema(self):
        _, report = self.converge("--spp", "8", "--reference-spp", "64", "--seeds", "2", "--set", "film.resolution=[24, 16]")
        (scene,) = report["scenes"]
        self.assertEqual(scene["resolution"], [24, 16])
        points = [(r["seed"], p) for r in scene["runs"] for p in r["curve"]]
        rows = self.rows()
        self.assertEqual(len(rows), len(points))
        for row, (seed, p) in zip(rows, points):
            self.assertEqual((int(row["seed"]), int(row["spp"]), int(row["rays"])), (seed, p["spp"], p["rays"]))
            self.assertEqual(float(row["relmse"]), p["error"]["relmse"])
            self.assertEqual(float(row["wall"]), p["wall"])
            if p["estimate"]:
                self.assertEqual(float(row["estimate_relmse_low"]), p["estimate"]["relmse"]["low"])
        (series,) = scene["series"]
        errors = [r["curve"][-1]["error"]["relmse"] for r in scene["runs"]]
        self.assertNotEqual(*errors)
        self.assertAlmostEqual(series["error"]["relmse"]["value"], sum(errors) / 2)
        self.assertLess(series["error"]["relmse"]["low"], min(errors))
        for kind in ("relmse", "rmse", "flip"):
            for axis in ("wall", "spp"):
                plot = self.folder / "out" / "plots" / f"scene-{kind}-{axis}"
                self.assertTrue(plot.with_suffix(".svg").read_text().endswith("</svg>\n"))
                self.assertEqual(plot.with_suffix(".png").read_bytes()[:4], b"\x89PNG")
        self.assertTrue((self.folder / scene["runs"][1]["picture"]).exists())
        self.assertFalse([f for f in self.files() if ".work" in f], "nothing is left over")
        if jsonschema:
            schema = json.loads((SOURCE / "docs" / "converge.schema.json").read_text())
            jsonschema.validators.validator_for(schema).check_schema(schema)
            jsonschema.validate(report, schema)
            for broken in ({}, {**report, "format": 2}, {**report, "more": 1}):
                with self.assertRaises(jsonschema.ValidationError):
                    jsonschema.validate(broken, schema)

    def test_a_time_is_used_and_comparing_is_not_in_it(self):
        start = time.monotonic()
        _, report = self.converge("--time", "0.6", "--reference-spp", "16")
        (run,) = report["scenes"][0]["runs"]
        self.assert_used(run, 0.6)
        self.assertGreater(time.monotonic() - start, run["curve"][-1]["wall"])

    def test_without_a_reference_the_estimate_stands_in(self):
        _, report = self.converge("--spp", "16")
        (scene,) = report["scenes"]
        self.assertIsNone(scene["reference"])
        self.assertIsNone(scene["runs"][0]["curve"][-1]["error"])
        self.assertIsNone(scene["series"][0]["error"]["relmse"])
        self.assertLess(scene["series"][0]["slope"]["spp"]["value"], -0.5)
        self.assertEqual(self.rows()[0]["relmse"], "")
        self.assertFalse((self.folder / "out/plots/scene-flip-wall.svg").exists())


    def test_it_says_what_makes_the_error(self):
        self.converge("--spp", "32", "--vary", "max_depth=0,4", "--attribute")
        for run in self.report()["scenes"][0]["runs"]:
            shares = [cause["share"] for cause in run["causes"]]
            self.assertEqual(shares, sorted(shares, reverse=True))
            self.assertGreater(shares[0], 0.1)
            self.assertTrue(run["causes"][0]["remedy"])
            self.assertEqual("indirect light" in [c["paths"] for c in run["causes"]], run["settings"]["max_depth"] == "4")
        self.assertIn("What makes the error", (self.folder / "out/report.html").read_text())


class Passes(Converge):
    """render --passes"""

    def test_each_pass_is_a_picture_with_its_statistics(self):
        whole = self.render("--spp", "6", "--float", "--passes", "p/q", "--seed", "3")
        self.assertEqual(
            [f for f in self.files() if f.startswith("p/")],
            [f"p/q/{n:06}.{kind}" for n in (1, 2, 4, 6) for kind in ("exr", "json")],
        )
        self.assert_same_bits(Exr(self.folder / "p/q/000006.exr"), whole)
        self.assert_same_bits(Exr(self.folder / "p/q/000004.exr"), self.render("--spp", "4", "--float", "--seed", "3"))
        statistics = json.loads((self.folder / "p/q/000004.json").read_text())
        self.assertEqual((statistics["spp"], statistics["samples"], statistics["seed"]), (4, 4 * 48 * 32, 3))
        self.assertGreater(statistics["seconds"]["load"], 0)

    def test_a_folder_that_cannot_be_is_found_out_before_the_render(self):
        self.write("file", "")
        run = self.expect(OUTPUT, "render", "scene.toml", "-o", "x.exr", "--passes", "file/p")
        self.assertIn("file/p: cannot write", run.err)
        self.assertFalse((self.folder / "x.exr").exists())


class References(Converge):
    def test_one_that_fits_is_used_again_and_any_other_is_rendered_anew(self):
        def rendered(*args):
            run, _ = self.converge("--spp", "4", *args)
            kept = self.folder / "out/references/scene.exr"
            return ("is it already" not in run.err), kept.stat().st_mtime_ns

        first, made = rendered("--reference-spp", "32")
        again, kept = rendered("--reference-spp", "32")
        self.assertEqual((first, again, made), (True, False, kept))
        self.assertTrue(rendered("--reference-spp", "33")[0])
        self.assertTrue(rendered("--reference-spp", "33", "--set", "camera.fov_deg=41")[0])
        self.assertTrue(rendered("--reference-spp", "33", "--res", "32x32")[0])
        (self.folder / "out/references/scene.exr").write_bytes(b"no picture")
        self.assertTrue(rendered("--reference-spp", "33", "--res", "32x32")[0])

    def test_a_picture_or_another_scene_may_be_it(self):
        self.render("--spp", "64", "--float", output="given.exr")
        _, report = self.converge("--spp", "4", "--reference", "given.exr")
        self.assertEqual(report["scenes"][0]["reference"]["file"], "given.exr")
        self.write("other.toml", SCENE_TOML.replace("radiance = [12, 12, 11]", "radiance = [6, 6, 6]"))
        _, report = self.converge("--spp", "4", "--reference", "other.toml", "--reference-spp", "16")
        self.assertEqual(report["scenes"][0]["reference"]["scene"], "other.toml")
        self.assertGreater(report["scenes"][0]["series"][0]["error"]["relmse"]["value"], 0.3)

    def test_one_that_does_not_fit_is_refused_before_anything_is_rendered(self):
        self.render("--res", "20x10", output="small.exr")
        for option, value in (("--reference", "small.exr"), ("--picture", "it=small.exr@2")):
            run, report = self.converge("--spp", "4", option, value, code=SCENE)
            self.assertIn(f"small.exr: is 20 x 10 pixels, scene 'scene' is 48 x 32 ({option})", run.err)
            self.assertEqual(report["scenes"], [])
        self.expect(0, "render", "scene.toml", "-o", "x.exr", "--preview", "shown.png")
        run, _ = self.converge("--spp", "4", "--reference", "shown.png", code=SCENE)
        self.assertIn("shown.png: has integers for a display, errors need floats", run.err)
        run, _ = self.converge("--spp", "4", "--reference", "nowhere.exr", code=SCENE)
        self.assertIn("nowhere.exr", run.err)


class Others(Converge):
    def test_an_older_build_is_run_once_for_each_point_and_gives_the_same_errors(self):
        old = self.program("old", OLD_PROGRAM)
        _, report = self.converge("--spp", "20", "--reference-spp", "64", "--build", f"old={old}")
        this, other = report["scenes"][0]["runs"]
        self.assertEqual((this["build"], other["build"]), ("this", "old"))
        self.assertEqual([p["spp"] for p in other["curve"]], [4, 8, 16, 20])
        self.assertEqual(len((self.folder / "old.log").read_text().splitlines()), 4)
        errors = {p["spp"]: p["error"] for p in this["curve"]}
        for p in other["curve"]:
            self.assertEqual(p["error"], errors[p["spp"]])

    def test_a_build_fills_its_time_too(self):
        old = self.program("old", OLD_PROGRAM)
        _, report = self.converge("--time", "0.5", "--build", f"old={old}")
        self.assert_used(report["scenes"][0]["runs"][1], 0.5)

    def test_a_build_that_fails_is_named_and_the_others_go_on(self):
        bad = self.program("bad", '#!/bin/sh\ncase "$*" in *--help*) exit 0;; esac\necho "out of luck" >&2\nexit 7\n')
        run, report = self.converge("--spp", "4", "--build", f"bad={bad}", code=SCENE)
        self.assertIn("scene, bad, seed 0: out of luck", run.err)
        this, other = report["scenes"][0]["runs"]
        self.assertEqual((this["failure"], other["failure"]), (None, "out of luck"))
        self.assertEqual([s["label"] for s in report["scenes"][0]["series"]], ["this"])
        self.assertIn("out of luck", (self.folder / "out/report.html").read_text())
        crash = self.program("crash", '#!/bin/sh\ncase "$*" in *--help*) exit 0;; esac\nkill -SEGV $$\n')
        run, _ = self.converge("--spp", "4", "--build", f"crash={crash}", code=SCENE)
        self.assertIn("ended by signal 11", run.err)

    def test_pictures_and_times_on_record_stand_beside(self):
        self.render("--spp", "9", "--float", output="theirs.exr")
        _, report = self.converge(
            "--spp", "4", "--reference-spp", "64", "--picture", "theirs=theirs.exr@1.5", "--history", "VAX-11/780, 1980@4440"
        )
        (scene,) = report["scenes"]
        (picture,) = scene["pictures"]
        self.assertEqual((picture["label"], picture["wall"]), ("theirs", 1.5))
        self.assertGreater(picture["error"]["relmse"], 0)
        self.assertEqual(scene["history"], [{"label": "VAX-11/780, 1980", "wall": 4440}])
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("74 min", page)
        self.assertLess(page.index("74 min"), page.index("data-series="), "it is the first row")

    def test_files_of_one_name_are_one_scene(self):
        self.write("deep.toml", SCENE_TOML.replace("spp = 4", "spp = 4\n    max_depth = 2"))
        _, report = self.converge("--spp", "4", scenes=("both=scene.toml", "both=deep.toml"))
        (scene,) = report["scenes"]
        self.assertEqual((scene["name"], [s["label"] for s in scene["series"]]), ("both", ["scene", "deep"]))

    def test_names_that_are_alike_as_files_and_files_of_one_name_stay_apart(self):
        self.write("sub/scene.toml", SCENE_TOML.replace('"triangles.obj"', '"../triangles.obj"'))
        scenes = ("a/b=scene.toml", "a b=scene.toml", "a b=sub/scene.toml")
        _, report = self.converge("--spp", "4", "--allow-external-assets", scenes=scenes)
        self.assertEqual([s["label"] for s in report["scenes"][1]["series"]], ["scene.toml", "sub/scene.toml"])
        files = [r["picture"] for s in report["scenes"] for r in s["runs"]]
        self.assertEqual(len(set(files)), 3, files)
        self.assertEqual(len(list(self.folder.glob("out/plots/*-relmse-wall.svg"))), 2)

    def test_a_name_cannot_break_the_page_or_leave_the_folder(self):
        name = "../</script><b>x"
        _, report = self.converge("--spp", "4", scenes=(f"{name}=scene.toml",))
        self.assertEqual(report["scenes"][0]["name"], name)
        page = (self.folder / "out/report.html").read_text()
        self.assertNotIn("<b>", page)
        self.assertEqual(page.count("</script>"), 2)
        self.assertFalse([f for f in self.files() if "/" not in f and not f.startswith(("scene", "triangles"))])


class Mistakes(Converge):
    def refused(self, text, *args, code=USAGE, scenes=("scene.toml",)):
        run, report = self.converge(*args, code=code, scenes=scenes)
        self.assertIn(text, run.err)
        if code == USAGE:
            self.assertIsNone(report)

    def test_of_words_are_usage(self):
        self.refused("how far? give --time SECONDS, --spp N, or both")
        for vary, text in (
            ("max_dept=4", "max_depth"),
            ("max_depth=4,x", "--vary max_depth=4,x"),
            ("max_depth=4,4", "'4' is there twice"),
            ("max_depth=4,", "a value is empty"),
            ("max_depth", "must be KEY=A,B"),
            ("spp=4,8", "samples are what errors are plotted against"),
        ):
            self.refused(text, "--spp", "4", "--vary", vary)
        self.refused("--seeds varies the seed already", "--spp", "4", "--vary", "seed=1,2", "--seeds", "2")
        self.refused("the key is varied already", "--spp", "4", "--vary", "seed=1,2", "--vary", "seed=3")
        self.refused("must be LABEL=PROGRAM", "--spp", "4", "--build", "x")
        self.refused("cannot be run: No such file", "--spp", "4", "--build", "x=./nowhere")
        self.refused("is no tessera", "--spp", "4", "--build", "x=/bin/false")
        self.refused("must be LABEL=FILE@SECONDS", "--spp", "4", "--picture", "x=y@-1")
        self.refused("must be LABEL@SECONDS", "--spp", "4", "--history", "x")
        self.refused("is a scene; how many samples", "--spp", "4", "--reference", "scene.toml")
        two = ("scene.toml", "b=scene.toml")
        self.refused("of which scene? write scene=", "--spp", "4", "--reference", "r.exr", scenes=two)
        self.refused("no scene has the name 'sce'", "--spp", "4", "--reference", "sce=r.exr", scenes=two)
        self.refused("the file is there twice", "--spp", "4", scenes=("a=scene.toml", "a=scene.toml"))
        self.refused("of which scene? write scene/", "--spp", "4", "--history", "x@1", scenes=two)

    def test_in_a_scene_are_named_with_their_place_and_the_others_go_on(self):
        self.write("bad.toml", "tessera = 1\n[camera]\nfov_deg = 190\n")
        run, report = self.converge("--spp", "4", scenes=("bad.toml", "scene.toml"), code=SCENE)
        self.assertIn("scene 'bad': bad.toml:3:", run.err)
        self.assertEqual([s["name"] for s in report["scenes"]], ["scene"])
        self.assertEqual(len(report["failures"]), 1)

    def test_a_folder_that_cannot_be_is_an_output_error(self):
        self.write("file", "")
        run = self.expect(OUTPUT, "converge", "scene.toml", "--spp", "4", "-o", "file/out")
        self.assertIn("file/out", run.err)


class Stopped(Converge):
    def test_by_a_signal_it_writes_what_there_is(self):
        process = subprocess.Popen(
            command("converge", "scene.toml", "b=scene.toml", "--time", "40", "-o", "out", "-t", "2"),
            cwd=self.folder,
            stderr=subprocess.DEVNULL,
        )
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 20 * SLOWDOWN
        while not list(self.folder.glob("out/.work.*/0/0-0/passes/000004.json")):
            self.assertLess(time.monotonic(), deadline, "no pass is finished")
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20 * SLOWDOWN), PARTIAL)
        report = self.report()
        self.assertFalse(report["complete"])
        (scene,) = report["scenes"]
        (run,) = scene["runs"]
        self.assertFalse(run["complete"])
        self.assertGreaterEqual(run["curve"][-1]["spp"], 4)
        self.assertLess(run["curve"][-1]["wall"], 30)
        self.assertIn("Stopped by a signal", (self.folder / "out/report.html").read_text())
        self.assertEqual(list(self.folder.glob("out/.work*")), [])

    def test_its_render_does_not_outlive_it(self):
        process = subprocess.Popen(
            command("converge", "scene.toml", "--time", "40", "-o", "out", "-t", "1"), cwd=self.folder, stderr=subprocess.DEVNULL
        )
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 20 * SLOWDOWN
        while not list(self.folder.glob("out/.work.*/0/0-0/passes/000004.json")):
            self.assertLess(time.monotonic(), deadline, "no pass is finished")
            time.sleep(0.02)
        (child,) = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        process.kill()
        process.wait(timeout=20)
        while os.path.exists(f"/proc/{child}/cwd") and os.path.realpath(f"/proc/{child}/cwd") == str(self.folder.resolve()):
            self.assertLess(time.monotonic(), deadline, "the render goes on")
            time.sleep(0.02)


if __name__ == "__main__":
    unittest.main()
