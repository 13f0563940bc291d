#include "materials/graph.h"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "materials/nodes/blend.h"
#include "materials/nodes/color_math.h"
#include "materials/program.h"
#include "renderer/io/node_docs.h"
#include "renderer/io/presets.h"
#include "tests/support/scene_folder.h"

namespace tessera::test {
namespace {

const MaterialDesc& material_of(const SceneDesc& scene, const std::string& name) {
    for (const MaterialDesc& m : scene.materials)
        if (m.name == name) return m;
    throw std::runtime_error("no material " + name);
}

// What a colour written as `text` is at a point.
Vec3f color_of(const std::string& text, const ShadeInput& in = {}, const std::string& nodes = "") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[material.a]\nsubsurface_weight = 1\nsubsurface_color = " + text + "\n" + nodes);
    const MaterialDesc& m = material_of(scene, "a");
    Graph graph;
    if (m.subsurface_color.node < 0) return Vec3f(m.subsurface_color.value);
    const Wire wire = graph.add(m.nodes, m.subsurface_color.node, m.subsurface_color.output);
    GraphRun run(graph, in, nullptr);
    return run.value(wire);
}

std::string failure_of(const std::string& text, const std::string& nodes = "") {
    const SceneFolder folder;
    return folder.failure("[material.a]\nbase_color = " + text + "\n" + nodes);
}

bool near(Vec3f a, Vec3f b, float slack = 1e-5f) { return max_component(abs(a - b)) <= slack; }

}  // namespace

TEST_CASE("graph: arithmetic gives what it says") {
    struct Case {
        const char* text;
        Vec3f value;
    };
    for (const Case& c : std::initializer_list<Case>{
             {"{ type = 'add', in1 = [1, 2, 3], in2 = 1 }", {2, 3, 4}},
             {"{ type = 'subtract', in1 = [1, 2, 3], in2 = [1, 1, 1] }", {0, 1, 2}},
             {"{ type = 'multiply', in1 = [1, 2, 3], in2 = 0.5 }", {0.5f, 1, 1.5f}},
             {"{ type = 'divide', in1 = [1, 2, 3], in2 = [2, 0, 3] }", {0.5f, 0, 1}},
             {"{ type = 'modulo', in1 = [5.5, -1, 3], in2 = 2 }", {1.5f, 1, 1}},
             {"{ type = 'power', in1 = [4, 9, -1], in2 = 0.5 }", {2, 3, 0}},
             {"{ type = 'clamp', in = [-1, 0.5, 3] }", {0, 0.5f, 1}},
             {"{ type = 'invert', in = [0.2, 0, 1] }", {0.8f, 1, 0}},
             {"{ type = 'mix', fg = [1, 0, 0], bg = [0, 0, 1], mix = 0.25 }", {0.25f, 0, 0.75f}},
             {"{ type = 'remap', in = 0.5, outlow = 2, outhigh = 4 }", {3, 3, 3}},
             {"{ type = 'smoothstep', in = [0, 0.5, 1] }", {0, 0.5f, 1}},
             {"{ type = 'combine3', in1 = 1, in2 = 2, in3 = 3 }", {1, 2, 3}},
             {"{ type = 'extract', in = [4, 5, 6], index = 1 }", {5, 5, 5}},
             {"{ type = 'ifgreater', value1 = 2, value2 = 1, in1 = 7, in2 = 8 }", {7, 7, 7}},
             {"{ type = 'switch', which = 1.5, in1 = 1, in2 = 2, in3 = 3 }", {2, 2, 2}},
             {"{ type = 'luminance', in = [1, 1, 1] }", {1, 1, 1}},
             {"{ type = 'contrast', in = 0.75, amount = 2 }", {1, 1, 1}},
             {"{ type = 'crossproduct', in1 = [1, 0, 0], in2 = [0, 1, 0] }", {0, 0, 1}},
             {"{ type = 'hsvadjust', in = [1, 0, 0], amount = [0.3333333, 1, 1] }", {0, 1, 0}},
         }) {
        CAPTURE(c.text);
        CHECK(near(color_of(c.text), c.value, 1e-5f));
    }
}

TEST_CASE("graph: what reads the point gets the point's") {
    ShadeInput in;
    in.uv = {0.25f, 0.75f};
    in.p_object = {1, 2, 3};
    in.p_world = {4, 5, 6};
    in.n = {0, 0, 1};
    in.facing = 0.5f;
    CHECK(near(color_of("{ type = 'extract', in = { type = 'texcoord' }, index = 1 }", in),
               Vec3f(0.75f)));
    CHECK(near(color_of("{ type = 'position' }", in), {1, 2, 3}));
    CHECK(near(color_of("{ type = 'position', space = 1 }", in), {4, 5, 6}));
    CHECK(near(color_of("{ type = 'normal' }", in), {0, 0, 1}));
    CHECK(near(color_of("{ type = 'facingratio' }", in), Vec3f(0.5f)));
    CHECK(near(color_of("{ type = 'ramplr', valuel = 0, valuer = 4 }", in), Vec3f(1)));
    CHECK(near(color_of("{ type = 'ramptb', valuet = 4, valueb = 0 }", in), Vec3f(3)));
    in.n = {0.6f, 0, 0.8f};
    const std::string even = "{ type = 'flakes', size = 1, spread = 0";
    CHECK(near(color_of(even + " }", in), {0.6f, 0, 0.8f}));
    CHECK(near(color_of(even + ", normal = [0, 2, 0] }", in), {0, 1, 0}));
    CHECK(near(color_of(even + ", coverage = 1, output = 'mask' }", in), Vec3f(1)));
    in.instance = 1;
    const Vec3f one = color_of("{ type = 'random' }", in);
    in.instance = 2;
    CHECK_FALSE(near(one, color_of("{ type = 'random' }", in)));
}

TEST_CASE("graph: constants are folded, equal nodes are one, what nothing reads is not there") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[material.a]\n"
        "base_color = { type = 'multiply', in1 = { type = 'add', in1 = 0.1, in2 = 0.2 }, in2 = 2 "
        "}\n"
        "specular_color = { type = 'noise3d', amplitude = 0.5, pivot = 0.5 }\n"
        "coat_color = { type = 'noise3d', amplitude = 0.5, pivot = 0.5 }\n"
        "coat_weight = 1\n"
        "fuzz_color = { type = 'noise2d' }\n");
    const ShaderProgram program(material_of(scene, "a"));
    CHECK(program.constant().base_color.x == doctest::Approx(0.6));
    // The position and the noise; the fuzz has no weight.
    CHECK(program.graph().size() == 2);
    CHECK(program.facts().geometry);
    CHECK_FALSE(program.facts().uv);
}

TEST_CASE("graph: what a mask hides is not run") {
    const SceneFolder folder;
    const auto runs = [&](const std::string& mask) {
        const SceneDesc scene = folder.load(
            "[material.a]\nbase_color = { layers = [{ value = { type = 'marble' } }, "
            "{ value = { type = 'wood' }, mask = { type = 'add', in1 = { type = 'facingratio' }, "
            "in2 = " +
            mask + " } }] }\n");
        const MaterialDesc& m = material_of(scene, "a");
        Graph graph;
        const Wire wire = graph.add(m.nodes, m.base_color.node, 0);
        const ShadeInput in;
        GraphRun run(graph, in, nullptr);
        run.value(wire);
        return run.runs();
    };
    // The layer on nothing is plain: the layer, mask and facing, the place, and one of the two.
    CHECK(runs("0") == runs("-1"));
    CHECK(runs("-0.5") == runs("0") + 1);
}

TEST_CASE("graph: layers blend by their modes") {
    const Color below{0.2f, 0.5f, 0.8f}, above{0.6f, 0.25f, 1.0f};
    CHECK(near(blended(below, above, 1, 0), above));
    CHECK(near(blended(below, above, 0, 0), below));
    CHECK(near(blended(below, above, 0.5f, 1), {0.16f, 0.3125f, 0.8f}));
    CHECK(near(blended(below, above, 1, 2), {0.68f, 0.625f, 1}));
    CHECK(near(blended(below, above, 1, 3), {0.24f, 0.25f, 1}));
    CHECK(near(blended(below, above, 1, 4), {0.8f, 0.75f, 1.8f}));
    CHECK(near(blended(below, above, 1, 5), {-0.4f, 0.25f, -0.2f}));
    CHECK(near(blended(below, above, 1, 6), {0.6f, 0.5f, 1}));
    CHECK(near(blended(below, above, 1, 7), {0.2f, 0.25f, 0.8f}));
    // Soft light by grey changes nothing.
    CHECK(near(blended(below, Color(0.5f), 1, 8), below));
    const std::string layers =
        "{ layers = [[0.2, 0.5, 0.8], { value = 0.5, blend = 'multiply', "
        "opacity = 0.5 }] }";
    CHECK(near(color_of(layers), below * 0.75f));
}

TEST_CASE("graph: outputs beside the main one are numbers") {
    ShadeInput in;
    in.p_object = {0.3f, 0.2f, 0.1f};
    const Vec3f f1 = color_of("{ type = 'worleynoise3d' }", in);
    const Vec3f f2 = color_of("{ type = 'worleynoise3d', output = 'f2' }", in);
    CHECK(f2.x >= f1.x);
    CHECK(f2.x == f2.y);
    CHECK(f2.x > 0.0f);
}

TEST_CASE("graph: colours turn about and glow") {
    for (const Color c :
         {Color{0.2f, 0.7f, 0.4f}, Color{1, 0, 0}, Color(0.3f), Color{0, 0.1f, 0.9f}})
        CHECK(near(hsv_to_rgb(rgb_to_hsv(c)), c, 1e-6f));
    CHECK(near(blackbody_color(6504), Color(1.0f), 0.06f));
    CHECK(blackbody_color(2000).x > 3 * blackbody_color(2000).z);
    CHECK(blackbody_color(15000).z > blackbody_color(15000).x);
}

TEST_CASE("graph: mistakes are located and the nearest name is offered") {
    const auto found = [](const std::string& error, const std::string& part) {
        CAPTURE(error);
        CHECK(error.find(part) != std::string::npos);
    };
    found(failure_of("{ type = 'nosie3d' }"),
          "s.toml:3:16: material 'a': base_color: there is no node type 'nosie3d' (did you mean "
          "'noise3d'?)");
    found(failure_of("{ type = 'mix', foreground = 1 }"), "node 'mix' has no input 'foreground'");
    found(failure_of("{ type = 'wood', output = 'rings' }"),
          "node 'wood' has no output 'rings' (did you mean 'ring'?)");
    found(failure_of("{ type = 'mix', mix = { type = 'wood' } }"),
          "node 'wood' gives a colour, wanted is a number");
    found(failure_of("{ type = 'mix', mix = [1, 2, 3] }"), "mix is an array of 3");
    found(failure_of("{ node = 'brikcs' }", "[material.a.node.bricks]\ntype = 'brick'\n"),
          "there is no node 'brikcs' (did you mean 'bricks'?)");
    found(
        failure_of("{ node = 'x' }", "[material.a.node.x]\ntype = 'invert'\nin = { node = 'x' }\n"),
        "node 'x' goes in a circle");
    found(failure_of("{ node = 'x' }", "[material.a.node.x]\nin = 1\n"), "type is missing");
    found(failure_of("{ layers = [] }"), "layers is an empty array");
    found(failure_of("{ layers = [1, { value = 1, blend = 'multipyl' }] }"), "blend is 'multipyl'");
    found(failure_of("{ layers = [1, { value = 1, mask = 1, opactiy = 1 }] }"),
          "unknown key 'opactiy' (did you mean 'opacity'?)");
}

TEST_CASE("graph: nodes that nothing reads are checked too") {
    const auto found = [](const std::string& error, const std::string& part) {
        CAPTURE(error);
        CHECK(error.find(part) != std::string::npos);
    };
    found(failure_of("1", "[material.a.node.x]\ntype = 'nosie2d'\n"), "did you mean 'noise2d'?");
    found(failure_of("1", "[material.a.node.x]\ntype = 'add'\nin1 = { node = 'x' }\n"),
          "node 'x' goes in a circle");
    found(failure_of("1\ngeometry_normal = { type = 'fractal3d' }"), "takes a vector");
    found(failure_of("{ file = '' }"), "file is empty");
}

TEST_CASE("graph: bumps in the heights of bumps end somewhere") {
    const auto nested = [](int depth) {
        std::string n = "{ type = 'bump', height = { type = 'noise3d' } }";
        for (int i = 1; i < depth; ++i)
            n = "{ type = 'bump', height = { type = 'extract', in = " + n + " } }";
        const SceneFolder folder;
        const SceneDesc scene = folder.load("[material.a]\ngeometry_normal = " + n + "\n");
        return ShaderProgram(material_of(scene, "a")).facts().geometry;
    };
    CHECK(nested(Graph::kMaxBumps));
    CHECK_THROWS_AS(nested(Graph::kMaxBumps + 1), Error);
}

TEST_CASE("graph: nodes of a parent can be named, and written anew") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[material.a.node.tint]\ntype = 'constant'\nvalue = [1, 0.5, 0]\n"
        "[material.b]\ninherits = 'a'\nbase_color = { node = 'tint' }\n"
        "[material.c]\ninherits = 'a'\nbase_color = { node = 'tint' }\n"
        "[material.c.node.tint]\ntype = 'constant'\nvalue = [0, 0, 1]\n");
    CHECK(near(ShaderProgram(material_of(scene, "b")).constant().base_color, {1, 0.5f, 0}));
    CHECK(near(ShaderProgram(material_of(scene, "c")).constant().base_color, {0, 0, 1}));
}

TEST_CASE("graph: nodes within nodes end somewhere, and too many are an error") {
    std::string deep = "1";
    for (int i = 0; i < 200; ++i) deep = "{ type = 'invert', in = " + deep + " }";
    const std::string too_deep = failure_of(deep);
    CAPTURE(too_deep);
    CHECK(too_deep.find("deeper than 32") != std::string::npos);
    std::string chain;
    for (int i = 0; i < 600; ++i)
        chain += "[material.a.node.n" + std::to_string(i) + "]\ntype = 'invert'\nin = { node = 'n" +
                 std::to_string(i + 1) + "' }\n";
    CHECK(failure_of("{ node = 'n0' }", chain).find("deeper than 512") != std::string::npos);
    std::string nodes;
    for (int i = 0; i < 400; ++i) {
        nodes += "[material.a.node.n" + std::to_string(i) +
                 "]\ntype = 'noise3d'\npivot = " + std::to_string(i) + "\n";
    }
    std::string layers = "{ layers = [0";
    for (int i = 0; i < 400; ++i)
        layers += ", { value = 1, mask = { node = 'n" + std::to_string(i) + "' } }";
    const SceneFolder folder;
    const SceneDesc scene = folder.load("[material.a]\nbase_color = " + layers + "] }\n" + nodes);
    CHECK_THROWS_AS(ShaderProgram{material_of(scene, "a")}, Error);
}

TEST_CASE("graph: layers of a material drive several inputs by one mask") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[material.a]\nbase_color = 0.5\nspecular_roughness = 0.2\n"
        "[[material.a.layer]]\nname = 'dust'\nmask = 0.5\nbase_color = 1\nspecular_roughness = 1\n"
        "[[material.a.layer]]\nopacity = 0.5\nblend = 'multiply'\nbase_color = [1, 0, 1]\n");
    const ShaderProgram program(material_of(scene, "a"));
    CHECK(near(program.constant().base_color, {0.75f, 0.375f, 0.75f}));
    CHECK(program.constant().specular_roughness == doctest::Approx(0.6));
    CHECK(program.graph().empty());
    const auto failure = [&](const std::string& layer) {
        return folder.failure("[material.a]\n[[material.a.layer]]\n" + layer);
    };
    CHECK(failure("ruoghness = 1")
              .find("s.toml:4:1: material 'a': layer[0]: unknown input "
                    "'ruoghness' (did you mean 'specular_roughness'?)") != std::string::npos);
    CHECK(failure("geometry_normal = 1").find("an image ({ file = ... }), a node") !=
          std::string::npos);
    CHECK(failure("opacity = 2").find("opacity is 2") != std::string::npos);
}

TEST_CASE("graph: a message about a wrong value names all that an input takes") {
    const SceneFolder folder;
    const auto failure = [&](const std::string& text) {
        return folder.failure("[material.a]\n" + text);
    };
    const std::string rest =
        "an image ({ file = ... }), a node ({ type = ... }) or layers ({ layers = [...] })";
    const std::string color = ", must be a number, 3 numbers in brackets, " + rest;
    const std::string scalar = ", must be a number, " + rest;
    CHECK(failure("base_color = true") == "s.toml:3:1: material 'a': base_color is true" + color);
    CHECK(failure("base_color = [1, 2]") ==
          "s.toml:3:1: material 'a': base_color is an array of 2" + color);
    CHECK(failure("specular_roughness = [1, 2, 3]") ==
          "s.toml:3:1: material 'a': specular_roughness is an array of 3" + scalar);
    CHECK(failure("base_color = { type = 'mix', fg = 'red', mix = 0.5 }")
              .ends_with("base_color: fg is 'red'" + color));
    CHECK(failure("base_color = { type = 'mix', fg = 1, mix = [1, 2] }")
              .ends_with("base_color: mix is an array of 2" + scalar));
    CHECK(failure("[[material.a.layer]]\nmask = 'all'\nbase_color = 1")
              .ends_with("layer[0]: mask is 'all'" + scalar));
    CHECK(failure("geometry_normal = 1").ends_with("geometry_normal is 1, must be " + rest));
    CHECK(failure("geometry_tangent = 1")
              .ends_with("is 1, must be a node ({ type = ... }) or layers ({ layers = [...] })"));
}

TEST_CASE("presets: each reads without a word and compiles, and a mistyped one is helped") {
    const SceneFolder folder;
    REQUIRE(presets().size() >= 20);
    for (const Preset& p : presets()) {
        const std::string name(p.name);
        CAPTURE(name);
        const SceneDesc scene = folder.load("[material.a]\ninherits = 'preset:" + name + "'");
        CHECK(scene.warnings.size() <= 1);  // that nothing emits light
        const ShaderProgram program(material_of(scene, "a"));
        CHECK(program.facts().specular);
    }
    const SceneDesc gold =
        folder.load("[material.ring]\ninherits = 'preset:gold'\nspecular_roughness = 0.5");
    CHECK(material_of(gold, "ring").base_metalness.value == 1);
    CHECK(material_of(gold, "ring").specular_roughness.value == 0.5f);
    CHECK(folder.failure("[material.a]\ninherits = 'preset:glod'") ==
          "s.toml:3:1: material 'a': there is no preset 'glod' (did you mean 'gold'?)");
}

TEST_CASE("nodes: the page in docs is what the table says") {
    std::ifstream file(std::string(TESSERA_SOURCE_DIR) + "/docs/nodes.md");
    std::stringstream text;
    text << file.rdbuf();
    CHECK(text.str() == nodes_markdown());
}

TEST_CASE("graph: hostile numbers end within a parameter's limits") {
    for (const float x :
         {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e30f, -1e30f, 0.0f}) {
        CAPTURE(x);
        for (const NodeInfo& info : kNodes) {
            if (info.op == NodeOp::image || info.op == NodeOp::triplanar) continue;
            NodeResult in[kMaxNodeInputs];
            for (NodeResult& r : in) r = {Vec3f(x), 0.1f, {}};
            run_node(info.op, in);
        }
        const SceneFolder folder;
        const SceneDesc scene = folder.load(
            "[material.a]\nbase_color = { type = 'normal' }\n"
            "specular_roughness = { type = 'facingratio' }\n"
            "specular_ior = { type = 'add', in1 = { type = 'facingratio' } }\n");
        ShadeInput point;
        point.n = Vec3f(x);
        point.facing = x;
        const ShaderProgram program(material_of(scene, "a"));
        program.with_surface(point, nullptr, [&](const Surface& s) {
            CHECK(min_component(s.p.base_color) >= 0.0f);
            CHECK(max_component(s.p.base_color) <= 1.0f);
            CHECK(s.p.specular_roughness >= 0.0f);
            CHECK(s.p.specular_roughness <= 1.0f);
            CHECK(s.p.specular_ior >= 0.01f);
            CHECK(s.p.specular_ior <= 100.0f);
        });
    }
}

}  // namespace tessera::test
