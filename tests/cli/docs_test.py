"""The commands in the documentation run: every ```sh test block, in a copy of the scenes, in the order of the page."""

import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import PROGRAM, SLOWDOWN, SOURCE, TesseraTest

BLOCK = re.compile(r"^```sh test\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")


def pages():
    return [p for p in (SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))) if p.is_file()]


class Docs(TesseraTest):
    def setUp(self):
        super().setUp()
        shutil.copytree(SOURCE / "scenes", self.folder / "scenes")
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "tessera").symlink_to(pathlib.Path(PROGRAM).resolve())

    def run_block(self, block):
        environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}
        return subprocess.run(
            ["bash", "-euxo", "pipefail", "-c", block],
            cwd=self.folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=60 * SLOWDOWN,
        )

    def test_commands_run(self):
        count = 0
        for page in pages():
            for block in BLOCK.findall(page.read_text()):
                count += 1
                with self.subTest(page=page.name, block=block):
                    done = self.run_block(block)
                    self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}\n{done.stderr}")
        self.assertGreater(count, 0, "there are commands to run")

    def test_files_that_pages_link_to_are_there(self):
        for page in pages():
            for link in LINK.findall(page.read_text()):
                with self.subTest(page=page.name, link=link):
                    self.assertTrue((page.parent / link).exists())

    def test_render_options_are_all_documented(self):
        pages = {"render": "command-line.md", "info": "command-line.md", "bench": "command-line.md", "compare": "compare.md",
                 "converge": "converge.md"}
        for command, page in pages.items():
            text = (SOURCE / "docs" / page).read_text()
            shown = self.expect(0, command, "--help").out.split("Examples:")[0]
            for option in set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", shown)) - {"--help"}:
                with self.subTest(command=command, option=option):
                    self.assertRegex(text, rf"{option}(?![\w-])")


if __name__ == "__main__":
    unittest.main()
