"""What the black-box tests share: running the program, small scenes, a folder that goes away."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import textwrap
import time
import unittest

from exr import Exr

SOURCE = pathlib.Path(os.environ.get("TESSERA_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("TESSERA_PROGRAM", str(SOURCE / "build/release/bin/tessera"))
# Sanitized programs are slower by about this factor.
SLOWDOWN = float(os.environ.get("TESSERA_SLOWDOWN", "1"))

BUG, USAGE, SCENE, OUTPUT, MEMORY, PARTIAL = 1, 2, 3, 4, 5, 75

# A floor of two triangles and a third standing on it.
TRIANGLES_OBJ = """\
    mtllib triangles.mtl
    o floor
    v -2 0 -2
    v 2 0 -2
    v 2 0 2
    v -2 0 2
    vt 0 0
    vt 1 0
    vt 1 1
    vt 0 1
    usemtl grey
    f 3/3 2/2 1/1
    f 4/4 3/3 1/1
    o fin
    v -0.5 0 0
    v 0.5 0 0
    v 0 1 0
    usemtl red
    f 5/1 6/2 7/3
    """
TRIANGLES_MTL = """\
    newmtl grey
    Kd 0.6 0.6 0.6
    newmtl red
    Kd 0.7 0.1 0.1
    """
SCENE_TOML = """\
    tessera = 1
    [camera]
    position = [0, 1.2, 4]
    look_at = [0, 0.4, 0]
    fov_deg = 40
    [film]
    resolution = [48, 32]
    [render]
    spp = 4
    [[mesh]]
    name = "triangles"
    file = "triangles.obj"
    [[instance]]
    of = "triangles"
    [[light]]
    type = "quad"
    corner = [-1, 3, -1]
    edges = [[2, 0, 0], [0, 0, 2]]
    radiance = [12, 12, 11]
    """


class Run:
    """A finished run of the program."""

    def __init__(self, code, out, err, seconds):
        self.code, self.out, self.err, self.seconds = code, out, err, seconds

    def __str__(self):
        return f"exit code {self.code}\nstdout:\n{self.out}\nstderr:\n{self.err}"


def command(*args):
    return [PROGRAM, *map(str, args)]


class TesseraTest(unittest.TestCase):
    """A test in a folder of its own; paths given to the program are relative to it."""

    maxDiff = 2000

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="tessera_cli_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, str):
            content = textwrap.dedent(content).encode()
        path.write_bytes(content)
        return path

    def write_scene(self, toml=SCENE_TOML):
        self.write("triangles.obj", TRIANGLES_OBJ)
        self.write("triangles.mtl", TRIANGLES_MTL)
        self.write("scene.toml", toml)

    def run_program(self, *args, timeout=20, **options):
        start = time.monotonic()
        done = subprocess.run(
            command(*args),
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=timeout * SLOWDOWN,
            **options,
        )
        return Run(
            done.returncode,
            done.stdout.decode(errors="replace"),
            done.stderr.decode(errors="replace"),
            time.monotonic() - start,
        )

    def expect(self, code, *args, **options):
        """Runs the program and checks its exit code."""
        run = self.run_program(*args, **options)
        self.assertEqual(run.code, code, f"{' '.join(map(str, args))}\n{run}")
        return run

    def render(self, *args, output="out.exr", scene="scene.toml"):
        """Renders, expects success, and gives the picture."""
        self.expect(0, "render", scene, "-o", output, *args)
        return Exr(self.folder / output)

    def files(self):
        """Every file under the folder, hidden ones too."""
        return sorted(p.relative_to(self.folder).as_posix() for p in self.folder.rglob("*") if p.is_file())

    def assert_same_bits(self, a, b, message=""):
        self.assertEqual(a.channels, b.channels, message)
        self.assertEqual(a.data_window, b.data_window, message)
        self.assert_same_pixels(a.pixels(), b.pixels(), message)

    def assert_same_pixels(self, a, b, message=""):
        unequal = [name for name in a if a[name] != b[name]]
        self.assertFalse(unequal, f"{message}: channels {unequal} differ")
