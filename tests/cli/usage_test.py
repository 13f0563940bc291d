"""The command line itself: help, version, and what is refused as usage."""

import json
import os
import subprocess
import unittest

from support import OUTPUT, PROGRAM, SCENE, USAGE, TesseraTest

RENDER_OPTIONS = (
    "--output --spp --time --res --crop --threads --tile --seed --set --aov --stats --preview --float --strict --lenient "
    "--allow-external-assets --kernel --no-progress --progress --display"
).split()


class Help(TesseraTest):
    def test_help_names_every_subcommand(self):
        run = self.expect(0, "--help")
        for name in ("render", "info", "version"):
            self.assertIn(name, run.out)
        self.assertEqual(run.err, "")

    def test_render_help_names_every_option_and_has_examples(self):
        run = self.expect(0, "render", "--help")
        for option in RENDER_OPTIONS:
            if option == "--output":
                self.assertRegex(run.out, r"(?m)-o\b")
            else:
                self.assertIn(option, run.out)
        examples = (run.out + self.expect(0, "--help").out).lower()
        self.assertRegex(examples, r"example")
        self.assertRegex(examples, r"tessera render \S+.* -o \S+\.exr")

    def test_info_help_is_there(self):
        self.assertIn("--json", self.expect(0, "info", "--help").out)


class Version(TesseraTest):
    def test_version_is_one_line_with_the_number(self):
        run = self.expect(0, "version")
        self.assertRegex(run.out.splitlines()[0], r"tessera.*\d+\.\d+\.\d+")

    def test_version_json_agrees_with_the_text(self):
        fields = json.loads(self.expect(0, "version", "--json").out)
        self.assertRegex(fields["version"], r"^\d+\.\d+\.\d+")
        self.assertIn(fields["version"], self.expect(0, "version").out)

    def test_version_needs_nothing_from_the_environment(self):
        sanitizers = {key: value for key, value in os.environ.items() if key.endswith("SAN_OPTIONS")}
        self.expect(0, "version", env=sanitizers)


class Usage(TesseraTest):
    def refuse(self, *args, saying=""):
        run = self.expect(USAGE, *args)
        self.assertNotEqual(run.err.strip(), "", "a refusal says why on stderr")
        self.assertIn(saying, run.err)
        self.assertFalse((self.folder / "out.exr").exists())

    def test_no_arguments(self):
        self.refuse()

    def test_unknown_subcommand(self):
        self.refuse("rendr", "scene.toml", saying="rendr")

    def test_unknown_option(self):
        self.write_scene()
        self.refuse("render", "scene.toml", "-o", "out.exr", "--sppp", "4", saying="--sppp")

    def test_missing_scene(self):
        self.refuse("render", "-o", "out.exr")
        self.refuse("info")

    def test_outputs_of_a_wrong_kind(self):
        self.write_scene()
        self.refuse("render", "scene.toml", "-o", "out.xyz", saying=".exr")
        self.refuse("render", "scene.toml", "-o", "/dev/null", saying=".exr")
        self.refuse("render", "scene.toml", "-o", "out.png", saying="-o out.exr --preview out.png")
        self.refuse("render", "scene.toml", "-o", "out.exr", "--preview", "out.bmp", saying=".png")
        self.refuse("render", "scene.toml", "-o", "out.exr", "--preview", "out.png", "--view", "Nowhere", saying="Nowhere")

    def test_two_outputs_of_one_name(self):
        self.write_scene()
        self.refuse("render", "scene.toml", "-o", "out.exr", "--stats", "./out.exr", saying="--stats")

    def test_output_that_would_replace_an_input(self):
        self.write_scene()
        for name in ("scene.toml", "triangles.obj", "triangles.mtl"):
            before = (self.folder / name).read_bytes()
            self.refuse("render", "scene.toml", "-o", "out.exr", "--stats", name, saying=name)
            self.assertEqual((self.folder / name).read_bytes(), before)

    def test_values_out_of_range(self):
        self.write_scene()
        bad = [
            ("--spp", "0"),
            ("--spp", "-4"),
            ("--spp", "many"),
            ("--spp", "4x"),
            ("--spp", "99999999999999999999"),
            ("--time", "-1"),
            ("--time", "nan"),
            ("--res", "64"),
            ("--res", "0x10"),
            ("--res", "-64x48"),
            ("--res", "64x48x3"),
            ("--camera", "fisheye"),
            ("--camera-position", "1,2"),
            ("--camera-position", "1,2,3,4"),
            ("--camera-position", "1;2;3"),
            ("--camera-position", "nan,0,0"),
            ("--crop", "0,0,8"),
            ("--crop", "8,8,8,16"),
            ("--crop", "9,0,8,8"),
            ("--tile", "-8"),
            ("--seed", "x"),
            ("--seed", "-1"),
            ("--seed", "18446744073709551616"),
            ("--dwa-level", "nan"),
            ("--checkpoint=c.tsf --checkpoint-every", "nan"),
            ("--kernel", "warp"),
            ("--set", "camera"),
        ]
        for option, value in bad:
            with self.subTest(option=option, value=value):
                self.refuse("render", "scene.toml", "-o", "out.exr", *f"{option}={value}".split())

    def test_empty_values(self):
        self.write_scene()
        for option in ("--checkpoint", "--resume", "--output", "--crop", "--samples", "--aov", "--overscan", "--view"):
            with self.subTest(option=option):
                self.refuse("render", "scene.toml", option, "", saying="is empty")

    def test_standard_output_that_takes_nothing_is_an_output_error(self):
        with open("/dev/full", "w") as full:
            for command in (["render", "--list-aovs"], ["exrcheck", "--rules"]):
                done = subprocess.run([PROGRAM, *command], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
                self.assertEqual(done.returncode, OUTPUT, done.stderr)
                self.assertIn("standard output: cannot write", done.stderr)
                self.assertNotIn("internal", done.stderr)

    def test_pass_that_no_light_can_reach_is_warned_of(self):
        self.write_scene()
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--res", "8x8", "--spp", "1", "--aov", "mine = C<RD>T+")
        self.assertIn("warning: --aov: pass 'mine': no light can come by 'C<RD>T+', it stays black", run.err)
        (self.folder / "out.exr").unlink()
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--strict", "--aov", "mine = C<RD>T+")
        self.assertEqual(run.code, SCENE, run)

    def test_unknown_pass_is_refused_with_the_known_ones(self):
        self.write_scene()
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--aov", "albdo")
        self.assertEqual(run.code, USAGE, run)
        self.assertIn("--aov: pass 'albdo' is unknown (did you mean 'albedo'?)", run.err)
        for name in ("albedo", "diffuse_direct", "compositing", "light_groups"):
            self.assertIn(name, self.expect(0, "render", "--list-aovs").out)

    def test_set_of_an_unknown_key_suggests_the_nearest(self):
        self.write_scene()
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--set", "camera.fov_dge=35")
        self.assertIn(run.code, (USAGE, SCENE), run)
        self.assertIn("fov_deg", run.err)

    def test_crop_outside_the_frame(self):
        self.write_scene()
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--crop", "100,100,120,120")
        self.assertIn(run.code, (USAGE, SCENE), run)
        self.assertFalse((self.folder / "out.exr").exists())


if __name__ == "__main__":
    unittest.main()
