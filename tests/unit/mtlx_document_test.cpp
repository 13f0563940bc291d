// MaterialX documents: how they come into a scene, and what is refused before any node is read.

#include <string>

#include "tests/support/mtlx_folder.h"

using namespace tessera;

namespace {

const std::string kRed = mtlx_surface("<input name='base_color' type='color3' value='0.5, 0, 0'/>");

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

}  // namespace

TEST_CASE("mtlx: a document's materials go by name to shapes, meshes and what inherits") {
    const MtlxFolder folder;
    folder.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    const SceneDesc scene = folder.load_mtlx(kRed, R"(
        [[mesh]]
        file = "two.obj"
        [[sphere]]
        material = "m"
        [material.dull]
        inherits = "m"
        specular_roughness = 1
    )");
    const int m = material_index(scene, "m");
    CHECK(scene.materials[m].base_color.value == Float3{0.5f, 0, 0});
    CHECK(scene.meshes[0].materials == std::vector<int>{m});
    CHECK(scene.spheres[0].material == m);
    CHECK(material(scene, "dull").base_color.value == Float3{0.5f, 0, 0});
    CHECK(material(scene, "dull").specular_roughness.value == 1);
    CHECK_FALSE(contains(scene.warnings, "'m'"));
    CHECK(contains(scene.files, "a.mtlx"));
}

TEST_CASE("mtlx: a document wins over an OBJ's library, and the scene over the document") {
    const MtlxFolder folder;
    folder.write("two.obj", kTwoMaterials);
    folder.write("two.mtl", kTwoMaterialsMtl);
    const std::string red = replaced(kRed, "name='m'", "name='red'");
    const std::string mesh = "[[mesh]]\nfile = 'two.obj'\n";
    const SceneDesc scene = folder.load_mtlx(replaced(red, "0.5, 0, 0", "0.1, 0, 0"), mesh);
    CHECK(material(scene, "red").base_color.value == Float3{0.1f, 0, 0});
    CHECK(material(scene, "blue").base_color.value[2] == 0.5f);
    CHECK(contains(scene.notes, "material 'red' replaces the one of the OBJ's library"));
    const SceneDesc changed =
        folder.load_mtlx(red, mesh + "[material.red]\ninherits = 'red'\nspecular_weight = 0.2");
    CHECK(material(changed, "red").base_color.value == Float3{0.5f, 0, 0});
    CHECK(material(changed, "red").specular_weight.value == 0.2f);
    const SceneDesc set = folder.load("materialx = ['a.mtlx']", {"material.red.base_color=0.3"});
    CHECK(material(set, "red").base_color.value == Float3{0.3f, 0.3f, 0.3f});
}

TEST_CASE("mtlx: documents of an included scene come first, each beside its own file") {
    const MtlxFolder folder;
    folder.write("sub/b.mtlx", replaced(kRed, "name='m'", "name='b'"));
    folder.write("sub/part.toml", "tessera = 1\nmaterialx = ['b.mtlx']\n");
    const SceneDesc scene = folder.load_mtlx(kRed, "include = ['sub/part.toml']");
    CHECK(material_index(scene, "b") >= 0);
    CHECK(material_index(scene, "m") >= 0);
}

TEST_CASE("mtlx: a document that is missing, outside or no list of texts is refused") {
    const MtlxFolder folder;
    CHECK(folder.failure("materialx = ['no.mtlx']")
              .starts_with("s.toml:2:14: materialx: file 'no.mtlx' not found (searched: "));
    CHECK(folder.failure("materialx = ['../../../etc/passwd']").find("outside") !=
          std::string::npos);
    CHECK(folder.failure("materialx = 'a.mtlx'") ==
          "s.toml:2:1: materialx is 'a.mtlx', must be texts in brackets");
    CHECK(folder.failure("materialx = [7]") == "s.toml:2:14: materialx[0] is 7, must be a text");
}

TEST_CASE("mtlx: XML that is cut off, mismatched or something else has a place") {
    const MtlxFolder folder;
    CHECK(folder.refusal(kRed.substr(0, 120)).starts_with("a.mtlx:"));
    CHECK(folder.refusal("<materialx>\n <a>\n </b>\n</materialx>") ==
          "a.mtlx:3:4: no valid XML: start-end tags mismatch");
    CHECK(folder.refusal("").starts_with("a.mtlx:1:1: no valid XML: "));
    CHECK(folder.refusal("{ \"json\": 1 }").starts_with("a.mtlx:1:"));
    CHECK(folder.refusal("<svg/>") ==
          "a.mtlx:1:1: the outermost element is 'svg', must be 'materialx'");
    std::string bytes;
    for (int i = 0; i < 2048; ++i) bytes += static_cast<char>(i);
    CHECK(folder.refusal(bytes).starts_with("a.mtlx:"));
}

TEST_CASE("mtlx: entities that multiply are refused, not expanded") {
    const MtlxFolder folder;
    const std::string laughs =
        "<?xml version='1.0'?>\n<!DOCTYPE lolz [\n<!ENTITY a 'ha'>\n<!ENTITY b '&a;&a;&a;&a;'>\n"
        "<!ENTITY c '&b;&b;&b;&b;'>\n]>\n<materialx>&c;</materialx>";
    CHECK(folder.refusal(laughs) ==
          "a.mtlx:1:1: a document type is not allowed in a MaterialX document");
}

TEST_CASE("mtlx: nesting and counts beyond reason are refused") {
    const MtlxFolder folder;
    std::string deep;
    for (int i = 0; i < 100'000; ++i) deep += "<a>";
    for (int i = 0; i < 100'000; ++i) deep += "</a>";
    CHECK(folder.refusal(mtlx(deep)) == "a.mtlx:3:193: elements nested deeper than 64");
    std::string many;
    for (int i = 0; i < 200'001; ++i) many += "<a/>\n";
    CHECK(folder.refusal(mtlx(many)).find("more than 200 000 elements") != std::string::npos);
    std::string wide = "<a ";
    for (int i = 0; i < 257; ++i) wide += "b" + std::to_string(i) + "='' ";
    CHECK(folder.refusal(mtlx(wide + "/>")) == "a.mtlx:3:1: more than 256 attributes");
}

TEST_CASE("mtlx: two of one name beside each other are refused, in one document or in two") {
    const MtlxFolder folder;
    const std::string twice =
        replaced(kRed, "</materialx>", "<open_pbr_surface name='s'/>\n</materialx>");
    CHECK(folder.refusal(twice) ==
          "a.mtlx:8:1: open_pbr_surface 's': the name stands for open_pbr_surface 's' already "
          "(a.mtlx:3:1)");
    CHECK(folder
              .refusal(mtlx_surface("<input name='base_weight' type='float' value='1'/>\n"
                                    "<input name='base_weight' type='float' value='1'/>"))
              .starts_with("a.mtlx:5:1: input 'base_weight': the name stands for"));
    folder.write("b.mtlx", kRed);
    folder.write("a.mtlx", kRed);
    CHECK(folder.failure("materialx = ['a.mtlx', 'b.mtlx']")
              .starts_with("b.mtlx:6:1: surfacematerial 'm': the name stands for another at "
                           "a.mtlx:6:1 already\n(--lenient leaves out"));
}

TEST_CASE("mtlx: documents include documents, but not themselves") {
    const MtlxFolder folder;
    folder.write("part.mtlx", mtlx("<nodegraph name='g'><constant name='c' type='color3'><input "
                                   "name='value' type='color3' value='0.2, 0.3, 0.4'/></constant>"
                                   "<output name='o' type='color3' nodename='c'/></nodegraph>"));
    const std::string whole =
        mtlx_surface("<input name='base_color' type='color3' nodegraph='g' output='o'/>",
                     "<xi:include href='part.mtlx'/>");
    CHECK(material(folder.load_mtlx(whole), "m").base_color.value == Float3{0.2f, 0.3f, 0.4f});
    CHECK(folder.refusal(mtlx("<xi:include href='a.mtlx'/>")).find("which includes this file") !=
          std::string::npos);
    CHECK(folder.refusal(mtlx("<xi:include href='gone.mtlx'/>"))
              .starts_with("a.mtlx:3:1: include: file 'gone.mtlx' not found"));
}

TEST_CASE("mtlx: a document without a material, and surfaces of other kinds, are refused") {
    const MtlxFolder folder;
    CHECK(folder.refusal(mtlx("<nodegraph name='g'/>")) ==
          "s.toml:2:14: materialx: 'a.mtlx' holds no surfacematerial");
    CHECK(folder.refusal(mtlx("")) == "s.toml:2:14: materialx: 'a.mtlx' holds no surfacematerial");
    CHECK(folder.refusal(mtlx_surface("", "", "gltf_pbr")) ==
          "a.mtlx:3:1: gltf_pbr 's': surface 'gltf_pbr' is not read, 'open_pbr_surface' and "
          "'standard_surface' are");
    CHECK(folder.refusal(replaced(kRed, "nodename='s'", "nodename='z'"))
              .starts_with("a.mtlx:6:43: input 'surfaceshader': there is no 'z'"));
    CHECK(folder.refusal(mtlx("<surfacematerial name='m' type='material'/>")) ==
          "a.mtlx:3:1: surfacematerial 'm': has no surfaceshader");
    const std::string displaced =
        replaced(kRed, "</surfacematerial>",
                 "\n<input name='displacementshader' type='displacementshader' nodename='d'/>"
                 "</surfacematerial>");
    CHECK(folder.refusal(displaced) ==
          "a.mtlx:7:1: surfacematerial 'm': displacementshader is not read, only surfaceshader is");
    const SceneDesc scene =
        folder.load_mtlx(replaced(kRed, "</materialx>", "<look name='l'/></materialx>"));
    CHECK(contains(scene.warnings, "look 'l' is not used"));
}

TEST_CASE("mtlx: lenient reading leaves out what is wrong and says so") {
    const MtlxFolder folder;
    const std::string text = mtlx_surface(
        "<input name='base_color' type='color3' value='0.5, 0, 0'/>\n"
        "<input name='no_such' type='float' value='1'/>\n"
        "<input name='specular_roughness' type='float' value='7'/>");
    CHECK(folder.refusal(text).find("no_such") != std::string::npos);
    const SceneDesc scene = folder.load_leniently(text);
    CHECK(material(scene, "m").base_color.value == Float3{0.5f, 0, 0});
    CHECK(material(scene, "m").specular_roughness.value == MaterialDesc{}.specular_roughness.value);
    CHECK(contains(scene.warnings, "no_such"));
    CHECK(contains(scene.warnings, "specular_roughness is 7"));
}

TEST_CASE("mtlx: materials as documents before 1.38 write them are read") {
    const MtlxFolder folder;
    const SceneDesc scene = folder.load_mtlx(
        "<materialx version='1.37'><nodegraph name='g'><constant name='c' type='color3'>"
        "<parameter name='value' type='color3' value='0.2, 0.3, 0.4'/></constant>"
        "<output name='o' type='color3' nodename='c'/></nodegraph>"
        "<material name='old'><shaderref name='r' node='standard_surface'>"
        "<bindinput name='base_color' type='color3' nodegraph='g' output='o'/>"
        "</shaderref></material></materialx>");
    CHECK(material(scene, "old").base_color.value == Float3{0.2f, 0.3f, 0.4f});
}
