"""The picture is a function of scene, settings and seed: threads, tiles, crop and kernel do not show."""

import unittest

from exr import Exr
from support import TesseraTest


class SameBits(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()
        # Two samples on a frame that no tile size divides.
        self.common = ("--res", "75x53", "--spp", "2", "--float")
        self.full = self.render(*self.common, "-t", "1", output="full.exr")

    def compare(self, *args):
        self.assert_same_bits(self.full, self.render(*self.common, *args), " ".join(args))

    def test_twice_in_a_row(self):
        self.compare("-t", "1")

    def test_threads(self):
        for threads in ("2", "3"):
            self.compare("-t", threads)

    def test_tile_sizes(self):
        for tile in ("16", "64"):
            self.compare("--tile", tile)

    def test_crop_gives_the_pixels_of_the_full_frame(self):
        # Aligned to the 4x4 blocks, not aligned, and one pixel.
        for window in ((8, 12, 40, 44), (13, 7, 38, 52), (74, 52, 75, 53)):
            text = ",".join(map(str, window))
            crop = self.render(*self.common, "--crop", text)
            self.assertEqual(crop.display_window, (0, 0, 74, 52))
            self.assertEqual(crop.data_window, (window[0], window[1], window[2] - 1, window[3] - 1))
            self.assert_same_pixels(self.full.pixels(window), crop.pixels(), f"crop {text}")


class Kernels(TesseraTest):
    def test_every_kernel_that_covers_a_scene_gives_the_same_bits(self):
        self.write_scene()
        chosen = self.render("--float", output="chosen.exr")
        for kernel in ("basic", "surface", "full"):
            run = self.run_program("render", "scene.toml", "-o", "k.exr", "--float", "--kernel", kernel)
            if run.code == 0:
                self.assert_same_bits(chosen, Exr(self.folder / "k.exr"), kernel)
            else:
                # Only a kernel that is too small may be refused, and it says so.
                self.assertNotEqual(kernel, "full", run)
                self.assertEqual(run.code, 2, run)
                self.assertIn(kernel, run.err)

    def test_glass_gives_the_same_bits_in_the_chosen_and_the_full_kernel(self):
        self.write_scene()
        self.write("triangles.mtl", "newmtl grey\nKd 0.6 0.6 0.6\nnewmtl red\nKd 0 0 0\nd 0.2\nillum 7\nNi 1.5\n")
        chosen = self.render("--float", output="chosen.exr")
        self.assert_same_bits(chosen, self.render("--float", "--kernel", "full"))


if __name__ == "__main__":
    unittest.main()
