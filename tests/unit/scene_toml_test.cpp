#include "renderer/io/scene_toml.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "tests/support/scene_folder.h"

using namespace tessera;
namespace fs = std::filesystem;

TEST_CASE("scene toml: the camera frames by itself until it is placed") {
    const SceneFolder folder;
    CHECK(folder.load("").camera.automatic);
    const SceneDesc wide = folder.load("[camera]\nfov_deg = 70");
    CHECK(wide.camera.automatic);
    CHECK(wide.camera.fov_deg == 70);
    CHECK_FALSE(folder.load("[camera]\nposition = [0, 1, 4]").camera.automatic);
    CHECK_FALSE(folder.load("[camera]\nlook_at = [0, 1, 0]").camera.automatic);
    CHECK_FALSE(folder.load("[camera]\nmatrix = [[1,0,0,0],[0,1,0,0],[0,0,1,5]]").camera.automatic);
}

TEST_CASE("scene toml: a camera that cannot see is refused") {
    const SceneFolder folder;
    CHECK(folder.failure("[camera]\nposition = [0, 0, 0]\nlook_at = [0, 0, 0]") ==
          "s.toml:2:1: camera: position and look_at are the same point");
    CHECK(folder.failure("[camera]\nposition = [0, 5, 0]\nup = [0, 2, 0]") ==
          "s.toml:2:1: camera: up is parallel to the line of sight, give another up");
    CHECK(folder.failure("[camera]\nmatrix = [[1,0,0,0],[0,1,0,0],[1,1,0,0]]") ==
          "s.toml:3:1: camera: matrix is flat, its first 3 columns span no space");
    CHECK(folder.failure("[camera]\nmatrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\nup = [0, 0, 1]") ==
          "s.toml:4:1: camera: give matrix or up, not both");
}

TEST_CASE("scene toml: a camera straight above chooses another up by itself") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load("[camera]\nposition = [0, 5, 0]\nlook_at = [0, 0, 0]");
    CHECK(scene.camera.up == Double3{0, 0, -1});
}

TEST_CASE("scene toml: film and render reach the description") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(R"(
        [film]
        resolution = [64, 32]
        crop = [0, 8, 64, 32]
        filter = "gaussian"
        working_space = "acescg"
        aovs = ["Z", "albedo"]
        [render]
        integrator = "whitted"
        spp = 7
        seed = 9007199254740993
        max_depth = 0
    )");
    CHECK(scene.film.width == 64);
    CHECK(scene.film.height == 32);
    CHECK(scene.film.crop == PixelWindow{0, 8, 64, 32});
    CHECK(scene.film.filter == PixelFilter::gaussian);
    CHECK(scene.film.working_space == "acescg");
    CHECK(scene.film.aovs == std::vector<std::string>{"Z", "albedo"});
    CHECK(scene.render.integrator == Integrator::whitted);
    CHECK(scene.render.spp == 7);
    CHECK(scene.render.seed == 9007199254740993u);  // 2^53 + 1: no double on the way
    CHECK(scene.render.max_depth == 0);
}

TEST_CASE("scene toml: a crop must lie in the frame and hold a pixel") {
    const SceneFolder folder;
    const std::string wrong =
        "film: crop must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1, inside 64 x 32";
    for (const char* crop : {"[0, 0, 65, 32]", "[8, 8, 8, 9]", "[9, 0, 8, 4]"}) {
        CHECK(folder.failure("[film]\nresolution = [64, 32]\ncrop = " + std::string(crop)) ==
              "s.toml:4:1: " + wrong);
    }
    CHECK(folder.failure("[film]\nresolution = [65536, 65536]") ==
          "s.toml:3:1: film: resolution is 65536 x 65536, must be at most 2^30 pixels in all");
}

TEST_CASE("scene toml: the environment multiplies radiance and scale, and its file must exist") {
    const SceneFolder folder;
    const SceneDesc scene =
        folder.load("[environment]\nradiance = [1, 2, 3]\nscale = 2\nvisible = false");
    REQUIRE(scene.environment);
    CHECK(scene.environment->radiance == Float3{2, 4, 6});
    CHECK_FALSE(scene.environment->visible);
    CHECK(folder.failure("[environment]\nfile = 'sky.exr'")
              .starts_with("s.toml:3:1: environment: file 'sky.exr' not found"));
    folder.write("maps/sky.exr", "x");
    CHECK(fs::path(folder.load("[environment]\nfile = 'maps/sky.exr'").environment->file)
              .filename() == "sky.exr");
}

TEST_CASE("scene toml: a transform scales, then turns about x, y, z, then moves") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[[sphere]]\nscale = [2, 3, 4]\nrotate_deg = [90, 0, 90]\ntranslate = [10, 20, 30]");
    REQUIRE(scene.instances.size() == 1);
    // x -> 2x -> (about x) 2x -> (about z) 2y; y -> 3y -> 3z -> 3z; z -> 4z -> -4y -> 4x. Exact:
    // quarter turns are.
    CHECK(scene.instances[0].transforms[0] == Matrix34{0, 0, 4, 10, 2, 0, 0, 20, 0, 3, 0, 30});
}

TEST_CASE("scene toml: a shape that nothing refers to stands once at its own transform") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[[sphere]]\nname = 'a'\ntranslate = [1, 0, 0]\n[[disc]]\nname = 'b'\n"
        "[[instance]]\nof = 'b'\ntranslate = [0, 5, 0]");
    REQUIRE(scene.instances.size() == 2);
    CHECK(scene.instances[0].name == "a");
    CHECK(scene.instances[0].of.kind == ShapeKind::sphere);
    CHECK(scene.instances[0].transforms[0][3] == 1);
    CHECK(scene.instances[1].of.kind == ShapeKind::disc);
    CHECK(scene.instances[1].transforms[0][7] == 5);
}

TEST_CASE("scene toml: an instance's transform goes over the shape's own") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[[sphere]]\nname = 'a'\nscale = 2\ntranslate = [1, 0, 0]\n"
        "[[instance]]\nof = 'a'\nscale = 10");
    CHECK(scene.instances[0].transforms[0] == Matrix34{20, 0, 0, 10, 0, 20, 0, 0, 0, 0, 20, 0});
}

TEST_CASE("scene toml: groups nest, and one may name what stands below it") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(R"(
        [[group]]
        name = "row"
        members = [{ of = "pair" }, { of = "pair", translate = [4, 0, 0] }]
        [[group]]
        name = "pair"
        members = [{ of = "ball" }, { of = "ball", translate = [2, 0, 0], material = "red" }]
        [[sphere]]
        name = "ball"
        [material.red]
    )");
    REQUIRE(scene.groups.size() == 2);
    CHECK(scene.groups[0].members[1].of.kind == ShapeKind::group);
    CHECK(scene.groups[0].members[1].of.index == 1);
    CHECK(scene.groups[1].members[1].material == material_index(scene, "red"));
    REQUIRE(scene.instances.size() == 1);  // 'row': the rest is inside it
    CHECK(scene.instances[0].of.kind == ShapeKind::group);
    CHECK(scene.instances[0].of.index == 0);
}

TEST_CASE("scene toml: names that are wrong, twice there or in a circle are located errors") {
    const SceneFolder folder;
    CHECK(folder.failure("[[sphere]]\nname = 'ball'\n[[instance]]\nof = 'bal'") ==
          "s.toml:5:1: instance[0]: there is no shape 'bal' (did you mean 'ball'?)");
    CHECK(folder.failure("[[sphere]]\nname = 'ball'\n[[disc]]\nname = 'ball'") ==
          "s.toml:4:1: the name 'ball' is taken (at s.toml:2:1)");
    CHECK(folder.failure("[[sphere]]\nmaterial = 'oka'\n[material.oak]") ==
          "s.toml:3:1: sphere[0]: there is no material 'oka' (did you mean 'oak'?)");
    CHECK(folder.failure("[[group]]\nname = 'a'\nmembers = [{ of = 'b' }]\n[[group]]\nname = "
                         "'b'\nmembers = [{ of = 'a' }]") ==
          "s.toml:2:1: group 'a' contains itself (a > b > a)");
    CHECK(folder.failure(std::string(kLight) + kLight) ==
          "s.toml:5:1: the name 'key' is taken (at s.toml:2:1)");
}

TEST_CASE("scene toml: nested groups that would place billions are refused at once") {
    const SceneFolder folder;
    std::string text = "[[sphere]]\nname = 'g0'\n";
    for (int g = 1; g <= 12; ++g) {
        text += "[[group]]\nname = 'g" + std::to_string(g) + "'\nmembers = [";
        for (int i = 0; i < 10; ++i) text += "{ of = 'g" + std::to_string(g - 1) + "' },";
        text += "]\n";
    }
    CHECK(folder.failure(text).find("places more than 67 108 864 shapes") != std::string::npos);
}

TEST_CASE("scene toml: flat transforms and two ways at once are refused") {
    const SceneFolder folder;
    CHECK(folder.failure("[[sphere]]\nscale = [1, 0, 1]") ==
          "s.toml:3:1: sphere[0]: the transform is flat (scale leaves no volume)");
    CHECK(folder.failure("[[sphere]]\nmatrix = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]\nscale = 2") ==
          "s.toml:4:1: sphere[0]: give matrix or scale, not both");
}

TEST_CASE("scene toml: a transforms file gives one placement a row, and is checked") {
    const SceneFolder folder;
    const std::string text = "[[sphere]]\nname = 'a'\n[[instance]]\nof = 'a'\ntransforms = 't.f32'";
    const auto file_of = [&](std::vector<float> floats) {
        std::string bytes(floats.size() * sizeof(float), '\0');
        if (!floats.empty()) std::memcpy(bytes.data(), floats.data(), bytes.size());
        folder.write("t.f32", bytes);
    };
    file_of({1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0});
    const SceneDesc scene = folder.load(text);
    REQUIRE(scene.instances[0].transforms.size() == 2);
    CHECK(scene.instances[0].transforms[0] == Matrix34{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7});
    CHECK(scene.instances[0].transforms[1][0] == 2);
    CHECK(contains(scene.files, "t.f32"));

    const std::string at = "s.toml:6:1: instance[0]: transforms file 't.f32' ";
    file_of({1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1});
    CHECK(folder.failure(text) == at + "has 44 bytes, must be a multiple of 48 (3x4 floats each)");
    file_of({1, 0, 0, NAN, 0, 1, 0, 6, 0, 0, 1, 0});
    CHECK(folder.failure(text) == at + "row 0 has a number that is not finite or beyond 1e12");
    file_of({1, 0, 0, 0, 0, 1, 0, 6, 1, 1, 0, 0});
    CHECK(folder.failure(text) == at + "row 0 is flat (its 3x3 part has no inverse)");
    file_of({});
    CHECK(folder.failure(text) == at + "has 0 bytes, must be a multiple of 48 (3x4 floats each)");
}

TEST_CASE("scene toml: a mesh without a name is called after its file, and a file is loaded once") {
    const SceneFolder folder;
    folder.write("geo/car.obj", kTriangle);
    const SceneDesc scene = folder.load(
        "[[mesh]]\nfile = 'geo/car.obj'\n[[mesh]]\nname = 'red'\nfile = 'geo/car.obj'\n"
        "material = 'paint'\n[[instance]]\nof = 'car'\n[material.paint]\n");
    CHECK(scene.meshes.size() == 1);
    REQUIRE(scene.instances.size() == 2);
    CHECK(scene.instances[0].name == "red");
    CHECK(scene.instances[0].material == material_index(scene, "paint"));
    CHECK(scene.instances[1].name == "car");
    CHECK(scene.instances[1].material == -1);
}

TEST_CASE("scene toml: a mesh file that is not there, or outside, is a located error") {
    const SceneFolder folder;
    CHECK(folder.failure("[[mesh]]\nname = 'lamp'\nfile = 'lamp.obj'")
              .starts_with("s.toml:4:1: mesh 'lamp': file 'lamp.obj' not found (searched: "));
    CHECK(folder.failure("[[mesh]]\nfile = '../../../etc/passwd'").find("outside") !=
          std::string::npos);
}

TEST_CASE("scene toml: a material of the scene replaces the OBJ library's, and says so") {
    const SceneFolder folder;
    folder.write("two.obj", kTwoMaterials);
    folder.write("two.mtl", kTwoMaterialsMtl);
    const std::string mesh = "[[mesh]]\nfile = 'two.obj'\n";
    const SceneDesc scene = folder.load(mesh + "[material.red]\nspecular_roughness = 0.9");
    CHECK(material(scene, "red").base_color.value == Float3{0.8f, 0.8f, 0.8f});
    CHECK(material(scene, "red").specular_roughness.value == 0.9f);
    CHECK(material(scene, "blue").base_color.value[2] > 0);
    CHECK(
        contains(scene.notes, "s.toml:4:1: material 'red' replaces the one of the OBJ's library"));

    const SceneDesc kept =
        folder.load(mesh + "[material.red]\ninherits = 'red'\nspecular_roughness = 0.9");
    CHECK(material(kept, "red").base_color.value == Float3{0.5f, 0, 0});
    CHECK(material(kept, "red").specular_roughness.value == 0.9f);
}

TEST_CASE("scene toml: a mesh without a library takes the scene's materials, without a word") {
    const SceneFolder folder;
    folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    const std::string mesh = "[[mesh]]\nfile = 'bare.obj'\n";
    const SceneDesc scene = folder.load(mesh + "[material.red]\nspecular_roughness = 0.9");
    CHECK(material(scene, "red").specular_roughness.value == 0.9f);
    CHECK_FALSE(contains(scene.warnings, "'red'"));
    CHECK_FALSE(contains(scene.notes, "'red'"));
    // What inherits from a library's material still needs the library.
    const SceneDesc lost = folder.load(mesh + "[material.red]\ninherits = 'red'");
    CHECK(contains(lost.warnings, "no mtllib defines the material"));
}

TEST_CASE("scene toml: inputs are numbers, colours or images") {
    const SceneFolder folder;
    folder.write("tiles.png", "x");
    const SceneDesc scene = folder.load(R"(
        [material.floor]
        base_color = { file = "tiles.png", scale = [4, 2], wrap = "mirror", factor = [0.5, 1, 1] }
        specular_roughness = { file = "tiles.png", channel = "g", invert = true, factor = 0.5 }
        geometry_normal = { file = "tiles.png", scale_normal = 2 }
        emission_color = 3
        specular_ior = 1.33
        geometry_thin_walled = true
    )");
    const MaterialDesc& floor = material(scene, "floor");
    REQUIRE(floor.base_color.texture >= 0);
    const TextureDesc& tiles = scene.textures[static_cast<std::size_t>(floor.base_color.texture)];
    CHECK(tiles.scale == Float2{4, 2});
    CHECK(tiles.wrap_u == Wrap::mirror);
    CHECK(tiles.wrap_v == Wrap::mirror);
    CHECK(floor.base_color.value == Float3{0.5f, 1, 1});
    CHECK(floor.specular_roughness.channel == Channel::g);
    CHECK(floor.specular_roughness.invert);
    CHECK(floor.specular_roughness.value == 0.5f);
    CHECK(floor.geometry_normal.texture ==
          floor.specular_roughness.texture);  // equal textures are one
    CHECK(scene.textures.size() == 2);
    CHECK(floor.geometry_normal.scale == 2);
    CHECK(floor.emission_color.value == Float3{3, 3, 3});
    CHECK(floor.specular_ior.value == 1.33f);
    CHECK(floor.geometry_thin_walled);
}

TEST_CASE("scene toml: a mistyped input names the nearest known one") {
    const SceneFolder folder;
    CHECK(folder.failure("[material.oak]\nruoghness = 0.3") ==
          "s.toml:3:1: material 'oak': unknown input 'ruoghness' (did you mean "
          "'specular_roughness'?)");
    CHECK(folder.failure("[materials.oak]\n") ==
          "s.toml:2:1: unknown table 'materials' (did you mean 'material'?)");
    CHECK(folder.failure("[material.oak]\nbase_color = { fiel = 'a.png' }")
              .find("base_color: unknown key 'fiel' (did you mean 'file'?)") != std::string::npos);
}

TEST_CASE("scene toml: tangents are given by nodes") {
    const SceneFolder folder;
    const SceneDesc scene =
        folder.load("[material.a]\ngeometry_tangent = { type = 'tangent' }\ncoat_weight = 0.5");
    CHECK(material(scene, "a").geometry_tangent.node == 0);
    CHECK(folder.failure("[material.a]\ngeometry_tangent = [1, 0, 0]").find("must be a node") !=
          std::string::npos);
    CHECK(folder.failure("[material.a]\ncoat_weight = 'thick'").find("coat_weight is 'thick'") !=
          std::string::npos);
}

TEST_CASE("scene toml: inheritance in a circle is an error") {
    const SceneFolder folder;
    const std::string message =
        folder.failure("[material.a]\ninherits = 'b'\n[material.b]\ninherits = 'a'");
    CHECK(message == "s.toml:5:1: material 'b': inherits in a circle or deeper than 64");
}

TEST_CASE("scene toml: a missing texture keeps its name for the store, one outside is refused") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load("[material.a]\nbase_color = { file = 'no.png' }");
    CHECK(material(scene, "a").base_color.texture == 0);
    CHECK(fs::path(scene.textures[0].file).filename() == "no.png");
    CHECK(scene.textures[0].loc.line == 3);
    const std::string message =
        folder.failure("[material.a]\nbase_color = { file = '../../../etc/passwd' }");
    CHECK(message.find("s.toml:3:16: material 'a': texture '../../../etc/passwd' lies outside") ==
          0);
}

TEST_CASE("scene toml: a warning is an error when strict") {
    const SceneFolder folder;
    const std::string text = "[material.a]\nbase_color = 2";
    CHECK(contains(folder.load(text).warnings,
                   "s.toml:3:1: material 'a': base_color is 2, clamped to [0, 1]"));
    LoadOptions options;
    options.strictness = Strictness::strict;
    CHECK_THROWS_AS(load_scene(folder.write("s.toml", "tessera = 1\n" + text), options), Error);
}

TEST_CASE("scene toml: shapes without a material get 'default'") {
    const SceneFolder folder;
    CHECK(folder.load("[[sphere]]").materials.at(0).name == "default");
    const SceneDesc own = folder.load("[[sphere]]\n[material.default]\nbase_color = 0.1");
    CHECK(own.materials.size() == 1);
    CHECK(own.materials[0].base_color.value[0] == 0.1f);
}

TEST_CASE("scene toml: every type of light is read") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(R"(
        [[light]]
        type = "point"
        intensity = 5
        [[light]]
        type = "spot"
        cone_deg = 12
        [[light]]
        type = "distant"
        irradiance = [3, 2, 1]
        angle_deg = 0.533
        [[light]]
        type = "quad"
        corner = [-1, 3, -1]
        edges = [[2, 0, 0], [0, 0, 4]]
        two_sided = true
        [[light]]
        type = "disc"
        radius = 0.5
        visible = false
        [[light]]
        type = "sphere"
        center = [0, 9, 0]
    )");
    REQUIRE(scene.lights.size() == 6);
    CHECK(std::get<PointLightDesc>(scene.lights[0].shape).intensity == Float3{5, 5, 5});
    CHECK(std::get<SpotLightDesc>(scene.lights[1].shape).cone_deg == 12);
    CHECK(std::get<DistantLightDesc>(scene.lights[2].shape).irradiance == Float3{3, 2, 1});
    CHECK(std::get<QuadLightDesc>(scene.lights[3].shape).edges[1] == Double3{0, 0, 4});
    CHECK(std::get<QuadLightDesc>(scene.lights[3].shape).two_sided);
    CHECK(std::get<DiscLightDesc>(scene.lights[4].shape).radius == 0.5);
    CHECK_FALSE(scene.lights[4].visible);
    CHECK(std::get<SphereLightDesc>(scene.lights[5].shape).center == Double3{0, 9, 0});
}

TEST_CASE("scene toml: lights without a direction, area or type are refused") {
    const SceneFolder folder;
    CHECK(folder.failure("[[light]]\ntype = 'distant'\ndirection = [0, 0, 0]") ==
          "s.toml:4:1: light[0]: direction has no direction");
    CHECK(folder.failure("[[light]]\ntype = 'quad'\nedges = [[1, 2, 3], [2, 4, 6]]") ==
          "s.toml:4:1: light[0]: edges span no area");
    CHECK(folder.failure("[[light]]\nname = 'k'") ==
          "s.toml:2:1: light 'k': key 'type' is missing");
    CHECK(folder.failure("[[light]]\ntype = 'quad'\ncone_deg = 3") ==
          "s.toml:4:1: light[0]: unknown key 'cone_deg'");
}

TEST_CASE("scene toml: a scene in the dark is a warning, emission or a light is none") {
    const SceneFolder folder;
    CHECK(contains(folder.load("[[sphere]]").warnings, "the picture will be black"));
    CHECK(folder.load(std::string("[[sphere]]\n") + kLight).warnings.empty());
    CHECK(folder.load("[[sphere]]\n[environment]\n").warnings.empty());
    const std::string lamp = "[material.lamp]\nemission_luminance = 5\n";
    CHECK(folder.load(lamp + "[[sphere]]\nmaterial = 'lamp'").warnings.empty());
    CHECK(contains(folder.load(lamp + "[[sphere]]").warnings, "black"));  // nothing is made of it
}
