"""cmake --install and the .deb hold a program that runs from where it was put."""

import os
import shutil
import subprocess
import unittest

from support import TesseraTest, command

BUILD = os.environ.get("TESSERA_BUILD", "")


@unittest.skipUnless(BUILD, "TESSERA_BUILD is not set")
class Install(TesseraTest):
    def run_tool(self, *args):
        done = subprocess.run(args, cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, f"{args}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def check_tree(self, prefix):
        program = prefix / "bin" / "tessera"
        expected = self.run_tool(*command("version"))
        self.assertEqual(self.run_tool(str(program), "version"), expected)
        self.assertTrue((prefix / "share/tessera/scenes/whitted/whitted.toml").is_file())
        self.assertTrue((prefix / "share/doc/tessera/LICENSE").is_file())

    def test_install_to_a_prefix(self):
        self.run_tool("cmake", "--install", BUILD, "--prefix", str(self.folder / "prefix"))
        self.check_tree(self.folder / "prefix")

    @unittest.skipUnless(shutil.which("dpkg-deb") and shutil.which("dpkg-shlibdeps"), "dpkg-dev is not installed")
    def test_debian_package(self):
        self.run_tool("cpack", "-G", "DEB", "--config", f"{BUILD}/CPackConfig.cmake", "-B", str(self.folder / "package"))
        packages = list((self.folder / "package").glob("*.deb"))
        self.assertEqual(len(packages), 1, packages)
        fields = self.run_tool("dpkg-deb", "--field", str(packages[0]))
        self.assertRegex(fields, r"(?m)^Package: tessera$")
        self.assertRegex(fields, r"(?m)^Depends: .*libembree")
        self.run_tool("dpkg-deb", "-x", str(packages[0]), str(self.folder / "root"))
        self.check_tree(self.folder / "root" / "usr")


if __name__ == "__main__":
    unittest.main()
