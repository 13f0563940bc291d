#include "renderer/scene/name_ids.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "renderer/core/murmur3.h"
#include "renderer/scene/scene.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

using Names = std::vector<std::string>;

// Names of what a ray down the y axis at (x, z) meets first: object, material, asset.
Names names_at(const Scene& scene, float x, float z) {
    const Hit hit = scene.accel().intersect({{x, 100, z}, {0, -1, 0}}, 0);
    REQUIRE(hit.valid());
    const Ray ray{{x, 100, z}, {0, -1, 0}};
    const SurfacePoint s =
        surface_point(scene.geometry(), scene.accel().target(hit), hit, ray, false);
    const NameIds& ids = *scene.name_ids();
    const NameKeys keys = ids.keys(scene.geometry(), s);
    Names out;
    for (int kind = 0; kind < kNameKinds; ++kind) {
        const NameList& list = ids.list(static_cast<NameKind>(kind));
        const std::uint32_t id = list.ids.at(keys[kind]);
        const auto name = std::find_if(list.names.begin(), list.names.end(),
                                       [&](const auto& n) { return cryptomatte_id(n) == id; });
        REQUIRE(name != list.names.end());
        out.push_back(*name);
    }
    return out;
}

ScenePtr build_named(SceneDesc scene) {
    scene.film.aovs = {"CryptoObject"};
    return build_scene(std::move(scene));
}

const Names& list_of(const ScenePtr& scene, NameKind kind) {
    return scene->name_ids()->list(kind).names;
}

// Unit squares seen from above, one per [o|g] statement, side by side along x.
constexpr const char* kSquares =
    "mtllib m.mtl\n"
    "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n"
    "g left right\nusemtl red paint\n"
    "v 2 0 0\nv 2 0 1\nv 3 0 1\nv 3 0 0\nf 5 6 7 8\n"
    "o равнина\nusemtl blue\n"
    "v 4 0 0\nv 4 0 1\nv 5 0 1\nf 9 10 11\n"
    "v 6 0 0\nv 6 0 1\nv 7 0 1\nv 7 0 0\nf 12 13 14 15\n";
constexpr const char* kSquaresMtl = "newmtl red paint\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";

}  // namespace

TEST_CASE("names: those of an OBJ's objects, groups, stem and materials are found from a hit") {
    SceneFolder folder;
    folder.write("row of squares.obj", kSquares);
    folder.write("m.mtl", kSquaresMtl);
    const ScenePtr scene =
        build_named(folder.load("[[mesh]]\nfile = 'row of squares.obj'\n"
                                "name = 'The \"row\"'\n" +
                                std::string(kLight)));
    const std::string asset = "The \"row\"";
    CHECK(names_at(*scene, 0.5f, 0.5f) == Names{"row of squares", "(no material)", asset});
    CHECK(names_at(*scene, 2.5f, 0.5f) == Names{"left right", "red paint", asset});
    CHECK(names_at(*scene, 4.3f, 0.6f) == Names{"равнина", "blue", asset});  // a triangle
    CHECK(names_at(*scene, 6.5f, 0.5f) == Names{"равнина", "blue", asset});
    CHECK(list_of(scene, NameKind::object) == Names{"left right", "row of squares", "равнина"});
    CHECK(list_of(scene, NameKind::asset) == Names{asset});
}

TEST_CASE("names: of instances, groups and replaced materials the outermost gives the asset") {
    SceneFolder folder;
    folder.write("tile.obj", "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n");
    const ScenePtr scene = build_named(
        folder.load("[material.grey]\n[material.gold]\n[material.unused]\n"
                    "[[mesh]]\nfile = 'tile.obj'\nmaterial = 'grey'\n"
                    "[[sphere]]\nname = 'ball'\nradius = 0.4\n"
                    "[[group]]\nname = 'pair'\nmembers = [{of = 'tile', material = 'gold'}, "
                    "{of = 'ball', name = 'inner', translate = [0.5, 2, 0.5]}]\n"
                    "[[instance]]\nof = 'tile'\n"
                    "[[instance]]\nof = 'pair'\nname = 'first pair'\ntranslate = [2, 0, 0]\n"
                    "[[instance]]\nof = 'pair'\ntranslate = [4, 0, 0]\n" +
                    std::string(kLight)));
    CHECK(names_at(*scene, 0.5f, 0.5f) == Names{"tile", "grey", "tile"});
    CHECK(names_at(*scene, 2.05f, 0.05f) == Names{"tile", "gold", "first pair"});
    CHECK(names_at(*scene, 2.5f, 0.5f) == Names{"ball", "default", "first pair"});
    CHECK(names_at(*scene, 4.05f, 0.05f) == Names{"tile", "gold", "pair"});
    CHECK(list_of(scene, NameKind::material) == Names{"default", "gold", "grey"});
}

TEST_CASE("names: what has none is called after what it is, and bodies of lights have names") {
    SceneDesc desc;
    const int material = add(desc, matte(0.5f));
    add_sphere(desc, {0, 0, 0}, 1, material);
    add_mesh(desc, floor_mesh(-2, 5, material));
    add_light(desc, SphereLightDesc{{10, 0, 0}, 1, {1, 1, 1}});
    add_light(desc, PointLightDesc{});
    add_light(desc, QuadLightDesc{{20, 0, 0}, {{{1, 0, 0}, {0, 0, 1}}}, {1, 1, 1}, true});
    desc.lights.back().name = "panel";
    const ScenePtr scene = build_named(desc);
    CHECK(names_at(*scene, 0, 0) == Names{"sphere", "default", "sphere"});
    CHECK(names_at(*scene, 3, 3) == Names{"mesh", "default", "mesh"});
    CHECK(names_at(*scene, 10, 0) == Names{"light", "light", "light"});
    CHECK(names_at(*scene, 20.5f, 0.5f) == Names{"panel", "light", "panel"});
}

TEST_CASE("names: bytes that are no UTF-8 are read as Latin-1, ids with them") {
    MeshDesc mesh = floor_mesh(0, 1, -1);
    mesh.name =
        "K\xfc"
        "che";
    SceneDesc desc;
    add_mesh(desc, std::move(mesh));
    const ScenePtr scene = build_named(std::move(desc));
    CHECK(names_at(*scene, 0.1f, 0.1f)[0] == "Küche");
}

TEST_CASE("names: a mesh's slots beyond its names do no harm, nor do names of no face") {
    SceneDesc desc;
    const int material = add(desc, matte(0.5f));
    MeshDesc mesh = quad_mesh({{0, 0, 0},
                               {0, 0, 1},
                               {1, 0, 1},
                               {1, 0, 0},  //
                               {2, 0, 0},
                               {2, 0, 1},
                               {3, 0, 1},
                               {3, 0, 0}},
                              material);
    mesh.name = "slab";
    mesh.object_names = {"", "without a face"};
    mesh.face_object = {0, 7};
    add_mesh(desc, std::move(mesh));
    const ScenePtr scene = build_named(desc);
    CHECK(names_at(*scene, 0.5f, 0.5f)[0] == "slab");
    CHECK(names_at(*scene, 2.5f, 0.5f)[0] == "slab");
    CHECK(list_of(scene, NameKind::object) == Names{"slab"});
}

TEST_CASE("names: the larger the surface, the smaller the key, instances and scales counted") {
    SceneDesc desc;
    const int material = add(desc, matte(0.5f));
    const auto square = [&](const std::string& name, double s, std::vector<Matrix34> at) {
        MeshDesc mesh = floor_mesh(0, s, material);
        mesh.name = name;
        desc.meshes.push_back(std::move(mesh));
        place(desc, ShapeKind::mesh, desc.meshes.size() - 1, std::move(at));
    };
    const auto scaled = [](double s, double x) {
        return Matrix34{s, 0, 0, x, 0, s, 0, 0, 0, 0, s, 0};
    };
    square("forty", 1, std::vector<Matrix34>(10, scaled(1, 0)));
    square("hundred", 5, {scaled(1, 0)});
    square("sixty-four", 1, {scaled(2, 0), scaled(std::sqrt(12), 30)});
    const ScenePtr scene = build_named(desc);
    const std::vector<std::uint32_t> wanted{cryptomatte_id("hundred"), cryptomatte_id("sixty-four"),
                                            cryptomatte_id("forty")};
    CHECK(scene->name_ids()->list(NameKind::object).ids == wanted);
    CHECK(scene->name_ids()->list(NameKind::asset).ids == wanted);
}

TEST_CASE("names: a picture that does not hold them keeps none, not even the faces' objects") {
    SceneFolder folder;
    folder.write("squares.obj", kSquares);
    folder.write("m.mtl", kSquaresMtl);
    const auto built = [&](std::vector<std::string> aovs) {
        SceneDesc desc = folder.load("[[mesh]]\nfile = 'squares.obj'\n" + std::string(kLight));
        desc.film.aovs = std::move(aovs);
        return build_scene(std::move(desc));
    };
    for (const std::vector<std::string>& aovs : {Names{}, Names{"Z", "N"}}) {
        const ScenePtr scene = built(aovs);
        CHECK(scene->name_ids() == nullptr);
        CHECK(scene->geometry().meshes[0].face_object.empty());
    }
    for (const char* pass : {"CryptoObject", "CryptoMaterial", "CryptoAsset"})
        CHECK(built({"Z", pass})->name_ids() != nullptr);
}
