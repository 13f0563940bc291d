// Scenes with noise that was planted: the causes of the error name its kind, light and materials.
#include <doctest/doctest.h>

#include "renderer/api/render.h"
#include "tests/support/scene_folder.h"

using namespace tessera;

namespace {

// A floor under a faint even sky, which is next to no noise.
const std::string kStage = R"(
[film]
resolution = [48, 32]
[render]
spp = 64
[camera]
position = [0, 1.5, 5]
look_at = [0, 0.6, 0]
[environment]
radiance = [0.02, 0.02, 0.02]
[[disc]]
normal = [0, 1, 0]
radius = 8
material = "floor"
[material.floor]
base_color = [0.5, 0.5, 0.5]
specular_weight = 0
)";

const std::string kBulb = R"(
[[light]]
name = "bulb"
type = "quad"
corner = [-1, 4, -1]
edges = [[2, 0, 0], [0, 0, 2]]
radiance = [6, 6, 6]
visible = false
)";

std::vector<ErrorCause> causes_of(const std::string& text,
                                  const std::vector<std::string>& aovs = {"beauty"}) {
    const SceneFolder folder;
    SceneDesc desc = folder.load(kStage + text);
    desc.film.aovs = aovs;
    RenderSettings settings;
    settings.error_causes = true;
    return render(*build_scene(std::move(desc), {}), settings).stats.error.causes;
}

double sum_of(const std::vector<ErrorCause>& causes) {
    double sum = 0;
    for (const ErrorCause& c : causes) sum += c.share;
    return sum;
}

}  // namespace

TEST_CASE("error causes: a caustic is named with its light, its glass and where it falls") {
    const auto causes = causes_of(kBulb + R"(
[[sphere]]
center = [0, 0.9, 0]
radius = 0.7
material = "lens"
[material.lens]
transmission_weight = 1
specular_roughness = 0
)");
    REQUIRE_FALSE(causes.empty());
    CHECK(causes[0].paths == "caustic");
    CHECK(causes[0].light == "bulb");
    CHECK(causes[0].through == "lens");
    CHECK(causes[0].seen == "floor");
    CHECK(causes[0].share > 0.5);
    CHECK_FALSE(causes[0].remedy.empty());
}

TEST_CASE("error causes: a half-shadow is direct light of its lamp, and all shares add up") {
    const auto causes = causes_of(kBulb + R"(
[[sphere]]
center = [0, 0.9, 0]
radius = 0.7
material = "black"
[material.black]
base_color = [0, 0, 0]
specular_weight = 0
)");
    REQUIRE_FALSE(causes.empty());
    CHECK(causes[0].paths == "direct light");
    CHECK(causes[0].light == "bulb");
    CHECK(causes[0].seen == "floor");
    CHECK(causes[0].through.empty());
    CHECK(causes[0].share > 0.5);
    CHECK(causes.size() < 8);  // none is left out
    CHECK(sum_of(causes) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("error causes: a lamp that shines on a wall behind a screen is indirect light") {
    const auto causes = causes_of(R"(
[[light]]
name = "hidden"
type = "quad"
corner = [-0.2, 1, -2.9]
edges = [[0, 0.4, 0], [0.4, 0, 0]]
radiance = [400, 400, 400]
visible = false
[[disc]]
center = [0, 1, -4]
normal = [0, 0, 1]
radius = 3
material = "wall"
[material.wall]
base_color = [0.8, 0.8, 0.8]
specular_weight = 0
)");
    REQUIRE_FALSE(causes.empty());
    CHECK(causes[0].light == "hidden");
    CHECK(causes[0].paths == "indirect light");
}

TEST_CASE("error causes: the edge of a lamp that the camera sees") {
    const auto causes = causes_of(R"(
[[sphere]]
center = [0, 1, 0]
radius = 0.5
material = "neon"
[material.neon]
base_color = [0, 0, 0]
specular_weight = 0
emission_color = [1, 1, 1]
emission_luminance = 500
)");
    REQUIRE_FALSE(causes.empty());
    CHECK(causes[0].paths == "light seen directly");
    CHECK(causes[0].light == "neon");
    CHECK(causes[0].seen == "neon");
    CHECK(causes[0].share > 0.5);
}

TEST_CASE(
    "error causes: passes that were asked for do not change them, nor do they change passes") {
    const std::string lens = kBulb +
                             "[[sphere]]\ncenter = [0, 0.9, 0]\nradius = 0.7\nmaterial = 'lens'\n"
                             "[material.lens]\ntransmission_weight = 1\n";
    const auto plain = causes_of(lens),
               with = causes_of(lens, {"direct", "caustic = C<RD>T+L", "albedo"});
    REQUIRE(plain.size() == with.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        CHECK(plain[i].paths == with[i].paths);
        CHECK(plain[i].share == with[i].share);
    }
}
