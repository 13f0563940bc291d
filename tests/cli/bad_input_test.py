"""Scenes, models and images that are broken: a located message, exit code 3, no output, no crash, no hang."""

import math
import os
import unittest
import zlib

from exr import Exr
from support import MEMORY, SCENE, SCENE_TOML, SLOWDOWN, TRIANGLES_OBJ, USAGE, TesseraTest

# One good triangle, for models of which a part is broken.
GOOD = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


class BadInput(TesseraTest):
    def render_run(self, scene, *args):
        return self.run_program("render", scene, "-o", "out.exr", "--res", "24x16", "--spp", "1", *args)

    def refuse(self, scene, place, *args):
        """Expects exit code 3, a message with the place, and that no file appeared."""
        before = self.files()
        run = self.render_run(scene, *args)
        self.assertEqual(run.code, SCENE, run)
        self.assertIn(place, run.err)
        self.assertEqual(self.files(), before)
        self.assertLess(run.seconds, 10 * SLOWDOWN)
        return run

    def refuse_toml(self, text, place, *words):
        self.write_scene()
        self.write("bad.toml", text)
        run = self.refuse("bad.toml", place)
        for word in words:
            self.assertIn(word, run.err)


class BadScene(BadInput):
    def test_missing_file_folder_and_unknown_kind(self):
        self.refuse("nowhere.toml", "nowhere.toml")
        self.refuse("nowhere.obj", "nowhere.obj")
        (self.folder / "folder.toml").mkdir()
        self.refuse("folder.toml", "folder.toml")
        self.write("scene.blend", "BLENDER")
        run = self.render_run("scene.blend")
        self.assertIn(run.code, (USAGE, SCENE), run)
        self.assertIn("scene.blend", run.err)

    def test_pipe_is_refused_without_waiting_for_a_writer(self):
        os.mkfifo(self.folder / "pipe.obj")
        self.refuse("pipe.obj", "pipe.obj")

    def test_empty_and_binary_scene(self):
        self.write("empty.toml", "")
        self.refuse("empty.toml", "empty.toml")
        self.write("junk.toml", bytes(range(256)) * 16)
        self.refuse("junk.toml", "junk.toml")

    def test_syntax_error_has_line_and_column(self):
        self.refuse_toml("tessera = 1\n[camera]\nfov_deg = = 3\n", "bad.toml:3:")
        self.refuse_toml("tessera = 1\n[camera\n", "bad.toml:2:")
        self.refuse_toml('tessera = 1\n[[mesh]]\nname = "open\n', "bad.toml:3:")

    def test_unknown_key_suggests_the_nearest(self):
        self.refuse_toml(SCENE_TOML.replace("fov_deg", "fov_dge"), "bad.toml:5:", "fov_dge", "fov_deg")
        self.refuse_toml("tessera = 1\n[camra]\n", "bad.toml:2:", "camra", "camera")

    def test_wrong_type_and_range(self):
        for old, new, line in (
            ("fov_deg = 40", 'fov_deg = "wide"', 5),
            ("fov_deg = 40", "fov_deg = 190", 5),
            ("fov_deg = 40", "fov_deg = nan", 5),
            ("position = [0, 1.2, 4]", "position = [0, 1.2]", 3),
            ("position = [0, 1.2, 4]", "position = [0, inf, 4]", 3),
            ("resolution = [48, 32]", "resolution = [48, 0]", 7),
            ("resolution = [48, 32]", "resolution = [-48, 32]", 7),
            ("spp = 4", "spp = -4", 9),
            ("spp = 4", "spp = 4.5", 9),
            ('type = "quad"', 'type = "qaud"', 16),
        ):
            with self.subTest(new=new):
                self.refuse_toml(SCENE_TOML.replace(old, new), f"bad.toml:{line}:")

    def test_passes_that_are_none(self):
        for aovs, said in (('["albdo"]', "did you mean 'albedo'"), ('["mine = C<R"]', "character")):
            with self.subTest(aovs=aovs):
                text = SCENE_TOML.replace("resolution = [48, 32]", f"resolution = [48, 32]\naovs = {aovs}")
                self.refuse_toml(text, "bad.toml:8:", said)

    def test_several_errors_are_told_at_once(self):
        text = SCENE_TOML.replace("fov_deg = 40", "fov_deg = 190").replace("spp = 4", "spp = -4")
        self.refuse_toml(text, "bad.toml:5:", "bad.toml:9:")

    def test_missing_mesh_and_unknown_instance(self):
        self.refuse_toml(SCENE_TOML.replace("triangles.obj", "nowhere.obj"), "bad.toml:", "nowhere.obj")
        self.refuse_toml(SCENE_TOML.replace('of = "triangles"', 'of = "tringles"'), "bad.toml:", "triangles")

    def test_include_of_itself_and_of_nothing(self):
        self.refuse_toml('tessera = 1\ninclude = ["bad.toml"]\n', "bad.toml")
        self.refuse_toml('tessera = 1\ninclude = ["nowhere.toml"]\n', "nowhere.toml")

    def test_newer_version_of_the_format(self):
        self.refuse_toml("tessera = 999\n", "bad.toml:1:")

    def test_absurd_resolution_is_refused_before_memory_is_taken(self):
        self.write_scene(SCENE_TOML.replace("[48, 32]", "[2000000000, 2000000000]"))
        run = self.run_program("render", "scene.toml", "-o", "out.exr")
        self.assertIn(run.code, (SCENE, MEMORY), run)
        self.assertFalse((self.folder / "out.exr").exists())

    def test_deep_nesting_does_not_exhaust_the_stack(self):
        self.write("bad.toml", "tessera = 1\na = " + "[" * 100000)
        self.refuse("bad.toml", "bad.toml")

    def test_truncated_transforms(self):
        self.write("rows.f32", b"\0" * 50)
        text = SCENE_TOML.replace('of = "triangles"', 'of = "triangles"\n    transforms = "rows.f32"')
        self.refuse_toml(text, "bad.toml:", "rows.f32")


class BadModel(BadInput):
    def test_models_without_a_face_are_refused(self):
        for name, content in {
            "empty.obj": b"",
            "comments.obj": b"# nothing\n",
            "vertices.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\n",
            "junk.obj": bytes((i * 197 + 31) % 256 for i in range(4096)),
            "no_vertices.obj": b"f 1 2 3\n",
            "all_nan.obj": b"v nan 0 0\nv nan 1 0\nv nan 0 1\nf 1 2 3\n",
        }.items():
            with self.subTest(name=name):
                self.write(name, content)
                self.refuse(name, name)
                (self.folder / name).unlink()

    def test_broken_parts_are_located_and_never_shown(self):
        for name, line, content in (
            ("past_the_end.obj", 5, GOOD + "f 1 2 9\n"),
            ("zero.obj", 5, GOOD + "f 0 1 2\n"),
            ("negative.obj", 5, GOOD + "f -9 -1 -2\n"),
            ("wraps.obj", 5, GOOD + "f 4294967297 2 3\n"),
            ("huge.obj", 5, GOOD + "f 99999999999999999999999 2 3\n"),
            ("letters.obj", 5, GOOD + "f a b c\n"),
            ("comma.obj", 5, GOOD + "v 0,5 1,25 0\nf 1 2 4\n"),
            ("nan.obj", 5, GOOD + "v nan inf 1e999\nf 1 2 4\n"),
            ("cut.obj", 5, GOOD + "f 1 2 -"),
        ):
            with self.subTest(name=name):
                self.write(name, content)
                # The broken face may stand a line after the broken vertex.
                place = rf"{name}:({line}|{line + 1})\b"
                self.assertRegex(self.refuse(name, name).err, place)
                if "comma" in name:
                    continue
                run = self.render_run(name, "--lenient")
                self.assertEqual(run.code, 0, run)
                self.assertRegex(run.err, place)
                exr = Exr(self.folder / "out.exr")
                self.assertTrue(all(math.isfinite(v) for c in "RGBA" for v in exr.values(c)))
                (self.folder / "out.exr").unlink()

    def test_strict_and_lenient_exclude_each_other(self):
        self.write("good.obj", GOOD)
        self.assertEqual(self.render_run("good.obj", "--lenient", "--strict").code, USAGE)

    def test_strict_refuses_what_would_be_a_warning(self):
        self.write("bad.obj", GOOD + "f 1/1 2/2 3/3\n")
        self.refuse("bad.obj", "bad.obj:5", "--strict")

    def test_very_long_line_and_very_many_corners_end_quickly(self):
        self.write("corners.obj", GOOD + "f " + "1 2 3 " * 30000 + "\n")
        self.assertIn(self.render_run("corners.obj").code, (0, SCENE))
        self.write("line.obj", GOOD + "v " + "1" * 500000 + "\n")
        self.assertIn(self.render_run("line.obj").code, (0, SCENE))

    def test_file_of_gigabytes_without_a_line_ends_quickly(self):
        with open(self.folder / "sparse.obj", "wb") as file:
            file.truncate(3 << 30)
        self.refuse("sparse.obj", "sparse.obj")
        (self.folder / "sparse.obj").rename(self.folder / "sparse.mtl")
        self.write("model.obj", "mtllib sparse.mtl\n" + GOOD)
        run = self.render_run("model.obj")
        self.assertEqual(run.code, 0, run)
        self.assertRegex(run.err, r"model\.obj:1: .*sparse\.mtl")

    def test_awkward_but_good_model_renders(self):
        text = "\ufeffv 0 0 0\r\nv 1 0 0 # comment\r\nv 1 1 0\r\nv 0 1 0\r\nusemtl none at all\r\nf -4 \\\r\n -3 -2 -1"
        self.write("awkward.obj", text.encode())
        run = self.render_run("awkward.obj")
        self.assertEqual(run.code, 0, run)

    def test_far_model_looks_like_the_near_one(self):
        self.write("near.obj", GOOD)
        self.write("far.obj", GOOD.replace("v 0", "v 5000000").replace("v 1", "v 5000001"))
        pictures = []
        for name in ("near.obj", "far.obj"):
            run = self.render_run(name, "--aov", "Z")
            self.assertEqual(run.code, 0, run)
            pictures.append(Exr(self.folder / "out.exr").pixels())
        self.assertEqual(pictures[0]["A"], pictures[1]["A"])


class BadAsset(BadInput):
    def textured(self, file):
        """A floor with the texture in its MTL."""
        self.write_scene()
        self.write("triangles.mtl", f"newmtl grey\nKd 1 1 1\nmap_Kd {file}\nnewmtl red\nKd 0.7 0.1 0.1\n")

    def check_magenta(self, *args):
        run = self.run_program("render", "scene.toml", "-o", "out.exr", *args)
        self.assertEqual(run.code, 0, run)
        exr = Exr(self.folder / "out.exr")
        red, green, blue = (exr.value(f"albedo.{c}", 24, 28) for c in "RGB")
        self.assertLess(green, 0.5 * min(red, blue))
        return run

    def test_missing_texture_is_a_warning_and_magenta(self):
        self.textured("nowhere.png")
        self.assertRegex(self.check_magenta().err, r"triangles\.mtl:3.*nowhere\.png")

    def test_missing_texture_is_an_error_under_strict(self):
        self.textured("nowhere.png")
        self.refuse("scene.toml", "nowhere.png", "--strict")

    def test_pipe_as_texture_is_magenta_without_waiting_for_a_writer(self):
        self.textured("pipe.png")
        os.mkfifo(self.folder / "pipe.png")
        self.assertIn("pipe.png", self.check_magenta().err)

    def test_broken_textures_are_refused_or_magenta_when_lenient(self):
        head = b"\x89PNG\r\n\x1a\n"
        ihdr = b"IHDR" + (64).to_bytes(4, "big") * 2 + b"\x08\x02\0\0\0"
        header = head + b"\0\0\0\r" + ihdr + zlib.crc32(ihdr).to_bytes(4, "big")
        huge = b"IHDR" + (100000).to_bytes(4, "big") * 2 + b"\x10\x06\0\0\0"
        for name, content in (
            ("empty.png", b""),
            ("text.png", b"not a picture\n" * 9),
            ("truncated.png", header + b"\0\0\x10\0IDAT\x78\x9c"),
            ("huge.png", head + b"\0\0\0\r" + huge + zlib.crc32(huge).to_bytes(4, "big") + b"\0\0\0\4IDAT\x78\x9c\3\0"),
        ):
            with self.subTest(name=name):
                self.textured(name)
                self.write(name, content)
                self.refuse("scene.toml", name)
                self.assertIn(name, self.check_magenta("--lenient").err)
                (self.folder / "out.exr").unlink()

    def test_asset_outside_the_scenes_folders_needs_permission(self):
        self.write("outside.mtl", "newmtl grey\nKd 1 1 1\nnewmtl red\nKd 1 0 0\n")
        self.write("in/model.obj", TRIANGLES_OBJ.replace("triangles.mtl", "../outside.mtl"))
        refused = self.render_run("in/model.obj")
        self.assertIn("outside.mtl", refused.err)
        self.assertIn("--allow-external-assets", refused.err)
        allowed = self.render_run("in/model.obj", "--allow-external-assets")
        self.assertEqual(allowed.code, 0, allowed)
        self.assertNotIn("outside.mtl", allowed.err)

    def test_absolute_and_linked_assets_are_outside_too(self):
        self.write_scene(SCENE_TOML.replace("triangles.obj", "/etc/passwd"))
        self.refuse("scene.toml", "--allow-external-assets")
        self.write("elsewhere/real.obj", GOOD)
        (self.folder / "in").mkdir()
        (self.folder / "in" / "link.obj").symlink_to("../elsewhere/real.obj")
        self.write("in/scene.toml", SCENE_TOML.replace("triangles.obj", "link.obj"))
        self.refuse("in/scene.toml", "--allow-external-assets")


if __name__ == "__main__":
    unittest.main()
