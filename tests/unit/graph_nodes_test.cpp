// Nodes of shader graphs that know the thread, the viewer, or whose surface they are on.

#include <algorithm>
#include <cmath>

#include "materials/nodes/pattern.h"
#include "materials/program.h"
#include "renderer/api/render.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

Vec3f normal_of(const MaterialDesc& m, const NormalInput& input, const ShadeInput& in) {
    Graph graph;
    const Wire wire = graph.add(m.nodes, input.node, input.output);
    GraphRun run(graph, in, nullptr);
    return run.value(wire);
}

// What a colour written as `text` is at a point.
Vec3f color_of(const std::string& text, const ShadeInput& in = {}) {
    const SceneFolder folder;
    const SceneDesc scene = folder.load("[material.a]\nbase_color = " + text + "\n");
    const ShaderProgram program(material(scene, "a"));
    return program.with_surface(in, nullptr, [](const Surface& s) { return s.p.base_color; });
}

bool near(Vec3f a, Vec3f b) { return max_component(abs(a - b)) < 1e-5f; }  // a few roundings

// Colours along a row of four things: an OBJ of two objects (x = 0, 1), a sphere, another one.
std::vector<Color> row_of(const std::string& color, bool other_order = false) {
    const SceneFolder folder;
    folder.write("pair.obj",
                 "o left\nv -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\nf 1 2 3 4\n"
                 "o right\nv 1.5 -0.5 0\nv 1.5 0.5 0\nf 2 5 6 3\n");
    const std::string ball =
        "[[sphere]]\nname = 'ball'\ncenter = [2, 0, 0]\nradius = 0.5\nmaterial = 'a'\n";
    const std::string rest =
        "[[mesh]]\nname = 'pair'\nfile = 'pair.obj'\nmaterial = 'a'\n[[sphere]]\nname = 'globe'\n"
        "center = [3, 0, 0]\nradius = 0.5\nmaterial = 'b'\n";
    const std::string text =
        "[camera]\nprojection = 'orthographic'\nposition = [1.5, 0, 5]\nlook_at = [1.5, 0, 0]\n"
        "ortho_height = 1\n[environment]\nradiance = 0\n[material.a]\nbase_color = "
        "0\nspecular_weight = 0\n"
        "emission_luminance = 179\nemission_color = " +
        color + "\n[material.b]\ninherits = 'a'\n";
    SceneDesc desc = folder.load(text + (other_order ? rest + ball : ball + rest));
    set_film(desc, 4, 1, 16);
    const RenderResult result = render(*build_scene(std::move(desc)));
    const float* rgba = result.image.layers[0].pixels.data();
    std::vector<Color> row;
    for (int i = 0; i < 4; ++i, rgba += 4)
        row.push_back(Color{rgba[0], rgba[1], rgba[2]} * (1.0f / std::max(rgba[3], 0.01f)));
    return row;
}

std::vector<float> reds(const std::vector<Color>& row) {
    std::vector<float> out;
    for (const Color& c : row) out.push_back(std::round(c.x * 1000) / 1000);
    return out;
}

}  // namespace

TEST_CASE("cloth node: normal and direction are those of the thread, turned into the world") {
    const SceneFolder folder;
    const SceneDesc scene = folder.load(
        "[material.a]\nspecular_roughness_anisotropy = 0.8\n"
        "geometry_normal = { node = 'weave', output = 'normal' }\n"
        "geometry_tangent = { node = 'weave', output = 'direction' }\n"
        "[material.a.node.weave]\ntype = 'cloth'\nthreads = [1, 1]\nthread_width = 0.8\n");
    const MaterialDesc& m = material(scene, "a");
    ShadeInput in;
    // u along the world's y, v along its z.
    in.n = {1, 0, 0};
    in.dpdu = {0, 2, 0};
    in.dpdv = {0, 0, 3};
    for (const Vec2f uv : {Vec2f{0.7f, 0.5f}, Vec2f{0.5f, 0.7f}, Vec2f{1.5f, 0.7f}}) {
        in.uv = uv;
        const Cloth c = cloth(uv, {.threads = {1, 1}, .thread_width = 0.8f}, 0);
        CHECK(near(normal_of(m, m.geometry_normal, in), {c.normal.z, c.normal.x, c.normal.y}));
        CHECK(near(normal_of(m, m.geometry_tangent, in), {0, c.direction.x, c.direction.y}));
        CHECK(c.normal.z < 0.99f);
    }
    const ShaderProgram program(m);
    CHECK(program.facts().tangent);
    CHECK(near(program.normal(in, nullptr), normal_of(m, m.geometry_normal, in)));
    // Seen from behind, the other side of the same relief.
    const Vec3f front = program.normal(in, nullptr);
    in.front = false;
    in.n = -in.n;
    CHECK(near(program.normal(in, nullptr), -front));
    // Where the chart is mirrored, v runs the other way.
    in.front = true;
    in.n = {1, 0, 0};
    in.handed = -1;
    CHECK(near(program.normal(in, nullptr), {front.x, front.y, -front.z}));
}

TEST_CASE("cloth node: far away the normal is the surface's") {
    const SceneFolder folder;
    const SceneDesc scene =
        folder.load("[material.a]\ngeometry_normal = { type = 'cloth', output = 'normal' }\n");
    const ShaderProgram program(material(scene, "a"));
    ShadeInput in;
    in.n = {0, 0, 1};
    in.dpdu = {1, 0, 0};
    in.dpdv = {0, 1, 0};
    in.uv = {0.013f, 0.021f};
    CHECK(program.normal(in, nullptr).z < 0.99f);
    in.uv_width = 1;
    CHECK(near(program.normal(in, nullptr), {0, 0, 1}));
}

TEST_CASE("graph: a vector output is a vector to what it goes into") {
    const SceneFolder folder;
    const auto failure = [&](const std::string& line) {
        return folder.failure("[material.a]\n" + line + "\n");
    };
    CHECK(failure("specular_roughness = { type = 'cloth', output = 'normal' }")
              .find("s.toml:3:22: material 'a': specular_roughness: node 'cloth' gives a vector3, "
                    "wanted is a number") != std::string::npos);
    CHECK(
        failure("geometry_normal = { type = 'cloth', output = 'height' }").find("takes a vector") !=
        std::string::npos);
    ShadeInput in;
    in.p_object = {0.3f, 0.7f, 0.2f};
    const Vec3f one = color_of("{ type = 'noise3d', amplitude = 0.4, pivot = 0.5 }", in);
    const Vec3f three =
        color_of("{ type = 'noise3d', amplitude = 0.4, pivot = 0.5, output = 'color' }", in);
    CHECK(three.x == doctest::Approx(one.x));
    CHECK(three.x != three.y);
    CHECK(three.y != three.z);
}

TEST_CASE("graph: kinds of values that cannot be joined are a located error") {
    const SceneFolder folder;
    const auto failure = [&](const std::string& color) {
        return folder.failure("[material.a]\nbase_color = " + color + "\n");
    };
    const std::string message =
        "s.toml:3:46: material 'a': base_color: node 'mix': fg is a colour, beside a vector2 (see "
        "'extract', 'luminance', 'combine3')";
    CHECK(failure(
              "{ type = 'mix', mix = 0.5, fg = { type = 'wood' }, bg = { type = 'texcoord' } }") ==
          message);
    CHECK(failure("{ type = 'add', in1 = [1, 2], in2 = [1, 2, 3] }")
              .find("in2 is a colour, beside") != std::string::npos);
    CHECK(failure("{ type = 'cellnoise2d', texcoord = { type = 'add', in1 = { type = 'texcoord' }, "
                  "in2 = { type = 'position' } } }")
              .find("in2 is a vector3, beside a vector2") != std::string::npos);
    // Numbers stand beside anything, pairs beside pairs, triples beside triples.
    for (const char* good :
         {"{ type = 'cellnoise2d', texcoord = { type = 'add', in1 = { type = 'texcoord' }, in2 = "
          "[1, 2] } }",
          "{ type = 'mix', fg = { type = 'wood' }, bg = { type = 'position' }, mix = 0.5 }",
          "{ type = 'add', in1 = { type = 'wood' }, in2 = { type = 'noise3d' } }"})
        CHECK(failure(good) == "");
}

TEST_CASE("graph: halves are split by the footprint's share") {
    ShadeInput in;
    in.uv = {0.45f, 0.7f};
    CHECK(near(color_of("{ type = 'splitlr', valuel = 0.2, valuer = 0.6 }", in), Vec3f(0.2f)));
    CHECK(near(color_of("{ type = 'splittb', valuet = 0.2, valueb = 0.6 }", in), Vec3f(0.2f)));
    CHECK(near(color_of("{ type = 'splittb', valuet = 0.2, valueb = 0.6, center = 0.8 }", in),
               Vec3f(0.6f)));
    in.uv_width = 0.2f;  // a quarter of it lies beyond the middle
    CHECK(near(color_of("{ type = 'splitlr', valuel = 0.2, valuer = 0.6 }", in), Vec3f(0.3f)));
}

TEST_CASE("graph: angles, the tenth of a switch, and what glass reflects") {
    CHECK(near(color_of("{ type = 'atan2', iny = 0.5, inx = 0.5 }"), Vec3f(0.785398f)));
    CHECK(near(color_of("{ type = 'acos', in = 0.9 }"), Vec3f(0.451027f)));
    CHECK(near(color_of("{ type = 'asin', in = 2 }"), Vec3f(1)));  // base_color ends at 1
    CHECK(near(color_of("{ type = 'switch', which = 9.5, in9 = 0.3, in10 = 0.7 }"), Vec3f(0.7f)));
    ShadeInput in;
    in.n = {0, 0, 1};
    in.facing = 1;
    CHECK(near(color_of("{ type = 'fresnel' }", in), Vec3f(0.04f)));
    CHECK(near(color_of("{ type = 'fresnel', ior = 3 }", in), Vec3f(0.25f)));
    in.facing = 0;
    in.view = {1, 0, 0};
    CHECK(near(color_of("{ type = 'fresnel' }", in), Vec3f(1)));
}

TEST_CASE("graph: what has a name is told from what has not") {
    const auto is = [](const std::string& inputs) {
        return reds(row_of("{ type = 'named', " + inputs + " }"));
    };
    CHECK(is("name = 'right'") == std::vector<float>{0, 1, 0, 0});
    CHECK(is("name = 'ball'") == std::vector<float>{0, 0, 1, 0});
    CHECK(is("name = 'pair', by = 'instance'") == std::vector<float>{1, 1, 0, 0});
    CHECK(is("name = 'b', by = 'material'") == std::vector<float>{0, 0, 0, 1});
    CHECK(is("name = 'pair'") == std::vector<float>{0, 0, 0, 0});
    // As the number that a switch goes by.
    CHECK(reds(row_of("{ type = 'switch', which = { type = 'named', name = 'left' }, in1 = 0.25, "
                      "in2 = 0.75 }")) == std::vector<float>{0.75f, 0.25f, 0.25f, 0.25f});
}

TEST_CASE("graph: random by object, instance or material, whatever their order") {
    for (const char* by : {"object", "instance", "material"}) {
        CAPTURE(by);
        const std::string color = "{ type = 'random', by = '" + std::string(by) + "' }";
        const std::vector<float> row = reds(row_of(color));
        CHECK(row == reds(row_of(color, true)));
        CHECK(row != reds(row_of("{ type = 'random', seed = 1, by = '" + std::string(by) + "' }")));
        CHECK((row[0] == row[1]) == (std::string(by) != "object"));
        CHECK((row[1] == row[2]) == (std::string(by) == "material"));
        CHECK(row[2] != row[3]);
    }
    CHECK(reds(row_of("{ type = 'random' }")) ==
          reds(row_of("{ type = 'random', by = 'instance' }")));
}

TEST_CASE("graph: words that are none are located errors") {
    const SceneFolder folder;
    const auto failure = [&](const std::string& color) {
        return folder.failure("[material.a]\nbase_color = " + color + "\n");
    };
    CHECK(failure("{ type = 'random', by = 'objcet' }") ==
          "s.toml:3:33: material 'a': base_color: there is no kind of name 'objcet' (did you mean "
          "'object'?)");
    CHECK(failure("{ type = 'named' }")
              .find("s.toml:3:14: material 'a': base_color: node 'named': "
                    "name is missing") != std::string::npos);
    CHECK(failure("{ type = 'named', name = 3 }").find("must be a name in quotes") !=
          std::string::npos);
}
