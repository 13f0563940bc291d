"""tessera info: says what is in a scene without rendering it."""

import json
import unittest

from support import SCENE, SCENE_TOML, TesseraTest

# The mesh has three, and the quad light is traced as two.
TRIANGLES = 5


def numbers_named(tree, word, found=None):
    """Every number whose key contains the word, anywhere in the tree."""
    found = [] if found is None else found
    if isinstance(tree, dict):
        for key, value in tree.items():
            if word in key and isinstance(value, (int, float)):
                found.append(value)
            numbers_named(value, word, found)
    elif isinstance(tree, list):
        for value in tree:
            numbers_named(value, word, found)
    return found


class Info(TesseraTest):
    def test_counts_what_is_there_and_writes_no_file(self):
        self.write_scene()
        before = self.files()
        run = self.expect(0, "info", "scene.toml")
        self.assertRegex(run.out, rf"\b{TRIANGLES} triangles")
        self.assertRegex(run.out, r"48\s*x\s*32")
        self.assertEqual(self.files(), before)

    def test_json_counts_the_same(self):
        self.write_scene()
        tree = json.loads(self.expect(0, "info", "scene.toml", "--json").out)
        self.assertIn(TRIANGLES, numbers_named(tree, "triangles"))

    def test_instances_are_counted_apart_from_what_is_stored(self):
        self.write_scene(SCENE_TOML + '[[instance]]\nof = "triangles"\ntranslate = [2, 0, 0]\n')
        tree = json.loads(self.expect(0, "info", "scene.toml", "--json").out)
        triangles = numbers_named(tree, "triangles")
        self.assertIn(TRIANGLES, triangles)
        self.assertIn(TRIANGLES + 3, triangles)

    def test_lists_what_was_left_out(self):
        self.write_scene()
        self.assertRegex(self.expect(0, "info", "scene.toml").out.lower(), r"left[ _]out")
        self.assertIn("left_out", self.expect(0, "info", "scene.toml", "--json").out)

    def test_bare_obj(self):
        self.write_scene()
        self.assertIn("triangles", self.expect(0, "info", "triangles.obj").out)

    def test_broken_scene_is_a_scene_error(self):
        self.write("bad.toml", "tessera = 1\n[camera\n")
        self.assertIn("bad.toml:2", self.expect(SCENE, "info", "bad.toml").err)
        self.expect(SCENE, "info", "nowhere.toml")


if __name__ == "__main__":
    unittest.main()
