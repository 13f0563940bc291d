// Passes of a picture: that they add up to it, leave it alone, and hold what their names say.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "renderer/film/pass.h"
#include "renderer/film/pass_docs.h"
#include "tests/support/map_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

using Layers = std::map<std::string, std::vector<float>>;

Layers layers_of(SceneDesc scene, std::vector<std::string> aovs) {
    scene.film.aovs = std::move(aovs);
    Layers out;
    for (Layer& l : render(*build_scene(std::move(scene))).image.layers)
        out[l.name.empty() && l.channels[0] == "Z" ? "Z" : l.name] = std::move(l.pixels);
    return out;
}

const std::vector<std::string> kParts{
    "diffuse_direct",      "diffuse_indirect",      "specular_direct",
    "specular_indirect",   "coat_direct",           "coat_indirect",
    "transmission_direct", "transmission_indirect", "sss_direct",
    "sss_indirect",        "sheen_direct",          "sheen_indirect",
    "volume_direct",       "volume_indirect",       "emission",
    "background"};

// The greatest difference between the parts' sum and the whole, relative to the whole.
double worst_difference(const Layers& layers, const std::vector<std::string>& parts,
                        const std::vector<float>& whole, std::size_t channels = 4) {
    double worst = 0;
    for (std::size_t i = 0; i < whole.size() / channels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (const std::string& p : parts) sum += static_cast<double>(layers.at(p)[i * 3 + c]);
            const double all = static_cast<double>(whole[i * channels + c]);
            if (all == 0) CHECK(sum == 0);
            if (all > 0) worst = std::max(worst, std::fabs(sum - all) / all);
        }
    }
    return worst;
}

double mean(const std::vector<float>& pixels) {
    double sum = 0;
    for (const float v : pixels) sum += static_cast<double>(v);
    return sum / static_cast<double>(pixels.size());
}

// A floor under lamps of two groups, a glowing panel and a sky.
SceneDesc lit_room() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.7f))));
    add_mesh(s, quad_mesh({{-2, 0, -2}, {2, 0, -2}, {2, 2, -2}, {-2, 2, -2}}, add(s, matte(0.5f))));
    const int panel = add(s, glowing(2));
    s.materials[static_cast<std::size_t>(panel)].light_group = "panel";
    s.materials[static_cast<std::size_t>(panel)].name = "panel";
    add_mesh(s, quad_mesh({{-2, 0.2, 1}, {-2, 0.2, 0}, {-2, 1, 0}, {-2, 1, 1}}, panel));
    add_light(s, SphereLightDesc{{1, 2, 0}, 0.3, {8, 7, 6}});
    add_light(s, PointLightDesc{{-1, 2, 1}, {3, 4, 5}});
    s.lights[0].light_group = "key";
    s.lights[1].light_group = "fill";
    s.lights[1].name = "bulb";
    add_sky(s, {0.3f, 0.4f, 0.5f});
    look(s, {0, 1.6, 5}, {0, 0.6, 0}, 45);
    set_film(s, 32, 24, 16);
    return s;
}

// Every kind of lobe.
SceneDesc all_lobes() {
    SceneDesc s = lit_room();
    MaterialDesc coated = metal(0.3f, 0.8f);
    coated.coat_weight.value = 1;
    coated.coat_roughness.value = 0.1f;
    MaterialDesc velvet = matte(0.3f);
    velvet.fuzz_weight.value = 1;
    velvet.specular_weight.value = 1;
    MaterialDesc wax = matte(0.8f);
    wax.subsurface_weight.value = 0.7f;
    wax.subsurface_radius.value = 0.05f;
    MaterialDesc sheet = glass(0.2f);
    sheet.geometry_thin_walled = true;
    sheet.geometry_opacity.value = 0.6f;
    MaterialDesc film = glass(0);
    film.thin_film_weight.value = 1;
    MaterialDesc cloudy = glass(0);
    cloudy.transmission_depth.value = 0.3f;
    cloudy.transmission_scatter.value = {0.5f, 0.6f, 0.7f};
    MaterialDesc varnished = matte(0.6f);
    varnished.specular_weight.value = 1;
    varnished.specular_roughness.value = 0;
    varnished.coat_weight.value = 0.5f;
    varnished.coat_roughness.value = 0;
    const std::vector<MaterialDesc> materials{coated, velvet, wax,         sheet,
                                              film,   cloudy, glass(0.2f), varnished};
    for (std::size_t i = 0; i < materials.size(); ++i) {
        add_sphere(s, {-1.4 + 0.95 * static_cast<double>(i % 4), 0.42 + 0.9 * double(i / 4), 0.4},
                   0.4, add(s, materials[i]));
    }
    return s;
}

}  // namespace

TEST_CASE("passes: lobes, emission and background add up to beauty, and leave its bits alone") {
    const SceneDesc scene = all_lobes();
    std::vector<std::string> asked = kParts;
    for (const char* more : {"light_groups", "diffuse@groups", "ao", "shadow", "lookdev", "debug"})
        asked.emplace_back(more);
    const Layers layers = layers_of(scene, asked);
    CHECK(layers.at("") == layers_of(scene, {"beauty"}).at(""));
    CHECK(worst_difference(layers, kParts, layers.at("")) < 1e-6);
    CHECK(worst_difference(layers, {"RGBA_default", "RGBA_panel", "RGBA_key", "RGBA_fill"},
                           layers.at("")) < 1e-6);
    CHECK(worst_difference(layers,
                           {"diffuse_default", "diffuse_panel", "diffuse_key", "diffuse_fill"},
                           layers.at("diffuse"), 3) < 1e-6);
    // None is a mere zero here, so that the sum says something of each. (No camera is in fog.)
    for (const std::string& part : kParts) {
        INFO(part);
        CHECK((mean(layers.at(part)) > 0) == (part.find("volume") == std::string::npos));
    }
}

TEST_CASE("passes: a picture with reflection maps and mirrors of its own adds up as well") {
    SceneFolder folder;
    write_map(folder.path("map.exr"), Color{0.2f, 0.5f, 0.9f});
    write_map(folder.path("other.exr"), Color{0.9f, 0.3f, 0.1f});
    SceneDesc scene = folder.load(
        "[environment]\nlighting = 'map.exr'\nreflection = 'other.exr'\n"
        "[[sphere]]\nmaterial = 'm'\n[[sphere]]\ncenter = [2, 0, 0]\nmaterial = 'n'\n"
        "[material.m]\nspecular_roughness = 0.3\n"
        "[material.n]\nspecular_roughness = 0.2\nbase_metalness = 0.5\nreflection_map = { file = "
        "'map.exr' }\n");
    look(scene, {1, 0, 8}, {1, 0, 0}, 30);
    set_film(scene, 24, 16, 16);
    std::vector<std::string> asked = kParts;
    const Layers layers = layers_of(scene, asked);
    CHECK(layers.at("") == layers_of(scene, {"beauty"}).at(""));
    CHECK(worst_difference(layers, kParts, layers.at("")) < 1e-6);
    CHECK(mean(layers.at("specular_direct")) > 0.01);
}

TEST_CASE("passes: direct light is what a picture of one bounce holds") {
    SceneDesc scene = all_lobes();
    for (MaterialDesc& m : scene.materials) m.subsurface_weight.value = 0;  // way in, way out: two
    const std::vector<std::string> aovs{"direct", "emission", "background", "indirect"};
    const Layers layers = layers_of(scene, aovs);
    SceneDesc once = scene;
    once.render.max_depth = 0;
    const Layers shallow = layers_of(once, aovs);
    CHECK(mean(shallow.at("indirect")) == 0);
    CHECK(shallow.at("emission") == layers.at("emission"));
    CHECK(shallow.at("background") == layers.at("background"));
    double worst = 0;
    for (std::size_t i = 0; i < layers.at("direct").size(); ++i) {
        const double a = static_cast<double>(layers.at("direct")[i]);
        const double b = static_cast<double>(shallow.at("direct")[i]);
        worst = std::max(worst, std::fabs(a - b) / std::max(a, 1e-3));
    }
    CHECK(worst < 1e-5);
}

TEST_CASE("passes: an expression of one's own takes what it says") {
    const SceneDesc scene = lit_room();
    const Layers layers =
        layers_of(scene, {"key = C<RD><L.'key'>", "bulb = C.+<L.'bulb'>", "panel=C.*O",
                          "RGBA_again=C.*[LOB]", "diffuse_direct@groups", "light_groups"});
    CHECK(layers.at("key") == layers.at("diffuse_direct_key"));
    CHECK(layers.at("bulb") == layers.at("RGBA_fill"));
    CHECK(layers.at("panel") == layers.at("RGBA_panel"));
    CHECK(mean(layers.at("key")) > 0.01);
    CHECK(worst_difference(layers, {"RGBA_again"}, layers.at("")) < 1e-6);
}

TEST_CASE("passes: a group's light is the picture with the other lamps out") {
    SceneDesc scene = lit_room();
    scene.render.spp = 256;
    const Layers layers = layers_of(scene, {"light_groups"});
    SceneDesc alone = scene;
    alone.environment.reset();
    alone.materials[2].emission_luminance.value = 0;
    alone.lights.erase(alone.lights.begin());
    const Layers only = layers_of(alone, {"beauty"});
    double group = 0, whole = 0;
    for (std::size_t i = 0; i < layers.at("RGBA_fill").size() / 3; ++i) {
        group += static_cast<double>(layers.at("RGBA_fill")[i * 3]);
        whole += static_cast<double>(only.at("")[i * 4]);
    }
    // 768 pixels of 256 samples: the mean is known to a thousandth.
    CHECK(group / whole == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("passes: data of the first surface") {
    SceneDesc s;
    SphereDesc ball;
    ball.radius = 1;
    ball.material = add(s, matte(0.5f));
    s.spheres.push_back(ball);
    place(s, ShapeKind::sphere, 0, {Matrix34{2, 0, 0, 5, 0, 2, 0, 0, 0, 0, 2, 0}});
    add_sky(s, {1, 1, 1});
    look_at_point(s, {5, 0, 10}, {5, 0, 0});
    set_film(s, 4, 4, 16);
    const Layers layers = layers_of(
        s, {"Z", "depth", "P", "Pref", "N", "Ng", "facing", "ao", "sample_count", "variance",
            "standard_error", "albedo", "diffuse_albedo", "specular_albedo", "shadow_matte"});
    CHECK(layers.at("Z")[0] == doctest::Approx(8));
    CHECK(layers.at("depth")[0] == doctest::Approx(8));
    CHECK(layers.at("P")[0] == doctest::Approx(5));
    CHECK(layers.at("P")[2] == doctest::Approx(2));
    CHECK(layers.at("Pref")[0] == doctest::Approx(0).epsilon(1e-3));
    CHECK(layers.at("Pref")[2] == doctest::Approx(1));
    CHECK(layers.at("N")[2] == doctest::Approx(1));
    CHECK(layers.at("Ng")[2] == doctest::Approx(1));
    CHECK(layers.at("facing")[0] == doctest::Approx(1));
    CHECK(layers.at("ao")[0] == 1);
    CHECK(layers.at("sample_count")[0] == 16);
    CHECK(layers.at("diffuse_albedo")[0] == doctest::Approx(0.5));
    CHECK(layers.at("specular_albedo")[0] == 0);
    // Lambert under a constant sky: every sample is 0.5.
    CHECK(layers.at("variance")[0] < 1e-9);
    CHECK(layers.at("standard_error")[0] < 1e-7);
    CHECK(layers.at("shadow_matte")[0] == 0);
}

TEST_CASE("passes: squares of standard errors add up to the squared error that the picture tells") {
    SceneDesc s;
    SphereDesc ball;
    ball.radius = 1;
    ball.material = add(s, matte(0.5f));
    s.spheres.push_back(ball);
    place(s, ShapeKind::sphere, 0, {Matrix34{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}});
    add_sky(s, {1, 2, 3});
    look_at_point(s, {0, 0, 4}, {0, 0, 0});
    s.camera.ortho_height = 3;
    set_film(s, 24, 20, 12);
    s.film.aovs = {"standard_error"};
    const RenderResult r = render(*build_scene(std::move(s)));
    double sum = 0;
    for (const float e : r.image.layers.at(1).pixels)
        sum += static_cast<double>(e) * static_cast<double>(e);
    const double rmse = std::sqrt(sum / (24 * 20 * 3));
    CHECK(rmse > 1e-3);
    CHECK(r.stats.error.rmse.value == doctest::Approx(rmse).epsilon(1e-4));
}

TEST_CASE("passes: under an even sky glass shows its albedos, of reflection and of what passes") {
    for (const float roughness : {0.0f, 0.3f}) {
        CAPTURE(roughness);
        SceneDesc s;
        add_sphere(s, {0, 0, 0}, 1, add(s, glass(roughness)));
        add_sky(s, {1, 1, 1});
        look(s, {0, 0, 5}, {0, 0, 0}, 24);
        set_film(s, 32, 32, 256);
        const Layers layers =
            layers_of(s, {"specular", "specular_albedo", "transmission", "transmission_albedo"});
        // 3 sigma of the rarer event at 200 000 samples; rough glass's albedo is that of its
        // mirror direction.
        const double tolerance = roughness > 0 ? 0.15 : 0.03;
        CHECK(mean(layers.at("specular_albedo")) > 0.01);
        CHECK(mean(layers.at("specular")) ==
              doctest::Approx(mean(layers.at("specular_albedo"))).epsilon(tolerance));
        CHECK(mean(layers.at("transmission")) ==
              doctest::Approx(mean(layers.at("transmission_albedo"))).epsilon(0.03));
    }
}

TEST_CASE("passes: where a lobe shines its albedo is not nothing") {
    const Layers layers = layers_of(all_lobes(), {"lookdev"});
    for (const std::string lobe : {"diffuse", "specular", "coat", "transmission", "sss", "sheen"}) {
        const std::vector<float>& light = layers.at(lobe);
        const std::vector<float>& albedo = layers.at(lobe + "_albedo");
        int lit = 0, without = 0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            lit += light[i] > 0;
            without += light[i] > 0 && !(albedo[i] > 0);
        }
        CAPTURE(lobe);
        CHECK(lit > 0);
        CHECK(without == 0);
    }
}

TEST_CASE("passes: ambient occlusion beside a wall is the sky's share by the cosine") {
    // A point on the floor at the foot of an endless wall sees half of the sky.
    SceneDesc s;
    const int m = add(s, matte(0.5f));
    add_mesh(s, floor_mesh(0, 1, m));
    add_mesh(s,
             quad_mesh({{-1e4, 0, -0.5}, {1e4, 0, -0.5}, {1e4, 1e4, -0.5}, {-1e4, 1e4, -0.5}}, m));
    add_sky(s, {1, 1, 1});
    look_at_point(s, {0, 2, -0.4999}, {0, 0, -0.4999});
    set_film(s, 8, 8, 256);
    CHECK(mean(layers_of(s, {"ao"}).at("ao")) == doctest::Approx(0.5).epsilon(0.01));
    s.film.ao_distance = 1e-5;
    CHECK(mean(layers_of(s, {"ao"}).at("ao")) == 1);
}

TEST_CASE("passes: shadow is the light that is missing, shadow_matte its share") {
    SceneDesc s;
    const int m = add(s, matte(0.5f));
    add_mesh(s, floor_mesh(0, 10, m));
    add_light(s, PointLightDesc{{-1, 3, 0}, {30, 30, 30}});
    add_light(s, PointLightDesc{{1, 3, 0}, {30, 30, 30}});
    look_at_point(s, {0, 4, 0}, {0, 0, 0});
    set_film(s, 8, 8, 64);
    const double open = mean(layers_of(s, {"direct"}).at("direct"));
    // In the way of one of them.
    add_mesh(s, box_mesh({0.6, 2, 0}, 0.2, m));
    const Layers layers = layers_of(s, {"direct", "shadow", "shadow_matte"});
    CHECK(mean(layers.at("direct")) == doctest::Approx(open / 2).epsilon(0.02));
    CHECK(mean(layers.at("shadow")) == doctest::Approx(open / 2).epsilon(0.02));
    CHECK(mean(layers.at("shadow_matte")) == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("passes: names that are none are refused with the nearest") {
    const auto complaint = [](std::vector<std::string> aovs) -> std::string {
        try {
            choose_passes(aovs, {"default", "key"}, {});
        } catch (const Error& e) {
            CHECK(e.code() == ExitCode::usage);
            return e.what();
        }
        return "";
    };
    const auto says = [&](const std::string& name, const std::string& text) {
        const std::string what = complaint({name});
        INFO(what);
        CHECK(what.find(text) != std::string::npos);
    };
    says("difuse_direct", "did you mean 'diffuse_direct'?");
    says("compositng", "did you mean 'compositing'?");
    says("nonsense", "--list-aovs");
    says("Z@groups", "not made of light");
    says("foo@groups", "unknown");
    says("albedo = C<RD>L", "is a ready one");
    says("1st = CL", "no name for a pass");
    says("a-b = CL", "no name for a pass");
    says("key_left = CL", "Nuke");
    says("a_name_of_more_than_thirty_one_letters = CL", "31");
    says("mine =", "no expression");
    says("beauty = C.*L", "there already");
    says("CryptoObject00 = C.*L", "Cryptomatte");
    CHECK(complaint({"mine = CL", "mine = CO"}).find("twice") != std::string::npos);
    CHECK(complaint({"RGBA_key = C.*[LOB]", "light_groups"}).find("twice") != std::string::npos);
    CHECK(complaint({"mine = CL", "mine = CL", "Z", "Z"}).empty());
    CHECK(choose_passes({}, {"default"}, {}).size() == 4);
    CHECK(choose_passes({"beauty"}, {"default"}, {}).empty());
    CHECK(choose_passes({"light_groups"}, {"default", "key"}, {}).size() == 2);
    CHECK(choose_passes({"beauty@groups", "light_groups"}, {"default", "key"}, {}).size() == 2);
    std::vector<std::string> many;
    for (int i = 0; i < 1000; ++i) many.push_back("p" + std::to_string(i) + " = CL");
    CHECK(complaint(many).empty());
    many.push_back("one = CL");
    CHECK(complaint(many).find("more than 1000 passes") != std::string::npos);
}

TEST_CASE("passes: docs/passes.md holds the tables that --passes prints") {
    std::ifstream file(std::string(TESSERA_SOURCE_DIR) + "/docs/passes.md");
    std::stringstream text;
    text << file.rdbuf();
    CHECK(text.str().find(passes_markdown()) != std::string::npos);
}
