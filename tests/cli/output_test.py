"""Output is whole or not there: failed writes, kill -9, and stopping by a signal."""

import json
import os
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


class Targets(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def test_link_stays_and_what_it_leads_to_is_replaced(self):
        self.write("shelf/real.exr", "old")
        (self.folder / "link.exr").symlink_to("shelf/real.exr")
        self.render(output="link.exr")
        self.assertTrue((self.folder / "link.exr").is_symlink())
        self.assertEqual(Exr(self.folder / "shelf" / "real.exr").size, (48, 32))

    def test_pipe_and_device_are_refused_before_the_render(self):
        os.mkfifo(self.folder / "pipe.exr")
        (self.folder / "full.exr").symlink_to("/dev/full")
        for name in ("pipe.exr", "full.exr"):
            run = self.expect(OUTPUT, "render", "scene.toml", "-o", name, "--spp", "1000000")
            self.assertIn(name, run.err)

    def test_longest_name_the_file_system_takes(self):
        self.render(output="x" * 251 + ".exr")
        self.expect(OUTPUT, "render", "scene.toml", "-o", "x" * 252 + ".exr")

    def test_two_renders_to_one_file_leave_a_whole_one(self):
        args = ("render", "scene.toml", "-o", "out.exr", "--res", "128x96", "-q")
        both = [subprocess.Popen(command(*args), cwd=self.folder) for _ in range(2)]
        self.assertEqual([p.wait(timeout=20 * SLOWDOWN) for p in both], [0, 0])
        self.assertEqual(Exr(self.folder / "out.exr").size, (128, 96))
        self.assertEqual([n for n in self.files() if "tmp" in n], [])


class Streams(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def shell(self, line):
        args = ["bash", "-c", f'exec "$0" {line}', *command()]
        streams = {"stdin": subprocess.DEVNULL, "capture_output": True}
        return subprocess.run(args, cwd=self.folder, timeout=20 * SLOWDOWN, **streams).returncode

    def test_closed_streams_never_get_into_the_picture(self):
        for closed in (">&-", "2>&-", "<&-", "<&- >&- 2>&-"):
            with self.subTest(closed=closed):
                self.assertEqual(self.shell(f"render scene.toml -o out.exr -v {closed}"), 0)
                self.assertEqual(Exr(self.folder / "out.exr").size, (48, 32))
                (self.folder / "out.exr").unlink()

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_full_disk_behind_stderr_does_not_stop_a_render(self):
        self.assertEqual(self.shell("render scene.toml -o out.exr -v 2>/dev/full"), 0)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_result_that_cannot_be_printed_is_an_output_error(self):
        for words in ("version", "info scene.toml", "render scene.toml -o out.exr --stats -"):
            self.assertEqual(self.shell(f"{words} >/dev/full 2>/dev/null"), OUTPUT, words)

    def test_statistics_on_standard_output(self):
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--stats", "-")
        self.assertEqual(json.loads(run.out)["spp"], 4)

    def test_small_stack_is_enough(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_STACK, (1 << 20, 1 << 20))

        self.expect(0, "render", "scene.toml", "-o", "out.exr", preexec_fn=limit)


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

    def test_signal_while_loading_saves_nothing(self):
        rows = 300
        vertices = "".join(f"v {x} {y} 0\n" for y in range(rows) for x in range(rows))
        corners = (y * rows + x + 1 for y in range(rows - 1) for x in range(rows - 1))
        self.write("big.obj", vertices + "".join(f"f {a} {a + 1} {a + rows + 1} {a + rows}\n" for a in corners))
        args = command("render", "big.obj", "-o", "out.exr", "--spp", "1000")
        process = subprocess.Popen(args, cwd=self.folder, stderr=subprocess.PIPE)
        time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        err = process.communicate(timeout=10 * SLOWDOWN)[1].decode()
        # Before the program's own first line the system ends it: the same to a shell.
        self.assertIn(process.returncode, (143, -signal.SIGTERM), err)
        self.assertFalse((self.folder / "out.exr").exists())


if __name__ == "__main__":
    unittest.main()
