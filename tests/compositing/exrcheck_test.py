"""tessera exrcheck finds nothing in any file that Tessera writes: sets of passes, layouts, codecs, windows."""

from still_life import ALL, StillLifeTest, command, main

SETS = {
    "nothing asked for": (),
    "beauty": ("--aov", "beauty"),
    "basic": ("--aov", "basic"),
    "compositing": ("--aov", "compositing"),
    "lookdev": ("--aov", "lookdev"),
    "denoise": ("--aov", "denoise"),
    "debug": ("--aov", "debug"),
    "cryptomatte": ("--aov", "cryptomatte"),
    "light groups": ("--aov", "light_groups", "--aov", "diffuse@groups", "--aov", "own = C<RD>T+L"),
    "all": (*ALL, "--aov", "lookdev", "--aov", "denoise", "--aov", "debug"),
}
LAYOUTS = ("single", "multipart", "split")
# Colours alone in a single part may be lossy.
COLOUR = ("--aov", "albedo", "--aov", "diffuse", "--aov", "light_groups")


class Exrcheck(StillLifeTest):
    def assert_clean(self, *args):
        """Renders, and checks every file that came of it."""
        for old in self.folder.glob("c*.exr"):
            old.unlink()
        self.render("c_<aov>.exr" if "split" in args else "c.exr", *args)
        files = sorted(p.name for p in self.folder.glob("c*.exr"))
        said = self.run_tool(*command("exrcheck", "--strict", *files))
        self.assertEqual(said, "".join(f"{f}: clean\n" for f in files))
        return files

    def test_sets_of_passes_in_every_layout(self):
        for name, passes in SETS.items():
            for layout in LAYOUTS:
                with self.subTest(f"{name}, {layout}"):
                    files = self.assert_clean(*passes, "--exr", layout)
                    self.assertEqual(len(files) > 1, layout == "split" and name != "beauty")

    def test_codecs_in_every_layout(self):
        for codec in ("none", "zips", "zip", "piz", "dwaa", "dwab"):
            for layout in LAYOUTS:
                with self.subTest(f"{codec}, {layout}"):
                    lossy = codec.startswith("dwa") and layout == "single"
                    # Some seventy files of all passes are enough for one codec, above.
                    passes = COLOUR if lossy else SETS["all" if layout != "split" else "denoise"]
                    self.assert_clean(*passes, "--exr", layout, "--compression", codec)

    def test_float_padding_and_working_spaces(self):
        self.assert_clean(*ALL, "--float")
        self.assert_clean(*ALL, "--crop", "8,4,40,20", "--crop-pad")
        self.assert_clean(*ALL, "--set", "film.working_space=acescg", "--deterministic-metadata")

    def test_a_sky_without_alpha_is_worth_a_note_and_no_more(self):
        self.render("sky.exr", "--camera", "latlong", *ALL)
        said = self.run_tool(*command("exrcheck", "--strict", "sky.exr"))
        self.assertIn("[light-without-alpha]", said)
        self.assertEqual(said.count("["), 1, said)

    def test_of_windows_it_says_what_blender_does(self):
        for options in (("--crop", "8,4,40,20"), ("--overscan", "4px")):
            self.render("window.exr", *options)
            said = self.run_tool(*command("exrcheck", "window.exr"))
            self.assertEqual([line for line in said.splitlines() if "[" in line and "window-offset" not in line], [])
            self.assertIn("[window-offset]", said)


if __name__ == "__main__":
    main()
