"""Blender's compositor, without a window: layers, sums, light groups, mattes by its Cryptomatte node, windows. It starts once."""

import json
import struct

from read_cryptomatte import File, id_of
from still_life import ALL, FLOAT_TOLERANCE, GROUPS, HALF_FLOOR, HALF_TOLERANCE, LIGHT, SCENE, SOURCE, Exr, StillLifeTest, main

WEIGHTS = {"RGBA_default": (1, 1, 1), "RGBA_fill": (0.5, 0.75, 1), "RGBA_key": (2, 1.5, 1), "RGBA_rim": (0, 0.25, 3), "RGBA_flame": (4, 4, 4)}
OBJECTS = ("red ball", 'vase "bleu"', "bougie allumée", "glass ball", "backdrop")
MATERIALS = ("blue glaze", "cire dorée", "brass", "paper")
# As CryptoObject names; a comma separates names in Blender's node.
WITH_COMMA = "red, round ball"
CROP = ("--crop", "16,8,64,48")


def plain(names):
    return [(name, None) for name in names]


class Blender(StillLifeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.jobs = []
        cls.render("float.exr", *ALL, "--float")
        cls.render("half.exr", *ALL)
        cls.render("parts.exr", *ALL, "--exr", "multipart")
        cls.render("dwa.exr", *ALL, "--exr", "multipart", "--compression", "dwaa")
        cls.render("sidecar.exr", "--aov", "CryptoObject", "--crypto-manifest", "sidecar")
        cls.render("crop.exr", *CROP)
        cls.render("padded.exr", *CROP, "--crop-pad")
        cls.render("wide.exr", "--overscan", "8px")
        for file in ("float", "half", "parts", "dwa"):
            cls.job(file, "passes", sum=plain(LIGHT))
            cls.job(file, "groups", sum=plain(GROUPS))
        cls.job("float", "relit", sum=list(WEIGHTS.items()))
        for socket in ("Combined", "N", "P", "Depth", "coat_direct"):
            cls.job("float", socket, socket=socket)
        for kind, names in (("CryptoObject", OBJECTS), ("CryptoMaterial", MATERIALS), ("CryptoAsset", ("still life",))):
            for n, name in enumerate(names):
                cls.job("half", f"{kind}{n}", matte=(kind, name))
        for file in ("crop", "padded", "wide"):
            cls.job(file, "Combined", socket="Combined")
        for file in ("parts", "sidecar"):
            cls.job(file, "matte", matte=("CryptoObject", OBJECTS[0]))
        cls.commas()
        (cls.folder / "jobs.json").write_text(json.dumps(cls.jobs), encoding="utf-8")
        driver = SOURCE / "tests" / "compositing" / "in_blender.py"
        cls.log = cls.run_tool(
            "blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", driver, "--", "jobs.json", cls.folder
        )
        cls.facts = json.loads((cls.folder / "facts.json").read_text(encoding="utf-8"))

    @classmethod
    def job(cls, file, output, **what):
        cls.jobs.append({"file": f"{file}.exr", "output": f"blender_{file}_{output}", **what})

    @classmethod
    def commas(cls):
        """The scene again, with a name that Blender's node takes for two."""
        for file in SCENE.parent.glob("*.obj"):
            (cls.folder / file.name).write_bytes(file.read_bytes())
        text = SCENE.read_text(encoding="utf-8").replace('"red ball"', f'"{WITH_COMMA}"')
        (cls.folder / "commas.toml").write_text(text, encoding="utf-8")
        cls.render("commas.exr", "--aov", "CryptoObject", scene="commas.toml")
        (value,) = struct.unpack("<f", struct.pack("<I", id_of(WITH_COMMA)))
        cls.job("commas", "name", matte=("CryptoObject", WITH_COMMA))
        cls.job("commas", "number", matte=("CryptoObject", f"<{value!r}>"))

    def written(self, file, output):
        self.assertEqual(self.facts[f"{file}.exr"]["refused"], {})
        return Exr(self.folder / f"blender_{file}_{output}_1.exr")

    def assert_matte(self, file, output, kind, name):
        theirs = self.written(file, output).values("R")
        ours = File(self.folder / f"{file}.exr").cryptomattes()[kind].matte(id_of(name))
        self.assert_near([theirs], [ours], 1e-6, message=f"{kind} '{name}'")

    def test_every_layer_is_a_socket(self):
        for file in ("float", "half", "parts"):
            sockets = self.facts[f"{file}.exr"]["sockets"]
            self.assertEqual(self.facts[f"{file}.exr"]["type"], "MULTILAYER")
            self.assertLessEqual({"Combined", "Alpha", "N", "P", "albedo", *LIGHT, *GROUPS}, set(sockets), file)

    def test_values_arrive_as_they_are(self):
        whole = Exr(self.folder / "float.exr")
        self.assert_near(self.colours(self.written("float", "Combined")), self.colours(whole), 0, 1e-30)
        self.assert_near(self.colours(self.written("float", "coat_direct")), self.colours(whole, "coat_direct"), 0, 1e-30)
        for layer in "NP":
            self.assert_near(self.colours(self.written("float", layer)), [whole.values(f"{layer}.{c}") for c in "XYZ"], 0, 1e-30)
        depth = self.written("float", "Depth")
        self.assert_near([depth.values("R" if "R" in depth.channels else "V")], [whole.values("Z")], 0, 1e-30)

    def test_passes_add_up_to_beauty(self):
        for output in ("passes", "groups"):
            self.assert_near(self.colours(self.written("float", output)), self.colours("float.exr"), FLOAT_TOLERANCE, message=output)
            for file in ("half", "parts"):
                beauty = self.colours(self.written("float", "Combined")) if file == "parts" else self.colours("half.exr")
                self.assert_near(self.colours(self.written(file, output)), beauty, HALF_TOLERANCE, HALF_FLOOR, f"{file} {output}")

    def test_lossy_passes_add_up_in_the_mean(self):
        beauty = self.colours("float.exr")
        for output in ("passes", "groups"):
            for found, wanted in zip(self.colours(self.written("dwa", output)), beauty):
                self.assertAlmostEqual(sum(found) / sum(wanted), 1, delta=0.01, msg=output)

    def test_groups_with_other_weights_are_their_weighted_sum(self):
        file = Exr(self.folder / "float.exr")
        wanted = []
        for c, name in enumerate("RGB"):
            values = [[w[c] * v for v in file.values(f"{group}.{name}")] for group, w in WEIGHTS.items()]
            wanted.append([sum(pixel) for pixel in zip(*values)])
        self.assert_near(self.colours(self.written("float", "relit")), wanted, FLOAT_TOLERANCE)

    def test_mattes_are_those_of_the_independent_reader(self):
        self.assertEqual(self.facts["half.exr"]["mattes"], ["CryptoObject", "CryptoMaterial", "CryptoAsset"])
        for kind, names in (("CryptoObject", OBJECTS), ("CryptoMaterial", MATERIALS), ("CryptoAsset", ("still life",))):
            for n, name in enumerate(names):
                with self.subTest(name):
                    self.assert_matte("half", f"{kind}{n}", kind, name)

    def test_a_sidecar_leaves_the_menu_empty_but_a_typed_name_works(self):
        self.assertEqual(self.facts["sidecar.exr"]["mattes"], [])
        self.assert_matte("sidecar", "matte", "CryptoObject", OBJECTS[0])

    def test_mattes_of_parts_are_those_of_the_single_file(self):
        self.assertEqual(self.facts["parts.exr"]["mattes"], self.facts["half.exr"]["mattes"])
        self.assertEqual(self.written("parts", "matte").values("R"), self.written("half", "CryptoObject0").values("R"))

    def test_a_name_with_a_comma_is_keyed_by_its_number(self):
        self.assertEqual(max(self.written("commas", "name").values("R")), 0)  # two names that are nowhere
        self.assert_matte("commas", "number", "CryptoObject", WITH_COMMA)

    def test_the_place_of_a_window_is_lost_and_padding_keeps_it(self):
        for file, size in (("crop", (48, 40)), ("wide", (96 + 16, 54 + 16)), ("padded", (96, 54))):
            picture = self.written(file, "Combined")
            self.assertEqual((picture.size, picture.data_window[:2]), (size, (0, 0)), file)
        self.assert_near(self.colours(self.written("padded", "Combined")), self.colours("padded.exr"), 0, 1e-30)
        self.assert_near(self.colours(self.written("crop", "Combined")), self.colours("crop.exr"), 0, 1e-30)


if __name__ == "__main__":
    main("blender")
