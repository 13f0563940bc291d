// What load_scene puts together: includes, --set, a bare OBJ; the schema and the documentation.

#include <doctest/doctest.h>

#include <cstring>
#include <sstream>

#include "renderer/io/schema.h"
#include "tests/support/scene_folder.h"

using namespace tessera;
namespace fs = std::filesystem;

TEST_CASE("include: the including file wins key by key, tables in brackets are joined") {
    const SceneFolder folder;
    folder.write("lib/base.toml",
                 "[camera]\nfov_deg = 20\naperture_radius = 1\n[[sphere]]\nname = 'a'\n"
                 "[material.m]\nbase_color = { file = 'in_lib.png' }");
    folder.write("lib/in_lib.png", "x");
    const SceneDesc scene = folder.load(
        "include = ['lib/base.toml']\n[camera]\nfov_deg = 30\n[[sphere]]\nname = 'b'\nmaterial = "
        "'m'");
    CHECK(scene.camera.fov_deg == 30);
    CHECK(scene.camera.aperture_radius == 1);
    REQUIRE(scene.spheres.size() == 2);
    CHECK(scene.spheres[0].name == "a");
    CHECK(scene.textures.at(0).file.find("in_lib.png") !=
          std::string::npos);  // relative to its own file
    CHECK(scene.files.size() == 2);
}

TEST_CASE("include: circles, depth and wrong files are errors, a file met twice counts once") {
    const SceneFolder folder;
    folder.write("loop.toml", "include = ['s.toml']");
    CHECK(folder.failure("include = ['loop.toml']").find("which includes this file") !=
          std::string::npos);
    for (int i = 0; i < 20; ++i) {
        folder.write("d" + std::to_string(i) + ".toml",
                     "include = ['d" + std::to_string(i + 1) + ".toml']");
    }
    CHECK(folder.failure("include = ['d0.toml']").find("includes nested deeper than 16") !=
          std::string::npos);
    CHECK(folder.failure("include = ['none.toml']")
              .find("s.toml:2:12: include: file 'none.toml' not found") == 0);
    CHECK(folder.failure("include = 3") == "s.toml:2:1: include is 3, must be texts in brackets");
    folder.write("ball.toml", "[[sphere]]\nname = 'ball'");
    folder.write("left.toml", "include = ['ball.toml']");
    CHECK(folder.load("include = ['left.toml', 'ball.toml']").spheres.size() == 1);
    folder.write("bad.toml", "\n[camera]\nfov_deg = 0");
    CHECK(folder.failure("include = ['bad.toml']") ==
          "bad.toml:3:1: camera: fov_deg is 0, must be in (0, 180)");
}

TEST_CASE("set: reaches keys, names in lists, numbers in lists and new tables") {
    const SceneFolder folder;
    const SceneDesc scene =
        folder.load(std::string(kLight) + "[material.\"a.b\"]\n",
                    {"camera.fov_deg=35", "film.resolution=[8, 4]", "film.filter=box",
                     "light.key.intensity=[1, 2, 3]", "light[0].visible=false",
                     "material.\"a.b\".base_color=0.25", "environment.radiance=2"});
    CHECK(scene.camera.fov_deg == 35);
    CHECK(scene.film.width == 8);
    CHECK(scene.film.filter == PixelFilter::box);
    CHECK(std::get<PointLightDesc>(scene.lights[0].shape).intensity == Float3{1, 2, 3});
    CHECK_FALSE(scene.lights[0].visible);
    CHECK(material(scene, "a.b").base_color.value[0] == 0.25f);
    CHECK(scene.environment->radiance == Float3{2, 2, 2});
}

TEST_CASE("set: an error is located at the option") {
    const SceneFolder folder;
    CHECK(folder.failure("", {"camera.fov_deg=190"}) ==
          "--set camera.fov_deg=190: camera: fov_deg is 190, must be in (0, 180)");
    CHECK(folder.failure("", {"camera.fov=30"}) ==
          "--set camera.fov=30: camera: unknown key 'fov' (did you mean 'fov_deg'?)");
    CHECK(folder.failure(kLight, {"light.kye.visible=true"}) ==
          "--set light.kye.visible=true: there is no light.kye (did you mean 'key'?)");
    CHECK(folder.failure(kLight, {"light[1].visible=true"}) ==
          "--set light[1].visible=true: there is no light[1] (1 of them, counted from 0)");
    CHECK(folder.failure("", {"light.key.visible=true"}) ==
          "--set light.key.visible=true: the scene has no [[light]]");
    CHECK(folder.failure("[material.floor]", {"material.flor.base_color=1"}) ==
          "--set material.flor.base_color=1: there is no material 'flor' (did you mean 'floor'?)");
    CHECK(folder.failure("[material.floor]", {"material.flor.inherits=\"flor\""}) ==
          "--set material.flor.inherits=\"flor\": there is no material 'flor' (did you mean "
          "'floor'?)");
    CHECK(folder.failure("[material.floor]\ninherits = 'floor'") ==
          "s.toml:3:1: material 'floor': there is no material 'floor' to inherit from");
}

TEST_CASE("set: what is no assignment is a usage error") {
    const SceneFolder folder;
    const std::string path = folder.write("s.toml", "tessera = 1\n");
    const std::string deep = "a" + [] {
        std::string text;
        for (int i = 0; i < 100000; ++i) text += ".a";
        return text;
    }() + "=1";
    for (const std::string& set :
         {std::string("fov"), std::string("=3"), std::string(".=3"), std::string("a..b=3"),
          std::string("a[=3"), std::string("a[x]=3"), std::string("a[99999999999]=3"),
          std::string("\"a=3"), std::string("camera.fov_deg="), std::string("camera.fov_deg=[1,"),
          std::string("camera.fov_deg=1\nx=2"), std::string("include=[]"), deep}) {
        CAPTURE(set.substr(0, 40));
        try {
            load_scene(path, {.set = {set}});
            FAIL("accepted");
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::usage);
        }
    }
}

TEST_CASE("bare obj: has an automatic camera, a neutral sky and a note") {
    const SceneFolder folder;
    const SceneDesc scene = load_scene(folder.write("one.obj", kTriangle));
    CHECK(scene.camera.automatic);
    CHECK(scene.meshes.size() == 1);
    REQUIRE(scene.instances.size() == 1);
    REQUIRE(scene.environment);
    CHECK(scene.environment->radiance == Float3{0.5f, 0.5f, 0.5f});
    CHECK(scene.lights.size() == 1);
    CHECK(contains(scene.notes, "lit by a neutral sky"));
    CHECK(contains(scene.files, "one.obj"));
}

TEST_CASE("bare obj: set changes its materials and its settings") {
    const SceneFolder folder;
    folder.write("two.mtl", kTwoMaterialsMtl);
    const std::string path = folder.write("two.obj", kTwoMaterials);
    const SceneDesc scene =
        load_scene(path, {.set = {"material.red.specular_roughness=0.75",
                                  "material.blue.emission_luminance=3", "render.spp=2"}});
    CHECK(material(scene, "red").specular_roughness.value == 0.75f);
    CHECK(material(scene, "red").base_color.value == Float3{0.5f, 0, 0});  // the rest of it stays
    CHECK(scene.render.spp == 2);
    CHECK_FALSE(scene.environment);  // blue emits: no sky is needed
}

TEST_CASE("load scene: what is no scene file is refused with the right code") {
    const SceneFolder folder;
    const auto code = [](const std::string& path) {
        try {
            load_scene(path);
        } catch (const Error& error) {
            return error.code();
        }
        return ExitCode::done;
    };
    CHECK(code(folder.write("a.abj", "")) == ExitCode::usage);
    CHECK(code(folder.write("b.toml", "")) == ExitCode::scene);  // no version
    CHECK(code(folder.write("c.toml", "tessera = 2")) == ExitCode::scene);
    CHECK(code("/nowhere/d.toml") == ExitCode::scene);
    CHECK(code("/nowhere/d.obj") == ExitCode::scene);
    CHECK(code(fs::path(folder.write("e.toml/x", "")).parent_path().string()) ==
          ExitCode::scene);  // a folder
    std::string junk;
    for (int i = 0; i < 5000; ++i) junk += static_cast<char>((i * 7919) >> 3);
    CHECK(code(folder.write("f.toml", junk)) == ExitCode::scene);
}

TEST_CASE("bad scenes: each ends in the message that its first line expects") {
    const std::string folder = std::string(TESSERA_SOURCE_DIR) + "/tests/bad_scenes/toml";
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        std::ifstream in(entry.path());
        std::string expected;
        std::getline(in, expected);
        REQUIRE(expected.starts_with("# expect: "));
        expected.erase(0, std::strlen("# expect: "));
        std::string message;
        try {
            load_scene(entry.path().string());
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::scene);
            message = error.what();
        }
        CAPTURE(message);
        CHECK(message.find(expected) != std::string::npos);
    }
    CHECK(scenes > 10);
}

TEST_CASE("load scene: up to 20 problems are reported together") {
    const SceneFolder folder;
    std::string text;
    for (int i = 0; i < 30; ++i) text += "[[sphere]]\nradius = -1\n";
    const std::string message = folder.failure(text);
    CHECK(std::count(message.begin(), message.end(), '\n') == Problems::kMax - 1);
}

TEST_CASE("schema: the file in docs is what the reader's own rows say") {
    std::ifstream in(std::string(TESSERA_SOURCE_DIR) + "/docs/scene.schema.json");
    std::stringstream text;
    text << in.rdbuf();
    CHECK(text.str() == scene_schema_json());
}

TEST_CASE("docs: the examples of the scene format, put together, are one scene without a warning") {
    std::ifstream in(std::string(TESSERA_SOURCE_DIR) + "/docs/scene-format.md");
    std::string scene;
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("```")) {
            inside = line == "```toml";
        } else if (inside) {
            scene += line + "\n";
        }
    }
    const SceneFolder folder;
    folder.write("materials.toml", "[material.glass]\ntransmission_weight = 1\n");
    for (const char* mesh : {"car.obj", "wall.obj"}) folder.write(mesh, kTriangle);
    for (const char* image : {"sky.exr", "tiles.png", "tiles_normal.png"}) folder.write(image, "x");
    const std::vector<float> row{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    std::string bytes(row.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), row.data(), bytes.size());
    folder.write("parking.f32", bytes);
    const SceneDesc loaded = load_scene(folder.write("doc.toml", scene));
    CHECK(loaded.warnings.empty());
    CHECK(loaded.instances.size() == 4);  // the wall, the disc, the row, the balls
    CHECK(loaded.lights.size() == 2);
    CHECK(material(loaded, "lamp").specular_roughness.texture >= 0);
}
