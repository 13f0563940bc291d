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
    def write(self, name, *args):
        """Renders to files whose names begin so; gives how many there are."""
        self.render(f"{name}_<aov>.exr" if "split" in args else f"{name}.exr", "--res", "48x28", "--spp", "1", *args)
        return len([p for p in self.folder.glob("*.exr") if p.stem == name or p.stem.startswith(f"{name}_")])

    def assert_clean(self):
        """Of all files written since the last call."""
        files = sorted(p.name for p in self.folder.glob("*.exr"))
        said = self.run_tool(*command("exrcheck", "--strict", *files))
        self.assertEqual(said, "".join(f"{f}: clean\n" for f in files))
        for file in files:
            (self.folder / file).unlink()

    def test_sets_of_passes_in_every_layout(self):
        for name, passes in SETS.items():
            for layout in LAYOUTS:
                with self.subTest(f"{name}, {layout}"):
                    count = self.write(f"{name}-{layout}", *passes, "--exr", layout)
                    self.assertEqual(count > 1, layout == "split" and name != "beauty")
        self.assert_clean()

    def test_codecs_in_every_layout(self):
        for codec in ("none", "zips", "zip", "piz", "dwaa", "dwab"):
            for layout in LAYOUTS:
                lossy = codec.startswith("dwa") and layout == "single"
                # Some seventy files of all passes are enough for one codec, above.
                passes = COLOUR if lossy else SETS["all" if layout != "split" else "denoise"]
                self.write(f"{codec}-{layout}", *passes, "--exr", layout, "--compression", codec)
        self.assert_clean()

    def test_float_padding_and_working_spaces(self):
        self.write("float", *ALL, "--float")
        self.write("padded", *ALL, "--crop", "8,4,32,20", "--crop-pad")
        self.write("acescg", *ALL, "--set", "film.working_space=acescg", "--deterministic-metadata")
        self.assert_clean()

    def test_a_sky_without_alpha_is_worth_a_note_and_no_more(self):
        self.addCleanup((self.folder / "sky.exr").unlink)
        self.render("sky.exr", "--camera", "latlong", *ALL)
        said = self.run_tool(*command("exrcheck", "--strict", "sky.exr"))
        self.assertIn("[light-without-alpha]", said)
        self.assertEqual(said.count("["), 1, said)

    def test_of_windows_it_says_what_blender_does(self):
        for options in (("--crop", "8,4,40,20"), ("--overscan", "4px")):
            self.addCleanup((self.folder / "window.exr").unlink, missing_ok=True)
            self.render("window.exr", *options)
            said = self.run_tool(*command("exrcheck", "window.exr"))
            self.assertEqual([line for line in said.splitlines() if "[" in line and "window-offset" not in line], [])
            self.assertIn("[window-offset]", said)


if __name__ == "__main__":
    main()
