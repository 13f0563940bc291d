"""tessera render --display: what the viewer gets, and that no viewer can harm the render."""

import signal
import socket
import subprocess
import threading
import time
import unittest

from exr import Exr
from support import PARTIAL, SLOWDOWN, USAGE, TesseraTest, command
from tev_receiver import TevReceiver

# The layers of a pass, about 4 MB: more than the buffers of a connection that nobody reads.
LARGE = ("--res", "320x240", "--float")
# What a bad viewer may cost at the end, by a generous measure: the program waits 1 s for it.
WAIT_S = 8


def has_ipv6():
    try:
        with socket.socket(socket.AF_INET6) as s:
            s.bind(("::1", 0))
        return True
    except OSError:
        return False


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class DisplayTest(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene()

    def receiver(self, *args, **options):
        receiver = TevReceiver(*args, **options)
        self.addCleanup(receiver.close)
        return receiver

    def show(self, receiver, *args, display=None):
        """Renders out.exr for the receiver and gives the run."""
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--display", display or receiver.address, *args)
        receiver.close()
        self.assertEqual(receiver.errors, [])
        return run

    def assert_shown(self, receiver):
        """The viewer's only picture has out.exr's very floats, and zeros around them."""
        exr = Exr(self.folder / "out.exr")
        self.assertEqual(list(receiver.pictures), ["out.exr"])
        picture = receiver.pictures["out.exr"]
        self.assertEqual(set(picture.channels), set(exr.channels))
        x0, y0, x1, y1 = exr.data_window
        self.assert_same_pixels(exr.pixels(), picture.pixels((x0, y0, x1 + 1, y1 + 1)))
        inside = sum(len(p) - p.count(0) for p in exr.pixels().values())
        everywhere = sum(len(p) - p.count(0) for p in picture.pixels().values())
        self.assertEqual(inside, everywhere, "pixels outside the window were sent")

    def assert_warned_once(self, run, words=""):
        warnings = [line for line in run.err.splitlines() if "display" in line]
        self.assertEqual(len(warnings), 1, run)
        self.assertRegex(warnings[0], rf"^warning: display .*{words}")


class Shown(DisplayTest):
    def test_the_viewer_ends_up_with_the_floats_of_the_file(self):
        for args in ((), ("--aov", "Z"), ("--res", "75x53", "--tile", "8"), ("--res", "200x130", "--tile", "256")):
            with self.subTest(args=args):
                receiver = self.receiver()
                run = self.show(receiver, "--float", *args)
                self.assert_shown(receiver)
                self.assertNotIn("display", run.err)
                self.assertEqual(receiver.connections, 1)

    def test_a_crop_stands_in_its_place_of_the_frame(self):
        receiver = self.receiver()
        self.show(receiver, "--float", "--res", "200x130", "--crop", "33,50,171,121")
        self.assert_shown(receiver)
        self.assertEqual((receiver.pictures["out.exr"].width, receiver.pictures["out.exr"].height), (200, 130))

    def test_tiles_arrive_while_the_render_goes_on(self):
        receiver = self.receiver()
        args = ("--display", receiver.address, "--time", "30", "-q")
        process = subprocess.Popen(command("render", "scene.toml", "-o", "out.exr", *args), cwd=self.folder)
        end = time.monotonic() + 20 * SLOWDOWN
        while not receiver.pictures and time.monotonic() < end:
            time.sleep(0.01)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=20 * SLOWDOWN), PARTIAL)
        self.assertTrue(receiver.pictures)

    def test_the_picture_keeps_its_bits(self):
        without = self.render(output="without.exr")
        self.show(self.receiver())
        self.assert_same_bits(without, Exr(self.folder / "out.exr"))

    def test_host_by_name(self):
        receiver = self.receiver()
        self.show(receiver, "--float", display=f"localhost:{receiver.port}")
        self.assert_shown(receiver)

    @unittest.skipUnless(has_ipv6(), "no IPv6 here")
    def test_host_by_ipv6_address(self):
        receiver = self.receiver(host="::1")
        self.show(receiver, "--float")
        self.assert_shown(receiver)

    def test_addresses_that_are_none_are_usage_errors(self):
        for text in ("", "host:", ":14158", "host:0", "host:65536", "host:1x", "[::1", "[::1]14158", "[]:1"):
            run = self.expect(USAGE, "render", "scene.toml", "-o", "out.exr", "--display", text)
            self.assertIn("--display", run.err)
        self.assertEqual(self.files(), ["scene.toml", "triangles.mtl", "triangles.obj"])


class BadViewers(DisplayTest):
    def test_one_that_is_not_there_is_one_warning(self):
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--display", f"127.0.0.1:{free_port()}")
        self.assert_warned_once(run, "refused")
        self.assertLess(run.seconds, WAIT_S * SLOWDOWN)
        self.assert_same_bits(self.render(output="without.exr"), Exr(self.folder / "out.exr"))

    def test_a_host_that_does_not_exist_is_one_warning(self):
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--display", "viewer.invalid")
        self.assert_warned_once(run)
        self.assertLess(run.seconds, WAIT_S * SLOWDOWN)

    def test_quiet_says_nothing_of_it(self):
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "-q", "--display", f"127.0.0.1:{free_port()}")
        self.assertEqual(run.err, "")

    def test_one_that_accepts_and_never_reads_costs_a_bounded_wait_at_the_end(self):
        without = self.expect(0, "render", "scene.toml", "-o", "without.exr", *LARGE)
        receiver = self.receiver(TevReceiver.hang, buffer=4096)
        run = self.show(receiver, *LARGE)
        self.assertLess(run.seconds, without.seconds + WAIT_S * SLOWDOWN)
        self.assert_warned_once(run, "did not take")
        self.assert_same_bits(Exr(self.folder / "without.exr"), Exr(self.folder / "out.exr"))

    def test_one_that_never_reads_does_not_delay_a_stop_by_signal(self):
        receiver = self.receiver(TevReceiver.hang, buffer=4096)
        args = ("--spp", "1000000", "--display", receiver.address, "-q", *LARGE)
        process = subprocess.Popen(command("render", "scene.toml", "-o", "out.exr", *args), cwd=self.folder)
        while not receiver.connections and process.poll() is None:
            time.sleep(0.01)
        time.sleep(1)
        start = time.monotonic()
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=60 * SLOWDOWN), PARTIAL)
        self.assertLess(time.monotonic() - start, (WAIT_S + 10) * SLOWDOWN)
        self.assertEqual(Exr(self.folder / "out.exr").size, (320, 240))

    def test_one_that_closes_at_once_is_one_warning(self):
        run = self.show(self.receiver(TevReceiver.close_at_once), *LARGE)
        self.assert_warned_once(run)
        self.assert_same_bits(self.render(*LARGE, output="without.exr"), Exr(self.folder / "out.exr"))

    def test_one_that_comes_late_gets_the_whole_picture(self):
        port = free_port()
        late = []
        timer = threading.Timer(1, lambda: late.append(TevReceiver(port=port)))
        timer.start()
        args = ("--float", "--time", "3", "--display", f"127.0.0.1:{port}")
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", *args)
        timer.join()
        late[0].close()
        self.assertEqual(late[0].errors, [])
        self.assert_shown(late[0])
        self.assert_warned_once(run, "refused")

    def test_one_that_dies_in_the_middle_gets_the_whole_picture_when_it_is_back(self):
        receiver = self.receiver(TevReceiver.die_once)
        run = self.show(receiver, *LARGE, "--spp", "16")
        self.assertEqual(receiver.connections, 2)
        self.assert_shown(receiver)
        self.assert_warned_once(run)

    def test_one_that_sleeps_gets_its_packets_whole(self):
        receiver = self.receiver(TevReceiver.sleep_then_read, buffer=4096)
        self.show(receiver, *LARGE, "--time", "2")
        self.assert_shown(receiver)

    def test_a_slow_one_gets_the_newest_only(self):
        receiver = self.receiver(TevReceiver.read_slowly, buffer=4096)
        self.show(receiver, *LARGE, "--spp", "64", "--tile", "8")
        self.assert_shown(receiver)
        tiles, passes = 40 * 30, 4
        self.assertLess(receiver.pictures["out.exr"].updates, tiles * passes / 10)


if __name__ == "__main__":
    unittest.main()
