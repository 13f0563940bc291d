"""scripts/check_layers: a clean tree passes, and each kind of planted violation is found where it stands."""

import subprocess
import sys
import unittest

from support import SOURCE, TesseraTest

CHECK = SOURCE / "scripts" / "check_layers"


class Layers(TesseraTest):
    def check(self, files):
        """Runs the check on a tree of these files; gives exit code and output."""
        for name, text in files.items():
            self.write(name, text)
        done = subprocess.run(
            [sys.executable, str(CHECK), "--root", str(self.folder)], capture_output=True, text=True, timeout=60
        )
        return done.returncode, done.stdout + done.stderr

    def plant(self, path, include, found=None):
        code, output = self.check({path: f"#pragma once\n\n#include {include}\n"})
        self.assertEqual(code, 1, output)
        self.assertIn(found or f"{path}:3: ", output)
        (self.folder / path).unlink()

    def test_allowed_includes_pass(self):
        code, output = self.check(
            {
                "renderer/api/error.h": "#pragma once\n#include <string>\n#include <vector>\n",
                "renderer/core/vec.h": "#pragma once\n#include <cmath>\n",
                "renderer/core/parallel.cpp": "#include <tbb/parallel_for.h>\n",
                "renderer/image/texture.h": '#include "renderer/core/vec.h"\n',
                "renderer/image/image_io.cpp": "#include <OpenImageIO/imageio.h>\n#include <fmt/core.h>\n",
                "renderer/geometry/embree.h": "#include <embree3/rtcore.h>\n",
                "renderer/geometry/accel.cpp": '#include "renderer/geometry/embree.h"\n',
                "renderer/integrator/path.h": '#include "renderer/scene/scene.h"\n#include "renderer/film/film.h"\n',
                "renderer/io/obj.cpp": "#include <tiny_obj_loader.h>\n#include <toml++/toml.h>\n",
                "renderer/cli/main.cpp": '#include <CLI/CLI.hpp>\n#include "renderer/io/obj.h"\n',
                "materials/lobes/ggx.h": '#include "materials/lobe.h"\n#include "renderer/image/texture.h"\n',
                "tests/unit/vec_test.cpp": "#include <doctest/doctest.h>\n#include <OpenImageIO/imageio.h>\n",
            }
        )
        self.assertEqual(code, 0, output)

    def test_upward_includes_are_found(self):
        for path, include in (
            ("renderer/core/a.h", "renderer/image/texture.h"),
            ("renderer/image/a.cpp", "renderer/geometry/mesh.h"),
            ("renderer/geometry/a.h", "renderer/image/texture.h"),
            ("renderer/lights/a.h", "renderer/geometry/mesh.h"),
            ("renderer/film/a.h", "renderer/lights/light.h"),
            ("renderer/lights/a.h", "renderer/film/film.h"),
            ("renderer/scene/a.h", "renderer/integrator/path.h"),
            ("renderer/io/a.cpp", "renderer/scene/scene.h"),
            ("renderer/integrator/a.h", "renderer/io/obj.h"),
            ("renderer/integrator/a.h", "renderer/cli/main.h"),
            ("materials/lobes/a.h", "renderer/geometry/mesh.h"),
            ("materials/a.h", "renderer/image/image_io.h"),
            ("renderer/api/a.h", "renderer/core/vec.h"),
            ("renderer/attic/a.h", "renderer/core/vec.h"),
        ):
            with self.subTest(path=path, include=include):
                self.plant(path, f'"{include}"')

    def test_heavy_headers_are_found_outside_their_owner(self):
        for path, include in (
            ("renderer/image/a.h", "<OpenImageIO/imageio.h>"),
            ("renderer/scene/a.cpp", "<OpenImageIO/imageio.h>"),
            ("renderer/cli/a.cpp", "<OpenColorIO/OpenColorIO.h>"),
            ("renderer/film/a.cpp", "<ImfOutputFile.h>"),
            ("renderer/scene/a.cpp", "<embree3/rtcore.h>"),
            ("renderer/integrator/a.cpp", "<tbb/task_arena.h>"),
            ("renderer/core/parallel.h", "<oneapi/tbb.h>"),
            ("renderer/scene/a.cpp", '"renderer/geometry/embree.h"'),
            ("renderer/geometry/a.h", '"renderer/geometry/embree.h"'),
            ("renderer/cli/a.cpp", "<toml++/toml.h>"),
            ("renderer/io/a.h", "<tiny_obj_loader.h>"),
            ("renderer/io/a.cpp", "<CLI/CLI.hpp>"),
            ("renderer/core/a.h", "<nlohmann/json.hpp>"),
            ("materials/a.h", "<fmt/core.h>"),
            ("renderer/core/a.cpp", "<doctest/doctest.h>"),
            ("tests/support/a.h", "<OpenImageIO/imageio.h>"),
            ("renderer/api/a.h", "<fmt/core.h>"),
        ):
            with self.subTest(path=path, include=include):
                self.plant(path, include)

    def test_include_by_macro_or_beside_is_found(self):
        self.plant("renderer/core/a.h", "HEADER")
        self.write("renderer/core/vec.h", "")
        self.plant("renderer/core/a.h", '"vec.h"')

    def test_cycles_are_found(self):
        code, output = self.check(
            {
                "renderer/core/a.h": '#include "renderer/core/b.h"\n',
                "renderer/core/b.h": '#include "renderer/core/a.h"\n',
            }
        )
        self.assertEqual(code, 1)
        self.assertIn("cycle of files: renderer/core/a.h -> renderer/core/b.h -> renderer/core/a.h", output)

    def test_long_files_are_noted_and_then_refused(self):
        code, output = self.check({"renderer/core/a.cpp": "\n" * 401})
        self.assertEqual(code, 0, output)
        self.assertIn("renderer/core/a.cpp:401: note", output)
        code, output = self.check({"renderer/core/a.cpp": "\n" * 601})
        self.assertEqual(code, 1)
        self.assertIn("renderer/core/a.cpp:601: ", output)

    def test_an_empty_tree_is_an_error(self):
        self.assertEqual(self.check({})[0], 1)


if __name__ == "__main__":
    unittest.main()
