// Light path expressions: what they take, and what is wrong with those that are none.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "renderer/film/light_paths.h"

using namespace tessera;

namespace {

using E = LobeEvent;
using L = LightType;

std::vector<LightTag> three_lights() {
    return {{0, "default", ""}, {1, "key", "lamp"}, {2, "fill", ""}};
}

Pass taking(const std::string& expression, int group = -1) {
    Pass p;
    p.name = "pass";
    p.source = PassSource::light_paths;
    p.expression = expression;
    p.group = group;
    return p;
}

bool takes(const std::string& expression, const std::vector<LobeEvent>& events,
           LightType light = L::light, int tag = 0, int group = -1) {
    const LightPaths paths({taking(expression, group)}, three_lights(), {});
    LightPaths::State s = paths.start();
    for (const LobeEvent e : events) s = paths.after(s, e);
    return !paths.taking(s, light, tag).empty();
}

std::string complaint(const std::string& expression) {
    try {
        takes(expression, {});
    } catch (const Error& e) {
        CHECK(e.code() == ExitCode::usage);
        return e.what();
    }
    return "";
}

bool says(const std::string& expression, const std::string& text) {
    const std::string what = complaint(expression);
    INFO(expression, ": ", what);
    CHECK(what.find(text) != std::string::npos);
    return what.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("light paths: types, scatterings and labels choose events") {
    CHECK(takes("CL", {}));
    CHECK_FALSE(takes("CL", {E::diffuse}));
    CHECK(takes("C<RD>L", {E::diffuse}));
    CHECK(takes("C<RD>L", {E::sheen}));
    CHECK_FALSE(takes("C<RD>L", {E::sss}));
    CHECK(takes("C<TD>L", {E::sss}));
    CHECK(takes("CDL", {E::sss}));
    CHECK(takes("CRL", {E::mirror}));
    CHECK_FALSE(takes("CRL", {E::transmission}));
    CHECK(takes("C<RG>L", {E::specular}));
    CHECK_FALSE(takes("C<RG>L", {E::mirror}));
    CHECK(takes("C<R[GS]>L", {E::mirror}));
    CHECK_FALSE(takes("C<R[^GS]>L", {E::mirror}));
    CHECK(takes("C<R[^GS]>L", {E::diffuse}));
    CHECK(takes("C<[RT]S>L", {E::clear_transmission}));
    CHECK(takes("C<.D>L", {E::diffuse}));
    CHECK(takes("C<RG'coat'>L", {E::coat}));
    CHECK_FALSE(takes("C<RG'coat'>L", {E::specular}));
    CHECK(takes("C'coat'L", {E::coat_mirror}));
    CHECK(takes("C<R.'coat''specular'>L", {E::mirror}));
    CHECK(takes("CVL", {E::volume}));
    CHECK(takes(" C  < R D > L ", {E::diffuse}));
}

TEST_CASE("light paths: sets, repetition and choice") {
    CHECK(takes("C[DG]L", {E::specular}));
    CHECK_FALSE(takes("C[^DG]L", {E::specular}));
    CHECK(takes("C[^DG]L", {E::mirror}));
    const std::vector<LobeEvent> two{E::diffuse, E::diffuse};
    CHECK(takes("CD*L", {}));
    CHECK(takes("CD*L", two));
    CHECK_FALSE(takes("CD+L", {}));
    CHECK(takes("CD?L", {}));
    CHECK_FALSE(takes("CD?L", two));
    CHECK(takes("CD{2}L", two));
    CHECK_FALSE(takes("CD{2}L", {E::diffuse}));
    CHECK(takes("CD{1,3}L", two));
    CHECK_FALSE(takes("CD{3,}L", two));
    CHECK(takes("CD{2,}L", {E::diffuse, E::diffuse, E::diffuse}));
    CHECK(takes("C(DS)*L", {E::diffuse, E::mirror, E::diffuse, E::mirror}));
    CHECK_FALSE(takes("C(DS)*L", {E::diffuse, E::mirror, E::diffuse}));
    CHECK(takes("C(D|S+)L", {E::mirror, E::mirror}));
    CHECK_FALSE(takes("C(D|S+)L", {E::diffuse, E::mirror}));
    CHECK(takes("C.*L", {E::coat, E::sss, E::diffuse}));
}

TEST_CASE("light paths: lights by type, group and name") {
    CHECK(takes("C<L.'key'>", {}, L::light, 1));
    CHECK_FALSE(takes("C<L.'key'>", {}, L::light, 2));
    CHECK(takes("C<L.'lamp'>", {}, L::light, 1));
    CHECK(takes("C<RD>[<L.'key'>O]", {E::diffuse}, L::object, 0));
    CHECK_FALSE(takes("C<RD>[<L.'key'>O]", {E::diffuse}, L::light, 0));
    CHECK(takes("CO", {}, L::object));
    CHECK_FALSE(takes("CL", {}, L::object));
    // The surroundings: behind everything they are the background, on surfaces a light too.
    CHECK(takes("CB", {}, L::background));
    CHECK_FALSE(takes("CL", {}, L::background));
    CHECK(takes("CDL", {E::diffuse}, L::surroundings));
    CHECK(takes("CDB", {E::diffuse}, L::surroundings));
    // A pass of one group takes no other's light.
    CHECK(takes("C.*[LOB]", {E::diffuse}, L::light, 1, 1));
    CHECK_FALSE(takes("C.*[LOB]", {E::diffuse}, L::light, 2, 1));
}

TEST_CASE("light paths: passes are told apart, and hopeless paths are dead") {
    const LightPaths paths({taking("C<RD>L"), taking("C.*L"), taking("CSL")}, three_lights(), {});
    CHECK(paths.passes() == 3);
    const auto diffuse = paths.taking(paths.after(paths.start(), E::diffuse), L::light, 0);
    CHECK(std::vector<std::uint16_t>(diffuse.begin(), diffuse.end()) ==
          std::vector<std::uint16_t>{0, 1});
    const LightPaths direct({taking("C<RD>L")}, three_lights(), {});
    CHECK(direct.after(direct.start(), E::mirror) == LightPaths::kDead);
    const LightPaths none({}, {LightTag{}}, {});
    CHECK(none.start() == LightPaths::kDead);
    CHECK(none.passes() == 0);
}

TEST_CASE("light paths: what is wrong is said with its place") {
    says("C<RX>L", "character 4: expected D, G, S, s or '.'");
    says("C<XD>L", "character 3: expected a type");
    says("CXL", "character 2: 'X' is no event");
    says("C<RD", "expected a 'label' or '>'");
    says("C(D", "expected ')'");
    says("CD)L", "')' closes nothing");
    says("C[]L", "an empty set");
    says("C[D", "expected ']'");
    says("C*{2}L", "repeats nothing");
    says("CD**L", "repeats nothing");
    says("CD{2", "expected '}'");
    says("CD{3,1}L", "less than the first");
    says("CD{99}L", "at most 64");
    says("C<L.'kee'>", "nothing is labelled 'kee' (there are");
    says("C'coat", "no closing quote");
    says("C|", "");
    says(std::string(5000, '('), "longer than 4096");
    says(std::string(300, '('), "nested too deep");
    says("C((((D{60}){60}){60}){60})L", "too large");
    CHECK(complaint(std::string(5000, '(')).size() < 400);
}

TEST_CASE("light paths: an expression that no light can come by is known") {
    for (const std::string nothing : {"C|L", "L", "C", "LC", "C<T'diffuse'>L", "C<RD>T+"}) {
        CAPTURE(nothing);
        CHECK_FALSE(LightPaths({taking(nothing)}, three_lights(), {}).is_taken(0));
    }
    const LightPaths two({taking("C"), taking("C.*")}, three_lights(), {});
    CHECK_FALSE(two.is_taken(0));
    CHECK(two.is_taken(1));
}

TEST_CASE("light paths: expressions that are too much together are refused, at once") {
    says("C.*D.{14}L", "too intricate");
    Passes many;
    for (int i = 0; i < 300; ++i)
        many.push_back(
            taking("C.{0," + std::to_string(i % 60) + "}D.{0," + std::to_string(i / 60) + "}L"));
    CHECK_THROWS_AS(LightPaths(many, three_lights(), {}), Error);
    Passes simple;
    for (int i = 0; i < 300; ++i)
        simple.push_back(taking("C.*D{" + std::to_string(i % 60) + "}" + (i < 150 ? "L" : "[LO]")));
    const LightPaths paths(simple, three_lights(), {});
    // Those of no D and of one, of i = 0, 1, 60, 61 ... 241.
    CHECK(paths.taking(paths.after(paths.start(), E::diffuse), L::light, 0).size() == 10);
}
