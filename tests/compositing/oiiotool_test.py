"""oiiotool takes beauty apart and together again: passes, light groups, groups with other weights."""

import math
import re

from still_life import ALL, FLOAT_TOLERANCE, GROUPS, HALF_FLOOR, HALF_TOLERANCE, LIGHT, Exr, StillLifeTest, main

# What the lamps of each group are multiplied by, and the key of the scene file that says so.
LAMPS = {
    "RGBA_fill": ("environment.radiance", (0.2, 0.25, 0.33)),
    "RGBA_key": ("light.softbox.radiance", (5.4, 5.2, 4.8)),
    "RGBA_rim": ("light.strip.radiance", (10, 10.5, 12)),
    "RGBA_flame": ("material.flame.emission_luminance", (5000,)),
}


def layer(name):
    return [f"{name}.{c}" for c in "RGB"]


def sum_of(file, layers, output, weights=None):
    """Arguments that add up layers of a file; weights are colours."""
    arguments = ["oiiotool", file, "--label", "all"]
    for n, name in enumerate(layers):
        arguments += ["all", "--ch", ",".join(layer(name)), "--chnames", "R,G,B"]
        if weights:
            arguments += ["--mulc", ",".join(map(repr, weights[name]))]
        arguments += ["--add"] if n else []
    return arguments + ["-d", "float", "-o", output]


class Oiiotool(StillLifeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.render("float.exr", *ALL, "--float", "--aov", "variance")
        cls.render("half.exr", *ALL)

    def assert_sum(self, file, layers, relative, absolute):
        self.run_tool(*sum_of(file, layers, "sum.exr"))
        self.assert_near(self.colours("sum.exr"), self.colours(file), relative, absolute, file)

    def test_passes_add_up_to_beauty(self):
        self.assert_sum("float.exr", LIGHT, FLOAT_TOLERANCE, 1e-7)
        self.assert_sum("half.exr", LIGHT, HALF_TOLERANCE, HALF_FLOOR)

    def test_a_pass_less_is_noticed(self):
        for name in ("sss_direct", "coat_direct", "sheen_direct", "emission"):
            with self.subTest(name), self.assertRaises(AssertionError):
                self.assert_sum("float.exr", [p for p in LIGHT if p != name], FLOAT_TOLERANCE, 1e-7)

    def test_light_groups_add_up_to_beauty(self):
        self.assertEqual(sorted({c[:-2] for c in Exr(self.folder / "float.exr").channels if c.startswith("RGBA_")}), GROUPS)
        self.assert_sum("float.exr", GROUPS, FLOAT_TOLERANCE, 1e-7)
        self.assert_sum("half.exr", GROUPS, HALF_TOLERANCE, HALF_FLOOR)

    def relit(self, weights, output):
        """What oiiotool makes of the groups, and what a render with such lamps is."""
        self.run_tool(*sum_of("float.exr", GROUPS, f"mixed_{output}", weights))
        arguments = []
        for group, (key, value) in LAMPS.items():
            value = [v * w for v, w in zip(value, weights[group])]
            arguments += ["--set", f"{key}={value[0] if len(value) == 1 else value}"]
        self.render(output, "--float", "--aov", "variance", *arguments)
        return self.colours(f"mixed_{output}"), self.colours(output)

    def test_a_weight_that_changes_no_choice_is_the_render_itself(self):
        # A constant sky is not sampled as a lamp, and lamps that all grow alike keep their shares: every path is the same.
        weights = {"RGBA_fill": (0.25, 2.0, 1.0), **{g: (3.0, 3.0, 3.0) for g in GROUPS if g != "RGBA_fill"}}
        mixed, rendered = self.relit(weights, "same.exr")
        self.assert_near(mixed, rendered, FLOAT_TOLERANCE, 1e-6, "same paths")

    def test_other_weights_are_the_render_within_its_noise(self):
        # The lamp is chosen by power, so paths differ where weights do.
        weights = {"RGBA_default": (1.0,) * 3, "RGBA_fill": (0.5,) * 3, "RGBA_key": (2.0, 1.5, 1.0),
                   "RGBA_rim": (0.25, 0.25, 0.5), "RGBA_flame": (1.5,) * 3}
        mixed, rendered = self.relit(weights, "other.exr")
        first, second = Exr(self.folder / "float.exr"), Exr(self.folder / "other.exr")
        largest = max(w for weight in weights.values() for w in weight)
        plain = self.colours(first)
        for c, name in enumerate(layer("variance")):
            # The mixed picture's variance is at most the first's times the largest weight squared.
            sigma = math.sqrt(largest**2 * sum(first.values(name)) + sum(second.values(name)))
            self.assertLess(abs(sum(mixed[c]) - sum(rendered[c])), 3 * sigma, f"mean of channel {c}")
        # And a look that is not the one asked for is many sigma away in the shadows' tint: red over blue.
        ratio = [sum(p[0]) / sum(p[2]) for p in (mixed, rendered, plain)]
        self.assertAlmostEqual(ratio[0], ratio[1], delta=abs(ratio[2] - ratio[1]) / 5)


class Layouts(StillLifeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.render("one.exr", *ALL)

    def test_parts_hold_what_the_single_file_does(self):
        self.render("parts.exr", *ALL, "--exr", "multipart")
        parts = int(re.search(r"(\d+) subimages", self.run_tool("oiiotool", "--info", "-v", "-a", "parts.exr"))[1])
        self.run_tool("oiiotool", "-a", "parts.exr", "--sisplit", *["--chappend"] * (parts - 1), "-o", "joined.exr")
        joined, one = Exr(self.folder / "joined.exr"), Exr(self.folder / "one.exr")
        for name in one.channels:
            found = joined.values("depth.Z" if name == "Z" else name)
            self.assertEqual(found, one.values(name), name)

    def test_split_files_add_up_to_beauty(self):
        self.render("s_<aov>.exr", *ALL, "--exr", "split")
        arguments = []
        for n, name in enumerate(LIGHT):
            arguments += [f"s_{name}.exr", "--ch", "R,G,B"] + (["--add"] if n else [])
        self.run_tool("oiiotool", *arguments, "-d", "float", "-o", "sum.exr")
        self.assert_near(self.colours("sum.exr"), self.colours("s_beauty.exr"), HALF_TOLERANCE, HALF_FLOOR)


if __name__ == "__main__":
    main("oiiotool")
