"""The Python readers (standard library only): sums of passes and groups, mattes by name, a grade of one object."""

from read_cryptomatte import File, check, id_of
from still_life import ALL, FLOAT_TOLERANCE, GROUPS, HALF_FLOOR, HALF_TOLERANCE, LIGHT, StillLifeTest, main

LAYOUTS = {"zip": (), "zips": ("--compression", "zips"), "none": ("--compression", "none")}


class Reader(StillLifeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.render("float.exr", *ALL, "--float")

    def sum_of(self, file, layers):
        planes = [self.colours(file, name) for name in layers]
        return [[sum(values) for values in zip(*(plane[c] for plane in planes))] for c in range(3)]

    def test_passes_and_groups_add_up_to_beauty(self):
        file = File(self.folder / "float.exr")
        for layers in (LIGHT, GROUPS):
            # Added here in double: what is left is each pass's own rounding to float.
            self.assert_near(self.sum_of(file, layers), self.colours(file), 1e-6, 1e-9)

    def test_half_files_of_every_codec_add_up(self):
        for codec, options in LAYOUTS.items():
            self.render("half.exr", *ALL, *options)
            file = File(self.folder / "half.exr")
            self.assertEqual(file.compression, codec)
            for layers in (LIGHT, GROUPS):
                self.assert_near(self.sum_of(file, layers), self.colours(file), HALF_TOLERANCE, HALF_FLOOR, codec)

    def test_half_is_float_rounded(self):
        self.render("half.exr", *ALL)
        exact, rounded = File(self.folder / "float.exr"), File(self.folder / "half.exr")
        for layer in ("", *LIGHT, *GROUPS):
            if max(map(max, self.colours(exact, layer))) > 0:
                self.assert_near(self.colours(rounded, layer), self.colours(exact, layer), 2**-11, 2**-25, layer)

    def test_mattes_add_up_to_alpha_in_every_codec(self):
        for codec, options in LAYOUTS.items():
            self.render("mattes.exr", *ALL, *options)
            file = File(self.folder / "mattes.exr")
            mattes = file.cryptomattes()
            self.assertEqual(set(mattes), {"CryptoObject", "CryptoMaterial", "CryptoAsset"})
            for kind, matte in mattes.items():
                self.assertEqual(check(file, matte, 1e-6), [], f"{codec} {kind}")

    def test_light_through_mattes_is_all_light(self):
        # Everything that is seen has a name: the mattes part beauty without a rest.
        file = File(self.folder / "float.exr")
        matte = file.cryptomattes()["CryptoObject"]
        beauty = self.colours(file)
        parts = [[0.0] * len(beauty[0]) for _ in range(3)]
        for name in matte.manifest:
            coverage = matte.matte(id_of(name))
            for part, plane in zip(parts, beauty):
                for i, covered in enumerate(coverage):
                    part[i] += covered * plane[i]
        self.assert_near(parts, beauty, FLOAT_TOLERANCE)


if __name__ == "__main__":
    main()
