"""What OpenEXR's own tools say of our files: channel types, codecs, parts, windows, attributes."""

import re

from still_life import ALL, GROUPS, LIGHT, StillLifeTest, command, main

CODECS = {
    "none": "none",
    "zips": "zip, individual scanlines",
    "zip": "zip, multi-scanline blocks",
    "piz": "piz",
    "dwaa": "dwa, small scanline blocks",
    "dwab": "dwa, medium scanline blocks",
}
DATA = ("--aov", "debug", "--aov", "denoise", "--aov", "lookdev")


class Part:
    """A part of exrheader's output: attributes as it prints them, channels as name -> 'half', 'float'."""

    def __init__(self, text):
        self.attributes = dict(re.findall(r"^(\S+) \(type \w+\): ?(.*)$", text, re.MULTILINE))
        bits = {"16-bit floating-point": "half", "32-bit floating-point": "float", "32-bit unsigned integer": "uint"}
        self.channels = {name: bits[kind] for name, kind in re.findall(r"^    (\S+), (.*), sampling 1 1$", text, re.MULTILINE)}

    def __getitem__(self, name):
        return self.attributes[name].strip('"')


STATISTICS = {"variance", "standard_error"}  # of beauty, but numbers


class OpenExr(StillLifeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        listing = cls.run_tool(*command("render", "--list-aovs"))
        cls.documented = dict(re.findall(r"^  (\w+) +((?:[A-Z] )+)", listing, re.MULTILINE))

    def parts(self, file):
        self.run_tool("exrinfo", "-s", file)  # strict: any irregularity is an error
        return [Part(text) for text in re.split(r"^ part \d+:$", self.run_tool("exrheader", file), flags=re.MULTILINE) if "(type" in text]

    def test_colour_is_half_and_data_is_float(self):
        self.render("all.exr", *ALL, *DATA)
        (picture,) = self.parts("all.exr")
        layers = {}
        for name, kind in picture.channels.items():
            layers.setdefault(name.rpartition(".")[0], {})[name.rpartition(".")[2]] = kind
        self.assertEqual(layers.pop(""), {"R": "half", "G": "half", "B": "half", "A": "half", "Z": "float"})
        for name in (*LIGHT, *GROUPS):
            self.assertEqual(layers.pop(name), {"R": "half", "G": "half", "B": "half"}, name)
        self.assertLessEqual({"N", "variance", "albedo"}, set(self.documented))  # else nothing is compared below
        for name, channels in layers.items():
            kind = "half" if "albedo" in name or name in LIGHT or set(channels) == set("RGB") and name not in STATISTICS else "float"
            self.assertEqual(set(channels.values()), {kind}, name)
            if name in self.documented:
                self.assertEqual(set(channels), set(self.documented[name].split()), name)
        self.assertLessEqual({"N", "P", "Pref", "Ng", "uv", "facing", "object_id", "variance", "sample_count", "CryptoAsset02"}, set(layers))

    def test_float_is_float_throughout(self):
        self.render("float.exr", *ALL, "--float")
        self.assertEqual(set(self.parts("float.exr")[0].channels.values()), {"float"})

    def test_no_name_is_longer_than_old_readers_take(self):
        self.render("names.exr", *ALL, *DATA)
        data = (self.folder / "names.exr").read_bytes()
        self.assertEqual(data[5] & 4, 0)  # the flag for names of more than 31 bytes
        (picture,) = self.parts("names.exr")
        self.assertLessEqual(max(map(len, (*picture.attributes, *picture.channels))), 31)

    def test_codecs_are_those_asked_for(self):
        for codec, said in CODECS.items():
            lossy = codec.startswith("dwa")
            self.render("codec.exr", "--compression", codec, *(["--aov", "beauty"] if lossy else ALL))
            (picture,) = self.parts("codec.exr")
            self.assertEqual(picture["compression"], said)
            self.assertEqual(picture["type"], "scanlineimage")
            self.assertEqual(picture["lineOrder"], "increasing y")

    def test_parts_are_named_for_their_layers_and_data_stays_lossless(self):
        self.render("parts.exr", *ALL, "--exr", "multipart", "--compression", "dwab")
        parts = {part["name"]: part for part in self.parts("parts.exr")}
        self.assertEqual(next(iter(parts)), "beauty")
        self.assertLessEqual({"depth", "N", "P", "albedo", "CryptoObject00", *LIGHT, *GROUPS}, set(parts))
        for name, part in parts.items():
            data = set(part.channels.values()) == {"float"}
            self.assertEqual(part["compression"], CODECS["zip" if data else "dwab"], name)
            for channel in part.channels:
                self.assertEqual(channel.rpartition(".")[0], "" if name == "beauty" else name)

    def test_split_files_say_what_they_were(self):
        self.render("s_<aov>.exr", *ALL, "--exr", "split")
        (picture,) = self.parts("s_N.exr")
        self.assertEqual(set(picture.channels), set("RGB"))
        self.assertEqual((picture["tessera/pass"], picture["tessera/channels"]), ("N", "X,Y,Z"))
        self.assertEqual(set(self.parts("s_beauty.exr")[0].channels), set("RGBA"))
        self.assertEqual(len(list(self.folder.glob("s_Crypto*.exr"))), 3)
        for file in self.folder.glob("s_*.exr"):
            (picture,) = self.parts(file.name)
            mattes = {picture[key] for key in picture.attributes if key.endswith("/name")}
            self.assertEqual(mattes, {file.stem[2:]} if "Crypto" in file.name else set(), file.name)

    def test_windows(self):
        for file, options, window in (("frame", (), "(0 0) - (95 53)"), ("crop", ("--crop", "16,8,64,48"), "(16 8) - (63 47)"),
                                      ("wide", ("--overscan", "8px"), "(-8 -8) - (103 61)")):
            self.render(f"{file}.exr", *options)
            (picture,) = self.parts(f"{file}.exr")
            self.assertEqual((picture["displayWindow"], picture["dataWindow"]), ("(0 0) - (95 53)", window))

    def test_header_says_what_made_it(self):
        self.render("all.exr", *ALL, "--seed", "7", "--set", "film.working_space=acescg")
        (picture,) = self.parts("all.exr")
        self.assertEqual((picture["tessera/colorSpace"], picture["tessera/seed"], picture["tessera/spp"]), ("acescg", "7", "4"))
        self.assertRegex(picture["capDate"], r"^\d{4}:\d\d:\d\d \d\d:\d\d:\d\d$")
        self.assertRegex(picture["tessera/sceneHash"], "^[0-9a-f]{16}$")
        self.assertIn("red   (0.713 0.293)", self.run_tool("exrheader", "all.exr"))
        types = {name for key, name in ((k, picture[k]) for k in picture.attributes if k.endswith("/name"))}
        self.assertEqual(types, {"CryptoObject", "CryptoMaterial", "CryptoAsset"})
        self.assertIn("bougie allumée", next(picture[k] for k in picture.attributes if k.endswith("/manifest")))


if __name__ == "__main__":
    main("exrheader", "exrinfo")
