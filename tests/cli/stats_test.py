"""--stats: the file is JSON, fits its schema, and its numbers agree with the scene."""

import json
import re
import unittest

from support import SCENE_TOML, SOURCE, TesseraTest

try:
    import jsonschema
except ImportError:
    jsonschema = None

SUBDIVIDED = SCENE_TOML.replace(
    'file = "triangles.obj"',
    'file = "triangles.obj"\n    subdivision = "linear"\n    subdivision_rate = 4\n    material = "raised"',
) + """[material.raised]
    displacement = 1.5
    """
SCHEMA = SOURCE / "docs" / "stats.schema.json"


class Stats(TesseraTest):
    def statistics(self, *args, toml=SCENE_TOML):
        self.write_scene(toml)
        self.expect(0, "render", "scene.toml", "-o", "out.exr", "--stats", "stats.json", *args)
        return json.loads((self.folder / "stats.json").read_text(), parse_constant=self.fail)

    @unittest.skipUnless(jsonschema, "python3-jsonschema is not installed")
    def test_fits_the_schema(self):
        schema = json.loads(SCHEMA.read_text())
        jsonschema.validators.validator_for(schema).check_schema(schema)
        # A schema that requires nothing would accept anything.
        self.assertTrue(schema.get("required"))
        jsonschema.validate(self.statistics(), schema)
        info = json.loads(self.expect(0, "info", "scene.toml", "--json").out, parse_constant=self.fail)
        jsonschema.validate(info, schema)
        for broken in ({}, {**info, "spp": -1}, {**info, "sp": 1}, {k: v for k, v in info.items() if k != "rays"}):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate(broken, schema)

    @unittest.skipUnless(jsonschema, "python3-jsonschema is not installed")
    def test_a_subdivided_mesh_fits_the_schema_and_is_described(self):
        tree = self.statistics(toml=SUBDIVIDED)
        jsonschema.validate(tree, json.loads(SCHEMA.read_text()))
        (mesh,) = tree["subdivision"]
        self.assertEqual(mesh["mesh"], "triangles")
        self.assertEqual(mesh["cage_faces"], 3)
        # Three patches of 2 x 2 quads for each of three triangles.
        self.assertEqual(mesh["triangles"], 3 * 3 * 2 * 2 * 2)
        self.assertEqual(tree["geometry"]["triangles_stored"], mesh["triangles"] + 2)  # the light's
        self.assertGreater(mesh["bounds_after"][1][1], mesh["bounds_before"][1][1])
        text = self.expect(0, "info", "scene.toml").out
        self.assertIn("subdivided mesh 'triangles': 3 faces to 72 triangles", text)

    def test_has_what_a_farm_looks_for(self):
        text = json.dumps(self.statistics("--spp", "3", "-t", "1")).lower()
        for word in (
            "version scene threads tile spp load build render write camera bounce shadow triangles instance "
            "geometry bvh texture film invalid left_out"
        ).split():
            self.assertIn(word, text)

    def test_camera_rays_are_pixels_times_samples(self):
        def camera_rays(tree):
            for key, value in tree.items():
                if key.startswith("camera") and isinstance(value, int):
                    yield value
                elif isinstance(value, dict):
                    yield from camera_rays(value)

        plain = self.statistics("--spp", "3", "--no-error-estimate")
        self.assertIn(48 * 32 * 3, list(camera_rays(plain)))
        # One pixel in 32 is rendered again, to tell the error.
        self.assertIn(48 * 32 * 3 * 33 // 32, list(camera_rays(self.statistics("--spp", "3"))))

    def test_counts_do_not_depend_on_threads(self):
        def counts(tree, path=""):
            if isinstance(tree, dict):
                for key, value in tree.items():
                    yield from counts(value, f"{path}/{key}")
            elif isinstance(tree, int) and any(word in path for word in ("camera", "bounce", "shadow", "triangles")):
                yield path, tree

        one, two = dict(counts(self.statistics("-t", "1"))), dict(counts(self.statistics("-t", "2")))
        self.assertTrue(one)
        self.assertEqual(
            {path: n for path, n in one.items() if "per_s" not in path},
            {path: n for path, n in two.items() if "per_s" not in path},
        )

    def test_a_failed_scene_writes_no_statistics(self):
        self.write("bad.toml", "tessera = 1\n[camera\n")
        self.expect(3, "render", "bad.toml", "-o", "out.exr", "--stats", "stats.json")
        self.assertEqual(self.files(), ["bad.toml"])


class FilmMemory(TesseraTest):
    """What docs/performance.md states of many passes at once; one sample is enough, films do not grow by more."""

    def test_forty_passes_at_1280x720_take_what_is_stated_and_foretold(self):
        passes = [word for name in ("compositing", "lookdev", "light_groups", "variance") for word in ("--aov", name)]
        run = self.expect(
            0, "render", SOURCE / "scenes" / "compositing" / "compositing.toml", "-o", "out.exr", "--res", "1280x720",
            "--spp", "1", "--compression", "none", "--stats", "s.json", *passes, timeout=120,
        )  # fmt: skip
        memory = json.loads((self.folder / "s.json").read_text())["memory_bytes"]
        count, mib = re.search(r"^film +1280x720, beauty four times and (\d+) passes, ([0-9.]+) MiB$", run.err, re.MULTILINE).groups()
        self.assertGreaterEqual(int(count), 40)
        # Edges between things are not foreseen; a log line has one digit after the point.
        self.assertLessEqual(float(mib), memory["film"] / 2**20 + 0.1)
        self.assertGreaterEqual(float(mib), 0.99 * memory["film"] / 2**20)
        stated = re.search(r"Fifty layers at once at 1280×720.*?film ([0-9.]+) GB, process ([0-9.]+) GB",
                           (SOURCE / "docs" / "performance.md").read_text(), re.DOTALL)  # fmt: skip
        self.assertLessEqual(memory["film"], 1.01e9 * float(stated[1]))
        self.assertLessEqual(memory["peak"], 1.1e9 * float(stated[2]))


if __name__ == "__main__":
    unittest.main()
