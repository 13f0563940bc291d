"""SIGUSR1: the picture so far in the output's place, and the render goes on."""

import pathlib
import signal
import subprocess
import time
import unittest

from exr import Exr
from support import PARTIAL, SLOWDOWN, TesseraTest, command

TIMEOUT = 60 * SLOWDOWN
ENDLESS = ("--time", "60")


class Snapshot(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def start(self, *args, output="out.exr"):
        """A render that has begun."""
        process = subprocess.Popen(
            command("render", "scene.toml", "-o", output, "-v", *args), cwd=self.folder, stderr=subprocess.PIPE, text=True
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        for line in process.stderr:
            if line.startswith("progress"):
                return process
        self.fail("it ended before it began")

    def wait_for_line(self, process, word):
        for line in process.stderr:
            if word in line:
                return line
        self.fail(f"no line with '{word}'")

    def stop(self, process):
        process.send_signal(signal.SIGTERM)
        process.stderr.read()
        self.assertEqual(process.wait(TIMEOUT), PARTIAL)

    def test_a_whole_file_appears_while_the_render_goes_on(self):
        process = self.start(*ENDLESS, "--preview", "out.png")
        self.assertFalse((self.folder / "out.exr").exists())
        for _ in range(2):
            process.send_signal(signal.SIGUSR1)
            self.wait_for_line(process, "snapshot written")
            exr = Exr(self.folder / "out.exr")
            self.assertEqual(exr.text("tessera/partial"), 1)
            self.assertGreater(max(exr.values("G")), 0.01)
            self.assertTrue((self.folder / "out.png").exists())
            (self.folder / "out.exr").unlink()
        self.assertIsNone(process.poll())
        self.stop(process)
        self.assertEqual([n for n in self.files() if "tmp" in n], [])

    def test_the_final_picture_has_the_bits_of_an_undisturbed_render(self):
        args = ("--spp", "200", "--res", "160x120", "--tile", "8")
        undisturbed = self.render(*args, output="undisturbed.exr")
        process = self.start(*args)
        signals = 0
        while process.poll() is None and signals < 200:
            process.send_signal(signal.SIGUSR1)
            signals += 1
            time.sleep(0.05)
        log = process.stderr.read()
        self.assertEqual(process.wait(TIMEOUT), 0)
        self.assertIn("snapshot written", log)
        final = Exr(self.folder / "out.exr")
        self.assertNotIn("tessera/partial", final.attributes)
        self.assert_same_bits(undisturbed, final)

    def test_of_a_part_it_is_a_part(self):
        for checkpoint in ((), ("--checkpoint", "a.tsf")):
            process = self.start(*ENDLESS, *checkpoint, output="a.tsf")
            process.send_signal(signal.SIGUSR1)
            self.wait_for_line(process, "snapshot written")
            deadline = time.monotonic() + TIMEOUT
            while not (self.folder / "a.tsf").exists():  # a checkpoint is written by the way
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            self.assertIsNone(process.poll())
            process.kill()
            process.wait()
            self.expect(0, "merge", "a.tsf", "-o", "so_far.exr", "--allow-partial")
            self.assertGreater(max(Exr(self.folder / "so_far.exr").values("G")), 0.01)
            (self.folder / "a.tsf").unlink()

    def test_one_that_cannot_be_written_is_a_warning(self):
        (self.folder / "shelf").mkdir()
        process = self.start(*ENDLESS, output="shelf/out.exr")
        (self.folder / "shelf").rename(self.folder / "away")
        process.send_signal(signal.SIGUSR1)
        self.assertRegex(self.wait_for_line(process, "snapshot"), "^warning: snapshot: shelf/out.exr")
        (self.folder / "away").rename(self.folder / "shelf")
        self.stop(process)
        self.assertEqual(Exr(self.folder / "shelf" / "out.exr").size, (48, 32))

    def test_one_before_the_render_does_not_end_the_program(self):
        process = subprocess.Popen(command("render", "scene.toml", "-o", "out.exr", "-q"), cwd=self.folder)
        # As soon as there is a handler; before, the signal would end any program.
        while process.poll() is None:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            caught = [line.split()[1] for line in status.splitlines() if line.startswith("SigCgt")]
            if caught and int(caught[0], 16) >> (signal.SIGUSR1 - 1) & 1:
                process.send_signal(signal.SIGUSR1)
                break
        self.assertEqual(process.wait(TIMEOUT), 0)
        self.assertNotIn("tessera/partial", Exr(self.folder / "out.exr").attributes)


if __name__ == "__main__":
    unittest.main()
