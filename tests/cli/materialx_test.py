"""MaterialX documents from outside: a picture equal to that of the same material in TOML, and broken ones refused."""

import unittest

from support import SCENE, SCENE_TOML, SLOWDOWN, TesseraTest

DOCUMENT = """\
    <?xml version="1.0"?>
    <materialx version="1.39" colorspace="lin_rec709">
      <nodegraph name="paint">
        <input name="tint" type="color3" value="0.7, 0.1, 0.05"/>
        <position name="place" type="vector3"/>
        <multiply name="fine" type="vector3">
          <input name="in1" type="vector3" nodename="place"/>
          <input name="in2" type="float" value="5"/>
        </multiply>
        <noise3d name="noise" type="float">
          <input name="position" type="vector3" nodename="fine"/>
          <input name="pivot" type="float" value="0.5"/>
        </noise3d>
        <mix name="blend" type="color3">
          <input name="fg" type="color3" interfacename="tint"/>
          <input name="bg" type="color3" value="0.1, 0.2, 0.6"/>
          <input name="mix" type="float" nodename="noise"/>
        </mix>
        <output name="color" type="color3" nodename="blend"/>
        <output name="roughness" type="float" nodename="noise"/>
      </nodegraph>
      <open_pbr_surface name="surface" type="surfaceshader">
        <input name="base_color" type="color3" nodegraph="paint" output="color"/>
        <input name="specular_roughness" type="float" nodegraph="paint" output="roughness"/>
        <input name="coat_weight" type="float" value="0.5"/>
      </open_pbr_surface>
      <surfacematerial name="red" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="surface"/>
      </surfacematerial>
    </materialx>
    """
TOML = """\
    [material.red]
    base_color = { type = "mix", fg = [0.7, 0.1, 0.05], bg = [0.1, 0.2, 0.6], mix = { node = "noise" } }
    specular_roughness = { node = "noise" }
    coat_weight = 0.5
    [material.red.node.noise]
    type = "noise3d"
    pivot = 0.5
    position = { type = "multiply", in1 = { type = "position" }, in2 = 5 }
    """


class MaterialX(TesseraTest):
    def use(self, document):
        self.write_scene(SCENE_TOML.replace("tessera = 1", 'tessera = 1\n    materialx = ["looks.mtlx"]'))
        self.write("looks.mtlx", document)

    def refuse(self, document, *words):
        self.use(document)
        run = self.run_program("render", "scene.toml", "-o", "out.exr", "--res", "24x16", "--spp", "1")
        self.assertEqual(run.code, SCENE, run)
        self.assertLess(run.seconds, 10 * SLOWDOWN)
        self.assertNotIn("out.exr", self.files())
        for word in words:
            self.assertIn(word, run.err)
        return run

    def test_a_document_gives_the_picture_of_the_same_material_in_toml(self):
        self.use(DOCUMENT)
        document = self.render("--float", output="document.exr")
        self.write_scene(SCENE_TOML + TOML)
        self.assert_same_bits(document, self.render("--float"))
        # And the material is seen at all.
        self.write_scene()
        self.assertNotEqual(document.pixels(), self.render("--float", output="plain.exr").pixels())

    def test_broken_documents_are_refused_with_their_place(self):
        self.refuse("", "looks.mtlx:1:1:")
        self.refuse(DOCUMENT[: len(DOCUMENT) // 2], "looks.mtlx:")
        self.refuse(bytes(range(256)) * 64, "looks.mtlx:")
        self.refuse(DOCUMENT.replace("noise3d", "noise4d"), "looks.mtlx:10:5:", "noise4d", "did you mean 'noise")
        self.refuse(DOCUMENT.replace('value="5"', 'value="five"'), "looks.mtlx:8:7:", "five")
        self.refuse(DOCUMENT.replace('nodename="place"', 'nodename="fine"'), "looks.mtlx:7:7:", "circle")
        self.refuse(DOCUMENT.replace("open_pbr_surface", "gltf_pbr"), "looks.mtlx:", "gltf_pbr")
        self.refuse(DOCUMENT.replace('type="float" value="0.5"/>\n      </open', 'type="float" value="7"/>\n      </open'),
                    "coat_weight is 7")

    def test_laughing_entities_and_deep_elements_are_refused_at_once(self):
        entities = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 20))
        self.refuse(f'<?xml version="1.0"?><!DOCTYPE m [<!ENTITY e0 "ha">{entities}]><materialx>&e19;</materialx>',
                    "looks.mtlx:1:1:")
        self.refuse("<materialx>" + "<a>" * 1_000_000 + "</a>" * 1_000_000 + "</materialx>", "deeper than 64")

    def test_lenient_renders_the_rest(self):
        self.use(DOCUMENT.replace("coat_weight", "coat_wieght"))
        run = self.expect(0, "render", "scene.toml", "-o", "out.exr", "--res", "24x16", "--spp", "1", "--lenient")
        self.assertIn("coat_wieght", run.err)


if __name__ == "__main__":
    unittest.main()
