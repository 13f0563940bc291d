"""What the compositing tests share: scenes/compositing rendered once per class, its passes, and comparing pictures."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from exr import Exr  # noqa: E402
from support import SLOWDOWN, SOURCE, command  # noqa: E402

SCENE = SOURCE / "scenes" / "compositing" / "compositing.toml"
LOBES = ("diffuse", "specular", "coat", "transmission", "sss", "sheen", "volume")
LIGHT = [f"{lobe}_{way}" for lobe in LOBES for way in ("direct", "indirect")] + ["emission", "background"]
GROUPS = ["RGBA_default", "RGBA_fill", "RGBA_flame", "RGBA_key", "RGBA_rim"]
ALL = ("--aov", "compositing", "--aov", "light_groups", "--aov", "cryptomatte", "--aov", "basic")
SMALL = ("--res", "96x54", "--spp", "4", "--quiet")

# Sums in float are of rounded floats, some twenty of them.
FLOAT_TOLERANCE = 1e-5
# A pass as half is off by 2^-11 of itself at most, beauty too; passes are not negative, so their sum is off by 2^-11 of beauty.
HALF_TOLERANCE = 2**-10
# Below 2^-14 half numbers lie 2^-24 apart, and a pixel has 16 passes.
HALF_FLOOR = 17 * 2**-25


class StillLifeTest(unittest.TestCase):
    """Tests share a folder and what setUpClass renders into it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="tessera_compositing_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)

    @classmethod
    def run_tool(cls, *args, timeout=60, code=0):
        """Runs a program in the folder and gives what it printed."""
        done = subprocess.run(
            list(map(str, args)), cwd=cls.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, timeout=timeout * SLOWDOWN,
        )
        text = done.stdout.decode(errors="replace")
        if done.returncode != code:
            raise AssertionError(f"{' '.join(map(str, args))}\nexit code {done.returncode}\n{text}")
        return text

    @classmethod
    def render(cls, output, *args, scene=SCENE):
        """Renders the small picture to a file of this name."""
        cls.run_tool(*command("render", scene, "-o", output, *SMALL, *args))

    def colours(self, picture, layer=""):
        """R, G and B of a layer as lists; picture is a file's name or an Exr."""
        exr = picture if isinstance(picture, Exr) else Exr(self.folder / picture)
        return [exr.values(f"{layer}.{c}" if layer else c) for c in "RGB"]

    def assert_near(self, found, wanted, relative, absolute=1e-7, message=""):
        """Every value within a share of what is wanted; lists of channels."""
        worst = (0, None)
        for c, (a, b) in enumerate(zip(found, wanted, strict=True)):
            self.assertEqual(len(a), len(b), f"{message}: another size")
            for i, (x, y) in enumerate(zip(a, b)):
                off = abs(x - y) / (relative * abs(y) + absolute)
                if not off <= worst[0]:  # nor no number
                    worst = (off, f"{message}: channel {c}, pixel {i}: {x:.9g}, not {y:.9g}")
        self.assertGreater(max(map(max, wanted)), 0, f"{message}: there is nothing to compare")
        self.assertLessEqual(worst[0], 1, worst[1])


def main(*tools):
    """Runs the tests of a file, or says what they lack (77: CTest's skip)."""
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        print(f"skipped: no {' and no '.join(missing)} here; 'scripts/setup all' installs it")
        sys.exit(77)
    unittest.main()
