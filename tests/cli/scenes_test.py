"""The scenes that come with Tessera render without a warning, and their scripts write the files that lie beside them."""

import re
import subprocess
import sys
import unittest

from support import SOURCE, TesseraTest

SCENES = SOURCE / "scenes"


class Scenes(TesseraTest):
    def test_every_scene_renders_without_a_warning(self):
        # spheres.toml has what the two scenes beside it share, and no lamp.
        scenes = sorted(path for path in SCENES.glob("*/*.toml") if path.name != "spheres.toml")
        self.assertGreaterEqual(len(scenes), 7)
        for scene in scenes:
            with self.subTest(scene.name):
                run = self.expect(0, "render", scene, "-o", "out.exr", "--res", "64x36", "--spp", "1", "--strict")
                self.assertNotRegex(run.out + run.err, re.compile("warning|non-finite", re.IGNORECASE))

    def test_every_scene_has_its_picture(self):
        for folder in (path for path in SCENES.iterdir() if path.is_dir()):
            with self.subTest(folder.name):
                self.assertTrue((folder / f"{folder.name}.toml").is_file())
                self.assertLess((folder / f"{folder.name}.png").stat().st_size, 300_000)

    def test_scripts_write_the_files_that_are_there(self):
        scripts = sorted(SCENES.glob("*/generate.py"))
        self.assertGreaterEqual(len(scripts), 4)
        for script in scripts:
            with self.subTest(script.parent.name):
                folder = self.folder / script.parent.name
                folder.mkdir()
                subprocess.run([sys.executable, script, folder], check=True, timeout=60, capture_output=True)
                made = sorted(folder.iterdir())
                self.assertTrue(made)
                for file in made:
                    self.assertEqual(file.read_bytes(), (script.parent / file.name).read_bytes(), file.name)

    def test_the_car_comes_in_the_size_asked_for(self):
        script = SCENES / "traffic_jam/generate.py"
        done = subprocess.run(
            [sys.executable, script, self.folder, "--triangles", "100000", "--rows", "2"],
            check=True, timeout=120, capture_output=True, text=True,
        )
        triangles, cars = map(int, re.match(r"car: (\d+) triangles; (\d+) cars", done.stdout).groups())
        self.assertAlmostEqual(triangles, 100_000, delta=5_000)
        self.assertEqual(cars, 16)


if __name__ == "__main__":
    unittest.main()
