"""Output is whole or not there: failed writes, kill -9, and stopping by a signal."""

import resource
import signal
import subprocess
import time
import unittest

from exr import Exr
from support import OUTPUT, PARTIAL, SLOWDOWN, TesseraTest, command


class FailedWrite(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_missing_folder(self):
        run = self.expect(OUTPUT, "render", "scene.toml", "-o", "nowhere/out.exr")
        self.assertIn("nowhere", run.err)

    def test_missing_folder_is_found_before_the_render(self):
        run = self.expect(OUTPUT, "render", "scene.toml", "-o", "nowhere/out.exr", "--spp", "1000000")
        self.assertLess(run.seconds, 10 * SLOWDOWN)

    def test_target_is_a_folder(self):
        (self.folder / "out.exr").mkdir()
        self.expect(OUTPUT, "render", "scene.toml", "-o", "out.exr")
        self.assertEqual(list((self.folder / "out.exr").iterdir()), [])

    def test_parent_is_a_file(self):
        self.write("plain", "text")
        self.expect(OUTPUT, "render", "scene.toml", "-o", "plain/out.exr")

    def test_full_disk_keeps_the_old_file_and_leaves_no_other(self):
        old = self.write("out.exr", "old")
        before = self.files()

        def limit():
            # SIGXFSZ stays ignored (restore_signals=False), so that a write fails as on a full disk.
            resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))

        args = ("render", "scene.toml", "-o", "out.exr", "--res", "128x96", "--spp", "1", "--float")
        self.expect(OUTPUT, *args, preexec_fn=limit, restore_signals=False)
        self.assertEqual(old.read_bytes(), b"old")
        self.assertEqual(self.files(), before)

    def test_failing_preview_or_statistics_is_an_output_error(self):
        self.expect(OUTPUT, "render", "scene.toml", "-o", "out.exr", "--preview", "nowhere/out.png")
        self.expect(OUTPUT, "render", "scene.toml", "-o", "out.exr", "--stats", "nowhere/stats.json")

    def test_existing_file_is_replaced_and_nothing_is_left_beside_it(self):
        self.write("out.exr", "old")
        before = self.files()
        self.render()
        self.assertEqual(self.files(), before)


class Killed(TesseraTest):
    def test_kill_9_at_any_moment_leaves_the_old_or_the_new_file(self):
        self.write_scene()
        # Few samples of many pixels: most of the time is the writing.
        args = ("render", "scene.toml", "-o", "out.exr", "--res", "320x240", "--spp", "1", "--float", "-q")
        whole = self.expect(0, *args)
        old = (self.folder / "out.exr").read_bytes()
        moments = 8
        for moment in range(moments):
            process = subprocess.Popen(command(*args), cwd=self.folder, stderr=subprocess.DEVNULL)
            time.sleep(whole.seconds * (0.3 + 0.75 * moment / moments))
            process.kill()
            process.wait()
            data = (self.folder / "out.exr").read_bytes()
            if data != old:
                # A new file: it must read to its last block and have the old one's pixels.
                self.assertEqual(len(Exr(self.folder / "out.exr").pixels()["R"]), 320 * 240 * 4)
                old = data
        for path in self.folder.glob("*.exr"):
            self.assertEqual(path.name, "out.exr", "left-overs do not look like pictures")


class Stopped(TesseraTest):
    def stop(self, number, *args):
        """Starts a render of about a minute, sends the signal once it is under way, gives code, stderr, seconds."""
        self.write_scene()
        size = ("--res", "512x512", "--spp", "256", "--tile", "16")
        args = ("render", "scene.toml", "-o", "out.exr", *size, *args)
        log = self.folder / "log"
        with open(log, "wb") as err:
            process = subprocess.Popen(command(*args), cwd=self.folder, stdin=subprocess.DEVNULL, stderr=err)
        try:
            deadline = time.monotonic() + 2 * SLOWDOWN
            while "%" not in log.read_text() and time.monotonic() < deadline:
                self.assertIsNone(process.poll(), f"ended by itself:\n{log.read_text()}")
                time.sleep(0.05)
            time.sleep(0.3)
            sent = time.monotonic()
            process.send_signal(number)
            code = process.wait(timeout=15 * SLOWDOWN)
            return code, log.read_text(), time.monotonic() - sent
        finally:
            process.kill()
            process.wait()

    def check_partial(self, number):
        code, err, seconds = self.stop(number)
        self.assertEqual(code, PARTIAL, err)
        self.assertLess(seconds, 6 * SLOWDOWN, "it stops at the next tile")
        exr = Exr(self.folder / "out.exr")
        self.assertEqual(exr.size, (512, 512))
        marks = [name for name in exr.attributes if "partial" in name.lower()]
        self.assertEqual(len(marks), 1, sorted(exr.attributes))
        self.assertNotIn(str(exr.text(marks[0])), ("0", "", "false"))
        self.assertIn("partial", err)
        self.assertEqual([n for n in self.files() if n.startswith(".")], [], "no temporary file stays")

    def test_sigterm_writes_what_there_is_marked_partial(self):
        self.check_partial(signal.SIGTERM)

    def test_ctrl_c_does_the_same(self):
        self.check_partial(signal.SIGINT)


if __name__ == "__main__":
    unittest.main()
