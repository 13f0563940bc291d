// Textures as a scene file and an MTL write them: filters, frames, tiles.

#include <doctest/doctest.h>

#include "renderer/scene/scene.h"
#include "tests/support/scene_folder.h"
#include "tests/support/tiff.h"

using namespace tessera;

namespace {

void image(const SceneFolder& folder, const std::string& name) {
    write_tiff(folder.path(name), 1, 1, 1, 0, std::vector<std::uint8_t>{128});
}

std::string sphere_with(const std::string& color) {
    return "[environment]\n[[sphere]]\nmaterial = \"m\"\n[material.m]\nbase_color = " + color +
           "\n";
}

std::string stem(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

TEST_CASE("textures: a map that is missing is told with all materials that use it") {
    const SceneFolder folder;
    folder.write("t.obj", kTriangle);
    std::string text;
    for (const std::string name : {"oak", "ash", "elm"})
        text += "[[mesh]]\nfile = 't.obj'\nmaterial = '" + name + "'\n[material." + name +
                "]\nbase_color = { file = 'gone.png' }\n";
    const auto warnings = [&](const std::string& scene) {
        return build_scene(folder.load(scene))->statistics().warnings;
    };
    const auto all = warnings(text);
    CHECK(contains(all, "gone.png"));
    CHECK(contains(all, "(of materials 'ash', 'elm' and 'oak'); magenta in its place"));
    // Only of one: its place says which.
    const auto one = warnings(text.substr(0, text.find("[[mesh]]", 1)));
    CHECK(contains(one, "gone.png"));
    CHECK_FALSE(contains(one, "of materials"));
}

TEST_CASE("scene textures: filter is read for inputs, normal maps and image nodes") {
    const SceneFolder folder;
    image(folder, "a.tif");
    const std::pair<const char*, TextureFilter> words[] = {
        {"trilinear", TextureFilter::trilinear},
        {"closest", TextureFilter::closest},
        {"bilinear", TextureFilter::bilinear},
        {"bicubic", TextureFilter::bicubic},
        {"stochastic", TextureFilter::stochastic}};
    for (const auto& [word, filter] : words) {
        const std::string f = std::string(", filter = \"") + word + "\"";
        const SceneDesc scene = folder.load(
            sphere_with("{ file = \"a.tif\"" + f + " }") +
            "specular_roughness = { file = \"a.tif\"" + f +
            ", scale = 2 }\ngeometry_normal = { file = \"a.tif\"" + f + ", scale = 3 }\n" +
            "coat_weight = { type = \"image\", file = \"a.tif\", wrap = \"clamp\"" + f + " }\n");
        REQUIRE(scene.textures.size() == 4);
        for (const TextureDesc& t : scene.textures) CHECK(t.filter == filter);
    }
    // Textures that differ in their filter alone are two.
    CHECK(folder
              .load(sphere_with("{ file = \"a.tif\" }") +
                    "specular_roughness = { file = \"a.tif\", filter = \"closest\" }\n")
              .textures.size() == 2);
    CHECK(folder.failure(sphere_with("{ file = \"a.tif\", filter = \"cubic\" }"))
              .starts_with("s.toml:6:32: material 'm': base_color: filter is 'cubic', must be "));
}

TEST_CASE("scene textures: a sequence follows [render] frame and its own offset") {
    const SceneFolder folder;
    for (const char* name : {"a.0001.tif", "a.0004.tif", "a.0014.tif"}) image(folder, name);
    const std::string scene = sphere_with("{ file = \"a.####.tif\" }");
    CHECK(stem(folder.load(scene).textures[0].file) == "a.0001.tif");
    CHECK(stem(folder.load(scene, {"render.frame=4"}).textures[0].file) == "a.0004.tif");
    CHECK(stem(folder
                   .load(sphere_with("{ file = \"a.%04d.tif\", frame_offset = 10 }") +
                         "[render]\nframe = 4\n")
                   .textures[0]
                   .file) == "a.0014.tif");
    CHECK(
        stem(folder
                 .load(sphere_with("{ type = \"image\", file = \"a.<F4>.tif\", frame_offset = 3 }"))
                 .textures[0]
                 .file) == "a.0004.tif");
}

TEST_CASE("scene textures: a missing frame is a located error that names it and its neighbours") {
    const SceneFolder folder;
    for (const char* name : {"a.0001.tif", "a.0002.tif", "a.0009.tif"}) image(folder, name);
    const std::string scene = sphere_with("{ file = \"a.####.tif\" }");
    CHECK(folder.failure(scene, {"render.frame=5"})
              .starts_with("s.toml:6:16: material 'm': texture 'a.0005.tif' is missing (there are "
                           "frames 1-2, 9)"));
    CHECK(folder.failure("[environment]\nfile = \"sky.%d.exr\"\n") ==
          "s.toml:3:1: environment: file 'sky.1.exr' is missing, and so is every other frame");
    CHECK(folder.failure(scene, {"render.frame=0.5"}).find("whole number") != std::string::npos);
}

TEST_CASE("scene textures: an environment may be a frame of a sequence, not a set of tiles") {
    const SceneFolder folder;
    image(folder, "sky.0003.tif");
    image(folder, "set.1001.tif");
    const SceneDesc scene =
        folder.load("[environment]\nfile = \"sky.####.tif\"\n[render]\nframe = 3\n");
    CHECK(stem(scene.environment->file) == "sky.0003.tif");
    CHECK(folder.failure("[environment]\nfile = \"set.<UDIM>.tif\"\n").find("is a set of tiles") !=
          std::string::npos);
}

TEST_CASE("scene textures: a set of tiles is found beside the scene, also from an MTL") {
    const SceneFolder folder;
    image(folder, "a.1001.tif");
    image(folder, "a.1012.tif");
    folder.write("m.obj",
                 "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl x\nf 1/1 2/1 3/1\n");
    folder.write("m.mtl",
                 "newmtl x\nKd 1 1 1\nmap_Kd a.<UDIM>.tif\nmap_Ks b.%04d.tif\nKs 0.5 0.5 0.5\n");
    image(folder, "b.0002.tif");
    const SceneDesc scene =
        folder.load(sphere_with("{ file = \"a.<UDIM>.tif\" }") + "[[mesh]]\nfile = \"m.obj\"\n",
                    {"render.frame=2"});
    int sets = 0, frames = 0;
    for (const TextureDesc& t : scene.textures) {
        frames += stem(t.file) == "b.0002.tif";
        if (t.tiles.empty()) continue;
        ++sets;
        REQUIRE(t.tiles.size() == 2);
        CHECK(t.tiles[1].column == 1);
        CHECK(t.tiles[1].row == 1);
        CHECK(stem(t.tiles[1].file) == "a.1012.tif");
    }
    CHECK(sets >= 1);
    CHECK(frames == 1);
}
