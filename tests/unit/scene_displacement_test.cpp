// From the keys of a scene file, an image or an OBJ's library to a displaced mesh.

#include <doctest/doctest.h>

#include "renderer/scene/scene.h"
#include "tests/support/scene_folder.h"
#include "tests/support/tiff.h"

using namespace tessera;

namespace {

constexpr const char* kSheet =
    "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

// What a scene without light would be warned of.
constexpr const char* kLit = "[environment]\nradiance = 1\n";

const SubdivisionStatistics& only(const ScenePtr& scene) {
    REQUIRE(scene->statistics().subdivision.size() == 1);
    return scene->statistics().subdivision[0];
}

std::string mesh_keys(const std::string& keys) { return "[[mesh]]\nfile = 'sheet.obj'\n" + keys; }

}  // namespace

TEST_CASE("scene displacement: the keys of a mesh reach its description, a file by each way once") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    const SceneDesc s = folder.load(
        mesh_keys("name = 'a'\nsubdivision = 'catmull_clark'\nsubdivision_boundary = 'smooth'\n"
                  "subdivision_rate = 5\nsubdivision_max_rate = 9\n"
                  "subdivision_max_triangles = 77\n") +
        mesh_keys("name = 'b'\n") +
        mesh_keys("name = 'c'\nsubdivision = 'linear'\nedge_length = 0.25\n") +
        mesh_keys("name = 'd'\nsubdivision = 'linear'\nedge_length = 0.25\n") +
        mesh_keys("name = 'e'\n"));
    REQUIRE(s.meshes.size() == 3);
    const SubdivisionDesc& a = s.meshes[0].subdivision;
    CHECK(a.scheme == Subdivision::catmull_clark);
    CHECK(a.boundary == SubdivisionBoundary::smooth);
    CHECK(a.rate == 5);
    CHECK(a.max_rate == 9);
    CHECK(a.max_triangles == 77);
    CHECK(a.loc.line == 5);
    CHECK(s.meshes[1].subdivision.scheme == Subdivision::none);
    CHECK(s.meshes[2].subdivision.edge_length == 0.25);
    std::vector<int> used;
    for (const InstanceDesc& i : s.instances) used.push_back(i.of.index);
    CHECK(used == std::vector<int>{0, 1, 2, 2, 1});
}

TEST_CASE("scene displacement: keys that contradict each other or do nothing are told") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    CHECK(folder.failure(mesh_keys("subdivision = 'linear'\nsubdivision_rate = 4\n"
                                   "edge_length_px = 2\n")) ==
          "s.toml:6:1: mesh[0]: give subdivision_rate or edge_length_px, not both");
    CHECK(folder.failure(mesh_keys("subdivision = 'loop'\n"))
              .starts_with("s.toml:4:1: mesh[0]: subdivision is 'loop', must be 'none', 'linear' "
                           "or 'catmull_clark'"));
    CHECK(folder.failure(mesh_keys("subdivision = 'linear'\nsubdivision_rate = 0\n"))
              .starts_with("s.toml:5:1: mesh[0]: subdivision_rate is 0"));
    CHECK(folder.failure(mesh_keys("subdivision = 'linear'\nedge_length_px = -1\n"))
              .starts_with("s.toml:5:1: mesh[0]: edge_length_px is -1"));
    const SceneDesc s = folder.load(mesh_keys("edge_length_px = 2\n"));
    CHECK(contains(s.warnings,
                   "s.toml:4:1: mesh[0]: edge_length_px does nothing without "
                   "subdivision"));
}

TEST_CASE("scene displacement: one that moves too far is told at the key that says how far") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    const auto refusal = [&](const std::string& keys) {
        try {
            build_scene(folder.load(mesh_keys("subdivision = 'linear'\nmaterial = 'far'\n") +
                                    "[material.far]\nbase_color = 1\n" + keys));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string moved = ": material 'far': displacement moves mesh";
    CHECK(refusal("displacement = 1e6").find("/s.toml:8:1" + moved) != std::string::npos);
    CHECK(refusal("displacement = 1\ndisplacement_scale = 1e6").find("/s.toml:9:1" + moved) !=
          std::string::npos);
}

TEST_CASE("scene displacement: an image moves the surface by what it holds, raw, filtered") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    // 16 columns, the right half 200 / 255.
    std::vector<std::uint8_t> grey(16 * 4, 0);
    for (std::size_t i = 0; i < grey.size(); ++i)
        if (i % 16 >= 8) grey[i] = 200;
    write_tiff(folder.path("step.tif"), 16, 4, 1, 0, grey);
    const std::string material =
        std::string() +
        "material = 'm'\n[material.m]\ndisplacement = { file = 'step.tif', wrap = 'clamp' }\n"
        "displacement_scale = 0.5\ndisplacement_offset = -0.1\n" +
        kLit;
    const ScenePtr scene = build_scene(
        folder.load(mesh_keys("subdivision = 'linear'\nsubdivision_rate = 32\n" + material)));
    // Linear in the file's numbers: as a colour it would be 0.29, not 0.39.
    CHECK(only(scene).after[1][1] == doctest::Approx(0.5 * 200 / 255 - 0.1).epsilon(1e-4));
    CHECK(only(scene).after[0][1] == doctest::Approx(-0.1));
    CHECK(scene->statistics().warnings.empty());
    // A coarse sheet sees the mean of what lies between its vertices, not a point of it.
    const ScenePtr coarse = build_scene(
        folder.load(mesh_keys("subdivision = 'linear'\nsubdivision_rate = 1\n" + material)));
    CHECK(only(coarse).after[1][1] < 0.5 * 200 / 255 * 0.75 - 0.1);
    CHECK(only(coarse).after[1][1] > 0.5 * 200 / 255 * 0.25 - 0.1);
    // Displacement alone is no reason to load anything where nothing is subdivided.
    const ScenePtr flat = build_scene(folder.load(mesh_keys(material)));
    CHECK(flat->textures() == nullptr);
    CHECK(contains(flat->statistics().warnings, "material 'm' has displacement, which needs"));
}

TEST_CASE("scene displacement: graphs and layers drive it, vectors are read as data") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    const std::string mesh =
        mesh_keys("material = 'm'\nsubdivision = 'linear'\nsubdivision_rate = 8\n");
    const ScenePtr layered = build_scene(folder.load(
        mesh +
        "[material.m]\ndisplacement = { layers = [0.1, { value = 0.3, mask = 0.5 }] }\n"
        "[[material.m.layer]]\nmask = 0.5\nblend = 'add'\ndisplacement = { type = 'ramplr', "
        "valuel = 0, valuer = 1 }\n"));
    CHECK(only(layered).after[0][1] == doctest::Approx(0.2));
    CHECK(only(layered).after[1][1] == doctest::Approx(0.2 + 0.5));
    write_tiff(folder.path("v.tif"), 1, 1, 3, 0, std::vector<std::uint8_t>{0, 255, 128});
    for (const char* input : {"{ file = 'v.tif' }", "{ type = 'image', file = 'v.tif' }"}) {
        const ScenePtr moved =
            build_scene(folder.load(mesh + "[material.m]\nvector_displacement = " + input +
                                    "\ndisplacement_space = 'object'\n"));
        CHECK(only(moved).after[0][1] == doctest::Approx(1));
        CHECK(only(moved).after[0][2] == doctest::Approx(-1 + 128.0 / 255));
    }
    CHECK(folder.failure(mesh + "[material.m]\ndisplacement = { type = 'noise9d' }\n")
              .find("s.toml:8:18: material 'm': displacement: there is no node type 'noise9d'") ==
          0);
    CHECK(folder.failure(mesh + "[material.m]\ndisplacement_space = 'world'\n")
              .find("s.toml:8:1: material 'm': displacement_space is 'world'") == 0);
}

TEST_CASE("scene displacement: shading of a displaced mesh does not read its height map") {
    const SceneFolder folder;
    folder.write("sheet.obj", kSheet);
    const ScenePtr scene = build_scene(
        folder.load(mesh_keys("material = 'm'\nsubdivision = 'linear'\nsubdivision_rate = 8\n"
                              "[material.m]\ndisplacement = { type = 'noise2d' }\n")));
    CHECK_FALSE(scene->features().textures);
}

TEST_CASE("scene displacement: disp of an OBJ's library is for meshes that are subdivided") {
    const SceneFolder folder;
    folder.write("sheet.obj", std::string("mtllib m.mtl\nusemtl high\n") + kSheet);
    folder.write("m.mtl", "newmtl high\nKd 1 1 1\ndisp -mm 0.1 0.5 high.tif\n");
    write_tiff(folder.path("high.tif"), 1, 1, 1, 0, std::vector<std::uint8_t>{255});
    const ScenePtr moved = build_scene(
        folder.load(kLit + mesh_keys("subdivision = 'linear'\nsubdivision_rate = 2\n")));
    CHECK(only(moved).after[1][1] == doctest::Approx(0.6));
    CHECK(moved->statistics().warnings.empty());
    const ScenePtr still = build_scene(folder.load(mesh_keys("")));
    CHECK(contains(still->statistics().warnings,
                   "sheet.obj: mesh 'sheet': material 'high' has displacement, which needs"));
    const ScenePtr scaled = build_scene(
        folder.load(mesh_keys("subdivision = 'linear'\nsubdivision_rate = 2\n"
                              "[material.high]\ninherits = 'high'\ndisplacement_scale = 2\n")));
    CHECK(only(scaled).after[1][1] == doctest::Approx(1.2));
}
