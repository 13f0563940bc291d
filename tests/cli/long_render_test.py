"""Renders in more than one run: killed, stopped, cut up, merged, on a full disk; always the bits of one run."""

import json
import os
import random
import resource
import signal
import subprocess
import textwrap
import time
import unittest

from exr import Exr
from support import OUTPUT, PARTIAL, SCENE, SLOWDOWN, TRIANGLES_OBJ, USAGE, TesseraTest, command

# Every kind of pass but the seconds, which are never the same.
PASSES = [
    word
    for name in ("compositing", "lookdev", "cryptomatte", "P", "Pref", "uv", "N", "object_id", "variance", "shadow_matte")
    + ("sample_count", "ao", "lamp = C<RD>L")
    for word in ("--aov", name)
]


class LongRender(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def render_args(self, output, *args):
        return ("render", "scene.toml", "-o", output, "--float", *args)

    def killed_after(self, seconds, number, *args):
        """Runs, sends a signal after so many seconds, gives the exit code."""
        process = subprocess.Popen(command(*args), cwd=self.folder, stderr=subprocess.DEVNULL)
        try:
            return process.wait(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(number)
            return process.wait(timeout=20 * SLOWDOWN)

    def begin(self, *args, checkpoint="c.tsf"):
        """A render that has written a checkpoint."""
        process = subprocess.Popen(command(*args), cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 20 * SLOWDOWN
        while not (self.folder / checkpoint).exists():
            self.assertIsNone(process.poll(), "it ended before a checkpoint")
            self.assertLess(time.monotonic(), deadline, "no checkpoint")
            time.sleep(0.01)
        return process


class Killed(LongRender):
    def test_twenty_kills_at_random_moments_leave_the_bits_of_one_run(self):
        args = ("--res", "64x48", "--spp", "300", "-q", *PASSES)
        self.expect(0, *self.render_args("whole.exr", *args), timeout=60)
        whole = Exr(self.folder / "whole.exr")
        again = ("--checkpoint", "c.tsf", "--checkpoint-every", "0.05", "--resume", "c.tsf")
        moments = random.Random(4)
        kills, done = 0, False
        while kills < 20 or not done:  # the last one killed is resumed too
            # Other threads and tiles every time.
            how = ("-t", str(1 + kills % 3), "--tile", str(8 << kills % 3))
            seconds = (moments.uniform(0.05, 0.6) if kills < 20 else 60) * SLOWDOWN
            code = self.killed_after(seconds, signal.SIGKILL, *self.render_args("out.exr", *args, *again, *how))
            if code == -signal.SIGKILL:
                kills, done = kills + 1, False
                continue
            self.assertEqual(code, 0)
            self.assert_same_bits(whole, Exr(self.folder / "out.exr"), f"after {kills} kills")
            done = True
            (self.folder / "out.exr").unlink()
            (self.folder / "c.tsf").unlink()
        self.assertEqual([n for n in self.files() if "tmp" in n], [])


class Stopped(LongRender):
    SIZE = ("--res", "96x64", "--aov", "compositing", "--aov", "cryptomatte")

    def test_sigterm_saves_picture_and_checkpoint_and_the_rest_follows(self):
        spp = ("--spp", "2000", *self.SIZE)
        args = (*spp, "--checkpoint", "c.tsf", "--checkpoint-every", "0.2")
        process = self.begin(*self.render_args("out.exr", *args))
        process.send_signal(signal.SIGTERM)
        err = process.stderr.read()
        self.assertEqual(process.wait(timeout=20 * SLOWDOWN), PARTIAL, err)
        self.assertIn("--resume c.tsf", err)
        self.assertEqual(Exr(self.folder / "out.exr").text("tessera/partial"), 1)
        more = self.expect(
            0, *self.render_args("out.exr", *args, "--resume", "c.tsf", "--stats", "s.json"), timeout=60
        )
        self.assertIn("of them before", more.err)
        self.expect(0, *self.render_args("whole.exr", *spp), timeout=60)
        self.assert_same_bits(Exr(self.folder / "whole.exr"), Exr(self.folder / "out.exr"))
        self.assertNotIn("tessera/partial", Exr(self.folder / "out.exr").attributes)
        stats = json.loads((self.folder / "s.json").read_text())
        self.assertGreater(stats["resumed"]["seconds"], 0)
        self.assertLess(stats["resumed"]["spp"], 2000)
        self.assertGreaterEqual(stats["checkpoints"]["written"], 1)

    def test_a_finished_checkpoint_gives_the_picture_and_takes_more_samples(self):
        args = (*self.SIZE, "--checkpoint", "c.tsf")
        self.expect(0, *self.render_args("out.exr", "--spp", "3", *args))
        (self.folder / "out.exr").unlink()
        run = self.expect(0, *self.render_args("out.exr", "--spp", "3", *args, "--resume", "c.tsf", "--stats", "-"))
        self.assertEqual(json.loads(run.out)["samples"], 0)
        self.assertEqual(json.loads(run.out)["resumed"]["spp"], 3)
        self.assertTrue((self.folder / "out.exr").exists())
        self.expect(0, *self.render_args("out.exr", "--spp", "11", *self.SIZE, "--resume", "c.tsf"))
        self.expect(0, *self.render_args("whole.exr", "--spp", "11", *self.SIZE))
        self.assert_same_bits(Exr(self.folder / "whole.exr"), Exr(self.folder / "out.exr"))
        run = self.expect(USAGE, *self.render_args("out.exr", "--spp", "2", *args, "--resume", "c.tsf"))
        self.assertIn("is 3, this render's is 2", run.err)

    def test_time_counts_from_the_start_of_a_run(self):
        self.expect(0, *self.render_args("out.exr", "--time", "0.5", "--checkpoint", "c.tsf"))
        run = self.expect(
            0, *self.render_args("out.exr", "--time", "0.5", "--resume", "c.tsf", "--stats", "-"), timeout=30
        )
        stats = json.loads(run.out)
        self.assertGreater(stats["samples"], 0)
        self.assertGreater(stats["spp"], stats["resumed"]["spp"])
        self.assertAlmostEqual(
            Exr(self.folder / "out.exr").text("tessera/seconds"),
            stats["resumed"]["seconds"] + stats["seconds"]["render"],
            places=3,
        )


class Refused(LongRender):
    def setUp(self):
        super().setUp()
        self.expect(0, *self.render_args("c.tsf", "--aov", "Z", "--aov", "CryptoObject"))

    def refuse(self, code, *args, text):
        run = self.expect(code, *self.render_args("out.exr", *args))
        for part in text if isinstance(text, tuple) else (text,):
            self.assertIn(part, run.err)
        self.assertFalse((self.folder / "out.exr").exists())

    def test_a_checkpoint_of_something_else(self):
        aov = ("--aov", "Z", "--aov", "CryptoObject", "--resume", "c.tsf")
        self.refuse(SCENE, *aov, "--seed", "7", text=("c.tsf", "seed is 0", "is 7"))
        self.refuse(SCENE, *aov, "--res", "64x32", text=("resolution is 48x32", "is 64x32"))
        self.refuse(SCENE, *aov, "--crop", "0,0,8,8", text=("window", "0,0,48,32", "0,0,8,8"))
        self.refuse(SCENE, *aov, "--isa", "sse2", text=("instruction set", "is sse2"))
        self.refuse(SCENE, *aov, "--set", "render.max_depth=3", text="hash of the scene")
        self.refuse(SCENE, *aov, "--aov", "N", text=("pass 3", "none", "'N'"))
        self.refuse(USAGE, *aov, "--samples", "2:9", text=("first sample", "is 0", "is 2"))
        self.write("triangles.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl red\nKd 0.7 0.1 0.1\n")
        self.refuse(SCENE, *aov, text="hash of the scene")

    def test_a_damaged_checkpoint(self):
        whole = (self.folder / "c.tsf").read_bytes()
        flipped = bytearray(whole)
        flipped[len(whole) // 2] ^= 4
        for data, text in (
            (whole[:-9], f"cut short: {len(whole) - 9} of {len(whole)} bytes"),
            (whole + b"x", "damaged"),
            (bytes(flipped), "checksum"),
            (whole[:20], "cut short"),
            (b"", "no Tessera film file"),
            (b"v 0 0 0\nf 1 1 1\n", "no Tessera film file"),
        ):
            self.write("bad.tsf", data)
            self.refuse(SCENE, "--aov", "Z", "--aov", "CryptoObject", "--resume", "bad.tsf", text=("bad.tsf", text))
        os.mkfifo(self.folder / "pipe.tsf")
        self.refuse(SCENE, "--resume", "pipe.tsf", text="not a regular file")
        self.refuse(SCENE, "--resume", "none.tsf", text="No such file")

    def test_a_checkpoint_replaces_nothing_but_a_checkpoint(self):
        self.write("notes.txt", "mine")
        self.refuse(USAGE, "--checkpoint", "notes.txt", text="notes.txt")
        self.refuse(USAGE, "--checkpoint", "triangles.obj", text="triangles.obj")
        self.refuse(USAGE, "--checkpoint", "out.exr", text="--output")
        self.assertEqual((self.folder / "notes.txt").read_bytes(), b"mine")
        run = self.expect(0, *self.render_args("out.exr", "--checkpoint", "c.tsf"))
        self.assertIn("will be replaced", run.err)

    def test_options_that_contradict(self):
        self.refuse(USAGE, "--samples", "2:9", "--spp", "9", text="--spp")
        for text in ("9:2", "2:2", "-1:2", "2", "2:", ":2", "a:b", "0:99999999"):
            self.refuse(USAGE, f"--samples={text}", text="must be A:B")
        self.refuse(USAGE, "--checkpoint-every", "5", text="--checkpoint")


class Merge(LongRender):
    PASSES = ("--res", "53x37", *PASSES)

    def part(self, name, *args):
        self.expect(0, *self.render_args(name, *self.PASSES, *args))
        return name

    def merge(self, *args, code=0):
        return self.expect(code, "merge", *args)

    def test_ranges_and_crops_in_any_order_are_the_whole(self):
        self.part("whole.exr", "--spp", "21")
        parts = [
            self.part(f"{samples.replace(':', '-')}_{i}.tsf", "--samples", samples, "--crop", crop, "-t", str(i + 1))
            for samples in ("0:5", "5:6", "6:21")
            for i, crop in enumerate(("0,0,22,37", "22,0,53,37"))
        ]
        random.Random(1).shuffle(parts)
        self.merge(*parts, "-o", "out.exr", "--float")
        whole, out = Exr(self.folder / "whole.exr"), Exr(self.folder / "out.exr")
        self.assert_same_bits(whole, out)
        for name in ("scene", "sceneHash", "spp", "seed", "embreeIsa", "version", "colorSpace"):
            self.assertEqual(whole.text("tessera/" + name), out.text("tessera/" + name), name)
        self.assertEqual({n for n in whole.attributes if n.startswith("cryptomatte")},
                         {n for n in out.attributes if n.startswith("cryptomatte")})
        self.assertEqual(out.text("tessera/parts"), 6)
        self.assertNotIn("tessera/partial", out.attributes)
        # By way of merged film files, and of one that goes on.
        ranges = [[p for p in parts if p.startswith(r)] for r in ("0-5", "5-6", "6-21")]
        self.merge(*ranges[1], *ranges[2], "-o", "late.tsf")
        self.merge("late.tsf", *ranges[0], "-o", "out.exr", "--float", "--spp", "21")
        self.assert_same_bits(whole, Exr(self.folder / "out.exr"))
        self.merge(*ranges[0], *ranges[1], "-o", "early.tsf")
        self.part("out.exr", "--spp", "21", "--resume", "early.tsf")
        self.assert_same_bits(whole, Exr(self.folder / "out.exr"))

    def test_overscan_and_the_forms_of_a_picture(self):
        args = ("--overscan", "0.1", "--res", "40x30", "--aov", "Z", "--aov", "cryptomatte")
        self.expect(0, *self.render_args("whole.exr", *args, "--spp", "6"))
        self.expect(0, *self.render_args("a.tsf", *args, "--samples", "0:2", "--tile", "8"))
        self.expect(0, *self.render_args("b.tsf", *args, "--samples", "2:6", "--tile", "64"))
        self.merge("b.tsf", "a.tsf", "-o", "out.exr", "--float", "--preview", "out.png")
        whole = Exr(self.folder / "whole.exr")
        self.assertEqual(whole.data_window, (-4, -3, 43, 32))
        self.assert_same_bits(whole, Exr(self.folder / "out.exr"))
        self.assertTrue((self.folder / "out.png").exists())
        self.merge("a.tsf", "b.tsf", "-o", "split.exr", "--exr", "split", "--crypto-manifest", "sidecar")
        self.assertIn("split.CryptoObject.json", self.files())

    def test_the_same_scene_in_another_folder_belongs_to_it(self):
        self.part("a.tsf", "--samples", "0:2")
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        for name in ("scene.toml", "triangles.obj", "triangles.mtl"):
            (self.folder / name).rename(elsewhere / name)
        self.expect(0, "render", "elsewhere/scene.toml", "-o", "b.tsf", *self.PASSES, "--samples", "2:4")
        self.merge("a.tsf", "b.tsf", "-o", "out.exr")

    def refuse(self, *args, text):
        run = self.merge(*args, "-o", "no.exr", code=SCENE)
        for part in text if isinstance(text, tuple) else (text,):
            self.assertIn(part, run.err)
        self.assertFalse((self.folder / "no.exr").exists())

    def test_of_another_scene_that_is_said_and_not_its_names(self):
        args = ("render", "scene.toml", "--aov", "CryptoObject", "-q", "--samples")
        self.expect(0, *args, "0:4", "-o", "a.tsf")
        (self.folder / "triangles.obj").write_text(textwrap.dedent(TRIANGLES_OBJ).replace("o fin", "o shark"))
        self.expect(0, *args, "4:8", "-o", "b.tsf")
        self.refuse("a.tsf", "b.tsf", text="hash of the scene")

    def test_what_does_not_belong_together(self):
        small = ("render", "scene.toml", "--aov", "Z", "-q")
        self.expect(0, *small, "--samples", "0:4", "-o", "a.tsf")
        self.expect(0, *small, "--samples", "4:8", "-o", "b.tsf", "--seed", "3")
        self.refuse("a.tsf", "b.tsf", text=("b.tsf", "a.tsf", "seed is 3, there 0"))
        self.expect(0, *small, "--samples", "4:8", "-o", "b.tsf", "--aov", "N")
        self.refuse("a.tsf", "b.tsf", text=("pass 2", "'N'", "none"))
        self.expect(0, *small, "--samples", "4:8", "-o", "b.tsf", "--res", "20x20")
        self.refuse("a.tsf", "b.tsf", text=("20x20", "48x32"))
        self.expect(0, *small, "--samples", "4:8", "-o", "b.tsf", "--set", "camera.fov_deg=41")
        self.refuse("a.tsf", "b.tsf", text="hash of the scene")
        self.expect(0, *small, "--samples", "3:8", "-o", "b.tsf")
        self.refuse("a.tsf", "b.tsf", text=("a.tsf and b.tsf both have samples 3:4", "0,0,48,32"))
        self.expect(0, *small, "--samples", "6:8", "-o", "b.tsf")
        self.refuse("a.tsf", "b.tsf", text="missing are samples 4:6 of pixels 0,0,48,32")
        self.refuse("b.tsf", text="missing are samples 0:6")
        self.expect(0, *small, "--samples", "4:8", "-o", "b.tsf", "--crop", "0,0,48,20")
        self.refuse("a.tsf", "b.tsf", text="missing are samples 4:8 of pixels 0,20,48,32")
        self.refuse("a.tsf", "--spp", "9", text="missing are samples 4:9")
        self.refuse("scene.toml", text="no Tessera film file")
        self.expect(0, *small, "-o", "c.exr")
        self.refuse("a.tsf", "c.exr", text="is a picture")
        run = self.merge("a.tsf", "b.tsf", "-o", "no.tsf", "--allow-partial", code=SCENE)
        self.assertIn("no holes", run.err)
        run = self.merge("a.tsf", "b.tsf", "-o", "some.exr", "--allow-partial")
        self.assertIn("missing are", run.err)
        self.assertEqual(Exr(self.folder / "some.exr").text("tessera/partial"), 1)

    def test_what_lacks_its_first_samples_or_its_frame_is_partial(self):
        args = ("render", "scene.toml", "--aov", "Z", "-q")
        self.expect(0, *args, "--samples", "4:8", "-o", "late.tsf")
        self.expect(0, *args, "--samples", "0:8", "--crop", "0,0,20,32", "-o", "left.tsf")
        self.expect(0, *args, "--samples", "0:8", "--crop", "20,0,40,32", "-o", "middle.tsf")
        self.expect(0, *args, "--samples", "0:8", "--crop", "40,0,48,32", "-o", "right.tsf")
        for parts, partial, window in (
            (("late.tsf",), 1, (0, 0, 47, 31)),
            (("left.tsf", "middle.tsf"), 1, (0, 0, 39, 31)),
            (("left.tsf", "middle.tsf", "right.tsf"), None, (0, 0, 47, 31)),
            (("middle.tsf",), None, (20, 0, 39, 31)),  # a crop that was asked for
        ):
            run = self.merge(*parts, "-o", "some.exr", "--allow-partial")
            exr = Exr(self.folder / "some.exr")
            self.assertEqual(exr.attributes.get("tessera/partial") and exr.text("tessera/partial"), partial, parts)
            self.assertEqual("missing are" in run.err, partial == 1, parts)
            self.assertEqual(exr.data_window, window)

    def test_an_unfinished_part_is_named(self):
        args = ("--res", "96x64", "--samples", "0:4000")
        process = self.begin(*self.render_args("a.tsf", *args, "--checkpoint", "a.tsf", "--checkpoint-every", "0.2"),
                             checkpoint="a.tsf")
        process.send_signal(signal.SIGTERM)
        process.stderr.read()
        self.assertEqual(process.wait(timeout=20 * SLOWDOWN), PARTIAL)
        # Unless it was stopped between two passes.
        run = self.run_program("merge", "a.tsf", "-o", "no.exr")
        if run.code != 0:
            self.assertEqual(run.code, SCENE, run)
            self.assertIn("a.tsf: is unfinished", run.err)
        self.merge("a.tsf", "-o", "some.exr", "--allow-partial")


class FullDisk(LongRender):
    ARGS = ("--spp", "1200", "--res", "64x64", "--aov", "Z", "--checkpoint-every", "0.1")

    def check(self, err, checkpoint):
        self.assertIn("cannot write", err)
        self.assertIn("the render goes on", err)
        self.expect(0, *self.render_args("whole.exr", *self.ARGS[:6]), timeout=60)
        whole = Exr(self.folder / "whole.exr")
        self.assert_same_bits(whole, Exr(self.folder / "out.exr"))
        run = self.expect(
            0, *self.render_args("out.exr", *self.ARGS[:6], "--resume", checkpoint, "--stats", "-"), timeout=60
        )
        self.assert_same_bits(whole, Exr(self.folder / "out.exr"))
        self.assertGreater(json.loads(run.out)["samples"], 0)

    def test_a_file_that_cannot_grow_is_a_warning_and_the_last_one_stays(self):
        self.expect(0, *self.render_args("out.exr", "--checkpoint", "c.tsf", *self.ARGS, "--spp", "5"))

        def limit():
            # SIGXFSZ stays ignored (restore_signals=False), so that a write fails as on a full disk.
            resource.setrlimit(resource.RLIMIT_FSIZE, (200000, 200000))

        args = ("--checkpoint", "c.tsf", "--resume", "c.tsf", *self.ARGS)
        run = self.expect(
            0, *self.render_args("out.exr", *args), timeout=60, preexec_fn=limit, restore_signals=False
        )
        self.check(run.err, "c.tsf")

    def test_a_part_that_is_its_own_checkpoint_ends_whole_while_one_is_written(self):
        args = ("--res", "500x500", "--spp", "3", "-q", "--checkpoint-every")
        for number in range(8):
            self.expect(
                0, "render", "scene.toml", "-o", "p.tsf", "--checkpoint", "p.tsf", *args, f"{0.01 + 0.01 * number}"
            )
            self.expect(0, "merge", "p.tsf", "--spp", "3", "-o", "out.exr", "-q")
            (self.folder / "p.tsf").unlink()

    @unittest.skipUnless(hasattr(os, "geteuid") and os.geteuid() == 0, "only root mounts a small disk")
    def test_a_disk_with_room_for_one_keeps_it(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1300k", "tmpfs", disk], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest(f"no mount here: {mounted.stderr.decode().strip()}")
        try:
            run = self.expect(0, *self.render_args("out.exr", "--checkpoint", "disk/c.tsf", *self.ARGS), timeout=60)
            self.assertEqual(os.listdir(disk), ["c.tsf"])
            self.check(run.err, "disk/c.tsf")
            before = (disk / "c.tsf").read_bytes()
            run = self.expect(OUTPUT, *self.render_args("disk/out.exr", "--res", "300x300", "--checkpoint", "big.tsf"))
            self.assertIn("disk/out.exr: cannot write", run.err)
            self.assertIn("--resume big.tsf writes the picture", run.err)
            run = self.expect(OUTPUT, *self.render_args("disk/out.exr", "--res", "300x300", "--checkpoint", "disk/b.tsf"))
            self.assertEqual(os.listdir(disk), ["c.tsf"])
            self.assertIn("disk/b.tsf could not be written either", run.err)
            self.assertNotIn("writes the picture", run.err)
            run = self.expect(OUTPUT, *self.render_args("disk/part.tsf", "--res", "300x300"))
            self.assertIn("disk/part.tsf: cannot write", run.err)
            self.assertEqual(os.listdir(disk), ["c.tsf"])
            self.assertEqual((disk / "c.tsf").read_bytes(), before)
            self.expect(0, *self.render_args("out.exr", "--res", "300x300", "--resume", "big.tsf"))
        finally:
            subprocess.run(["umount", disk], check=True)


if __name__ == "__main__":
    unittest.main()
