"""Cryptomatte in the file: mattes by name that an independent reader decodes and that add up to alpha."""

import subprocess
import sys
import unittest

from exr import Exr
from support import SCENE_TOML, SOURCE, USAGE, TesseraTest

READER = SOURCE / "tests" / "compositing" / "read_cryptomatte.py"
PASSES = ("--aov", "CryptoObject", "--aov", "CryptoMaterial", "--aov", "CryptoAsset")
# Beside the two objects of the mesh: a name for a sphere that JSON must escape, one for a light that is seen, and a cut-out disc.
NAMED_TOML = (
    SCENE_TOML
    + """\
    name = 'lamp'
    [[sphere]]
    name = 'say "шар" \\ ball'
    center = [-0.9, 0.4, 0]
    radius = 0.3
    [material.veil]
    geometry_opacity = 0.4
    [[disc]]
    name = "veil"
    material = "veil"
    center = [0.8, 0.5, 0.5]
    normal = [0, 0, 1]
    radius = 0.4
    """
).replace("position = [0, 1.2, 4]", "position = [0, 1.2, 8]")


class Cryptomatte(TesseraTest):
    def setUp(self):
        super().setUp()
        self.write_scene(NAMED_TOML)

    def read(self, *args, code=0):
        done = subprocess.run(
            [sys.executable, str(READER), *map(str, args)],
            cwd=self.folder,
            capture_output=True,
            text=True,
            encoding="utf-8",
            timeout=60,
        )
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def names(self, file, kind):
        rows = [line.split("\t") for line in self.read(file).splitlines()]
        return {name: float(pixels) for type_name, _, pixels, name in rows if type_name == kind}

    def test_mattes_of_all_names_add_up_to_alpha(self):
        self.render(*PASSES, "--float", "--spp", "37")
        self.read("out.exr", "--check")
        names = self.names("out.exr", "CryptoObject")
        self.assertEqual(set(names), {"floor", "fin", 'say "шар" \\ ball', "veil", "lamp"})
        for name, pixels in names.items():
            self.assertGreater(pixels, 1, name)
        materials = self.names("out.exr", "CryptoMaterial")
        self.assertEqual(set(materials), {"grey", "red", "default", "veil", "light"})
        self.assertAlmostEqual(materials["red"], names["fin"], delta=1e-4)
        assets = self.names("out.exr", "CryptoAsset")
        self.assertEqual(set(assets), {"triangles", 'say "шар" \\ ball', "veil", "lamp"})
        self.assertAlmostEqual(assets["triangles"], names["floor"] + names["fin"], delta=1e-4)

    def test_check_finds_what_is_wrong(self):
        # The check itself must be able to fail: a manifest of another scene, and mattes that are not the beauty's.
        self.render(*PASSES, "--float", output="a.exr")
        data = (self.folder / "a.exr").read_bytes()
        self.assertEqual(data.count(b'"fin":'), 1)
        (self.folder / "b.exr").write_bytes(data.replace(b'"fin":', b'"fan":'))
        self.assertIn("its hash says", self.read("b.exr", "--check", code=1))

    def test_a_matte_is_what_the_object_alone_covers(self):
        self.render(*PASSES, "--float", "--spp", "16")
        self.read("out.exr", "CryptoObject", "fin", "-o", "fin.pfm")
        header, _, rows = (self.folder / "fin.pfm").read_bytes().partition(b"-1.0\n")
        self.assertEqual(header, b"Pf\n48 32\n")
        self.assertEqual(len(rows), 48 * 32 * 4)
        self.read("out.exr", "CryptoObject", "no such thing", code=1)

    def test_bits_do_not_depend_on_threads_tiles_crop_or_other_passes(self):
        whole = self.render(*PASSES, "--threads", "1")
        self.assert_same_bits(whole, self.render(*PASSES, "--threads", "3", "--tile", "8", output="b.exr"))
        window = (10, 5, 30, 20)
        crop = self.render(*PASSES, "--crop", ",".join(map(str, window)), output="c.exr")
        self.assert_same_pixels(crop.pixels(), whole.pixels(window))
        plain = self.render("--aov", "beauty", output="d.exr").pixels()
        self.assert_same_pixels(plain, whole.pixels())

    def test_ids_are_float_and_others_keep_their_type(self):
        picture = self.render(*PASSES)
        for name, kind in picture.channels.items():
            self.assertEqual(kind, "float" if name.startswith("Crypto") else "half", name)
        self.assertEqual(sum(name.startswith("CryptoAsset") for name in picture.channels), 12)

    def test_sidecars_of_a_split_picture_stand_beside_their_files(self):
        self.expect(0, "render", "scene.toml", "-o", "s_<aov>.exr", *PASSES, "--exr", "split", "--crypto-manifest", "sidecar")
        self.assertIn("s_CryptoObject.exr", self.files())
        self.assertIn("s_CryptoObject.json", self.files())
        self.assertFalse([name for name in self.files() if "<" in name])
        picture = Exr(self.folder / "s_CryptoObject.exr")
        self.assertIn("s_CryptoObject.json", [picture.text(a) for a in picture.attributes if a.endswith("/manif_file")])

    def test_a_sidecar_holds_the_manifest_in_place_of_the_header(self):
        embedded = self.render(*PASSES)
        beside = self.render(*PASSES, "--crypto-manifest", "sidecar", output="beside.exr")
        self.assert_same_bits(embedded, beside)
        self.assertFalse([a for a in beside.attributes if a.endswith("/manifest")])
        files = {beside.text(a) for a in beside.attributes if a.endswith("/manif_file")}
        self.assertEqual(files, {f"beside.Crypto{kind}.json" for kind in ("Object", "Material", "Asset")})
        self.read("beside.exr", "--check")
        self.assertEqual(self.read("beside.exr"), self.read("out.exr"))
        self.expect(USAGE, "render", "scene.toml", "-o", "x.exr", "--crypto-manifest", "nowhere")

    def test_header_strings_are_the_specifications(self):
        picture = self.render(*PASSES)
        found = {}
        for name in picture.attributes:
            if name.startswith("cryptomatte/"):
                _, key, field = name.split("/")
                self.assertRegex(key, "^[0-9a-f]{7}$")
                found.setdefault(key, {})[field] = picture.text(name)
        self.assertEqual({f["name"] for f in found.values()}, {"CryptoObject", "CryptoMaterial", "CryptoAsset"})
        for fields in found.values():
            self.assertEqual(set(fields), {"name", "hash", "conversion", "manifest"})
            self.assertEqual((fields["hash"], fields["conversion"]), ("MurmurHash3_32", "uint32_to_float32"))


if __name__ == "__main__":
    unittest.main()
