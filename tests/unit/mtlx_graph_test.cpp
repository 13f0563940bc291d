// Node graphs of MaterialX: references, nodes, types, and what is wrong with them.

#include "renderer/io/mtlx_surface.h"
#include "tests/support/mtlx_folder.h"

using namespace tessera;

namespace {

std::string input(const std::string& name, const std::string& type, const std::string& rest) {
    return "<input name='" + name + "' type='" + type + "' " + rest + "/>";
}

/// base_color or base_weight from graph 'g', output 'o', of a node 'n' among `nodes`.
std::string graph_document(const std::string& nodes, const std::string& type = "color3",
                           const std::string& node = "n") {
    const std::string target = type == "float" ? "base_weight" : "base_color";
    return mtlx_surface(input(target, type, "nodegraph='g' output='o'"),
                        "<nodegraph name='g'>\n" + nodes + "\n<output name='o' type='" + type +
                            "' nodename='" + node + "'/></nodegraph>");
}

Vec3f color_of(const std::string& nodes, const ShadeInput& in = {}) {
    const MtlxFolder folder;
    const SceneDesc scene = folder.load_mtlx(graph_document(nodes));
    return value_at(material(scene, "m"), material(scene, "m").base_color, in);
}

float number_of(const std::string& nodes, const ShadeInput& in = {}) {
    const MtlxFolder folder;
    const SceneDesc scene = folder.load_mtlx(graph_document(nodes, "float"));
    return value_at(material(scene, "m"), material(scene, "m").base_weight, in).x;
}

std::string refusal_of(const std::string& nodes, const std::string& type = "color3") {
    return MtlxFolder().refusal(graph_document(nodes, type));
}

bool near(Vec3f a, Vec3f b) { return max_component(abs(a - b)) < 1e-5f; }  // a few roundings

}  // namespace

TEST_CASE("mtlx graph: nodes of the table give what they say") {
    CHECK(near(
        color_of("<add name='n' type='color3'>" + input("in1", "color3", "value='0.1,0.2,0.3'") +
                 input("in2", "float", "value='0.5'") + "</add>"),
        {0.6f, 0.7f, 0.8f}));
    CHECK(near(color_of("<mix name='n' type='color3'>" + input("fg", "color3", "value='1,0,0'") +
                        input("bg", "color3", "value='0,0,1'") +
                        input("mix", "float", "value='0.25'") + "</mix>"),
               {0.25f, 0, 0.75f}));
    CHECK(near(color_of("<mix name='n' type='color3'>" + input("fg", "color3", "value='1,1,1'") +
                        input("mix", "color3", "value='0.25,0.5,1'") + "</mix>"),
               {0.25f, 0.5f, 1}));
    CHECK(number_of("<luminance name='l' type='color3'>" + input("in", "color3", "value='1,1,1'") +
                    "</luminance><extract name='n' type='float'>" +
                    input("in", "color3", "nodename='l'") + input("index", "integer", "value='2'") +
                    "</extract>") == doctest::Approx(1));
}

TEST_CASE("mtlx graph: nodes the table lacks come to what the specification says") {
    struct Case {
        const char* nodes;
        float value;
    };
    for (
        const Case& c : std::initializer_list<Case>{
            {"<dot name='n' type='float'><input name='in' type='float' value='0.3'/></dot>", 0.3f},
            {"<convert name='n' type='float'><input name='in' type='boolean' "
             "value='true'/></convert>",
             1},
            {"<fract name='n' type='float'><input name='in' type='float' value='2.75'/></fract>",
             0.75f},
            {"<tan name='n' type='float'><input name='in' type='float' value='0.5'/></tan>",
             0.5463025f},
            {"<safepower name='n' type='float'><input name='in1' type='float' value='-0.5'/><input "
             "name='in2' type='float' value='2'/></safepower>",
             -0.25f},
            {"<ifgreatereq name='n' type='float'><input name='value1' type='float' "
             "value='2'/><input "
             "name='value2' type='float' value='2'/><input name='in1' type='float' "
             "value='0.7'/><input "
             "name='in2' type='float' value='0.1'/></ifgreatereq>",
             0.7f},
            {"<ifequal name='n' type='float'><input name='value1' type='float' value='3'/><input "
             "name='value2' type='float' value='2'/><input name='in1' type='float' "
             "value='0.7'/><input "
             "name='in2' type='float' value='0.1'/></ifequal>",
             0.1f},
            {"<ifequal name='n' type='float'><input name='value1' type='float' value='2'/><input "
             "name='value2' type='float' value='2'/><input name='in1' type='float' "
             "value='0.7'/><input "
             "name='in2' type='float' value='0.1'/></ifequal>",
             0.7f},
            {"<range name='n' type='float'><input name='in' type='float' value='0.25'/><input "
             "name='gamma' type='float' value='2'/><input name='outhigh' type='float' "
             "value='0.8'/></range>",
             0.4f},
            {"<range name='n' type='float'><input name='in' type='float' value='3'/><input "
             "name='doclamp' type='boolean' value='true'/></range>",
             1},
            {"<distance name='n' type='float'><input name='in1' type='vector2' value='3,0'/><input "
             "name='in2' type='vector2' value='0,4'/></distance>",
             5},
            {"<screen name='n' type='float'><input name='fg' type='float' value='0.5'/><input "
             "name='bg' type='float' value='0.5'/></screen>",
             0.75f},
            {"<minus name='n' type='float'><input name='fg' type='float' value='0.2'/><input "
             "name='bg' type='float' value='0.7'/></minus>",
             0.5f},
            {"<not name='b' type='boolean'><input name='in' type='boolean' "
             "value='false'/></not><convert "
             "name='n' type='float'><input name='in' type='boolean' nodename='b'/></convert>",
             1},
            {"<swizzle name='n' type='float'><input name='in' type='color3' "
             "value='0.1,0.2,0.3'/><input "
             "name='channels' type='string' value='b'/></swizzle>",
             0.3f},
            {"<dodge name='n' type='float'><input name='fg' type='float' value='0.5'/><input "
             "name='bg' type='float' value='0.2'/></dodge>",
             0.4f},
            {"<burn name='n' type='float'><input name='fg' type='float' value='0.5'/><input "
             "name='bg' type='float' value='0.8'/></burn>",
             0.6f},
            {"<burn name='n' type='float'><input name='fg' type='float' value='0'/><input "
             "name='bg' type='float' value='0.8'/></burn>",
             0},
            {"<outside name='n' type='float'><input name='in' type='float' value='0.8'/><input "
             "name='mask' type='float' value='0.25'/></outside>",
             0.6f},
            {"<inside name='n' type='float'><input name='in' type='float' value='0.8'/><input "
             "name='mask' type='float' value='0.25'/></inside>",
             0.2f},
            {"<acos name='n' type='float'><input name='in' type='float' value='0.5'/></acos>",
             1.0471976f},
            {"<asin name='n' type='float'><input name='in' type='float' value='0.5'/></asin>",
             0.5235988f},
            {"<atan2 name='n' type='float'><input name='iny' type='float' value='1'/></atan2>",
             0.7853982f},
            {"<switch name='n' type='float'><input name='which' type='integer' value='9'/><input "
             "name='in10' type='float' value='0.7'/></switch>",
             0.7f},
            {"<switch name='n' type='float'><input name='which' type='float' value='5.5'/><input "
             "name='in6' type='float' value='0.6'/></switch>",
             0.6f},
        }) {
        CAPTURE(c.nodes);
        CHECK(number_of(c.nodes) == doctest::Approx(c.value).epsilon(1e-5));
    }
}

TEST_CASE("mtlx graph: noise of several components is that of one, and others beside it") {
    ShadeInput in;
    in.p_object = {0.3f, 0.7f, 0.2f};
    in.uv = {0.3f, 0.7f};
    for (const char* name : {"noise2d", "noise3d", "fractal3d"}) {
        CAPTURE(name);
        const auto node = [&](const char* type, const std::string& inputs) {
            return std::string("<") + name + " name='n' type='" + type + "'>" + inputs + "</" +
                   name + ">";
        };
        const float one = number_of(node("float", input("amplitude", "float", "value='0.5'")), in);
        const Vec3f three =
            color_of(node("color3", input("amplitude", "vector3", "value='0.5,1,2'")), in);
        CHECK(three.x == doctest::Approx(one).epsilon(1e-5));
        const Vec3f even = color_of(node("color3", input("amplitude", "float", "value='0.5'")), in);
        CHECK(near(three, even * Vec3f{1, 2, 4}));
        CHECK(even.x != even.y);
        CHECK(even.y != even.z);
        if (std::string(name) == "fractal3d") continue;
        const Vec3f about = color_of(node("color3", input("amplitude", "float", "value='0.5'") +
                                                        input("pivot", "float", "value='0.25'")),
                                     in);
        CHECK(near(about, even + Vec3f(0.25f)));
    }
}

TEST_CASE("mtlx graph: worley noise of several components holds the distances in their order") {
    ShadeInput in;
    in.p_object = {0.3f, 0.7f, 0.2f};
    in.uv = {0.3f, 0.7f};
    for (const std::string name : {"worleynoise2d", "worleynoise3d"}) {
        CAPTURE(name);
        const float f1 = number_of("<" + name + " name='n' type='float'/>", in);
        const Vec3f f = color_of("<" + name +
                                     " name='w' type='vector3'/><convert name='n' "
                                     "type='color3'>" +
                                     input("in", "vector3", "nodename='w'") + "</convert>",
                                 in);
        CHECK(f.x == f1);
        CHECK(f.x < f.y);
        CHECK(f.y < f.z);
        const std::string pair = "<" + name +
                                 " name='w' type='vector2'/><extract name='n' "
                                 "type='float'>" +
                                 input("in", "vector2", "nodename='w'") +
                                 input("index", "integer", "value='1'") + "</extract>";
        CHECK(number_of(pair, in) == f.y);
        const float cell = number_of("<" + name + " name='n' type='float'>" +
                                         input("style", "integer", "value='1'") + "</" + name + ">",
                                     in);
        CHECK(cell >= 0);
        CHECK(cell < 1);
        CHECK(cell != f1);
    }
}

TEST_CASE("mtlx graph: how a surface faces the viewer takes its inputs") {
    ShadeInput in;
    in.n = {0, 0, 1};
    in.view = {0.6f, 0, -0.8f};
    in.facing = 0.8f;
    const auto ratio = [&](const std::string& inputs) {
        return number_of("<facingratio name='n' type='float'>" + inputs + "</facingratio>", in);
    };
    CHECK(ratio("") == doctest::Approx(0.8f));
    CHECK(ratio(input("invert", "boolean", "value='true'")) == doctest::Approx(0.2f));
    CHECK(ratio(input("normal", "vector3", "value='-1, 0, 0'")) == doctest::Approx(0.6f));
    CHECK(ratio(input("viewdirection", "vector3", "value='0, 3, 4'")) == doctest::Approx(0.8f));
    CHECK(ratio(input("viewdirection", "vector3", "value='0, 3, 4'") +
                input("faceforward", "boolean", "value='false'") +
                input("invert", "boolean", "value='true'")) == doctest::Approx(1.8f));
    CHECK(near(color_of("<viewdirection name='v' type='vector3'/><absval name='a' type='vector3'>" +
                            input("in", "vector3", "nodename='v'") +
                            "</absval><convert name='n' type='color3'>" +
                            input("in", "vector3", "nodename='a'") + "</convert>",
                        in),
               {0.6f, 0, 0.8f}));
}

TEST_CASE("mtlx graph: channels are taken apart and put together") {
    CHECK(
        near(color_of("<combine3 name='a' type='color3'>" + input("in1", "float", "value='0.1'") +
                      input("in2", "float", "value='0.2'") + input("in3", "float", "value='0.3'") +
                      "</combine3><separate3 name='s' type='multioutput'>" +
                      input("in", "color3", "nodename='a'") +
                      "</separate3><combine3 name='n' type='color3'>" +
                      input("in1", "float", "nodename='s' output='outb'") +
                      input("in2", "float", "nodename='s' output='outg'") +
                      input("in3", "float", "nodename='s' output='outr'") + "</combine3>"),
             {0.3f, 0.2f, 0.1f}));
    // Four components: arithmetic reaches the fourth.
    CHECK(number_of(
              "<constant name='c' type='color4'>" + input("value", "color4", "value='1,1,1,0.25'") +
              "</constant><multiply name='p' type='color4'>" +
              input("in1", "color4", "nodename='c'") + input("in2", "float", "value='2'") +
              "</multiply><extract name='n' type='float'>" + input("in", "color4", "nodename='p'") +
              input("index", "integer", "value='3'") + "</extract>") == 0.5f);
}

TEST_CASE("mtlx graph: place2d and rotate2d turn as MaterialX's reference does") {
    ShadeInput in;
    in.uv = {1, 0};
    // A quarter turn of the coordinates clockwise: (1, 0) to (0, -1).
    const std::string tail =
        "<extract name='e' type='float'>" + input("in", "vector2", "nodename='r'") +
        input("index", "integer", "value='1'") + "</extract><add name='n' type='float'>" +
        input("in1", "float", "nodename='e'") + input("in2", "float", "value='2'") + "</add>";
    const std::string place = "<texcoord name='t' type='vector2'/>";
    CHECK(number_of(place + "<rotate2d name='r' type='vector2'>" +
                        input("in", "vector2", "nodename='t'") +
                        input("amount", "float", "value='90'") + "</rotate2d>" + tail,
                    in) == doctest::Approx(1));
    CHECK(number_of(place + "<place2d name='r' type='vector2'>" +
                        input("texcoord", "vector2", "nodename='t'") +
                        input("rotate", "float", "value='90'") + "</place2d>" + tail,
                    in) == doctest::Approx(1));
}

TEST_CASE("mtlx graph: a graph's inputs, a node's own definition and its defaults reach inside") {
    const std::string definition =
        "<nodedef name='ND_half' node='half'><input name='x' type='color3' value='0.4,0.4,0.4'/>"
        "<output name='out' type='color3'/></nodedef><nodegraph name='NG_half' nodedef='ND_half'>"
        "<multiply name='p' type='color3'><input name='in1' type='color3' interfacename='x'/>"
        "<input name='in2' type='float' value='0.5'/></multiply>"
        "<output name='out' type='color3' nodename='p'/></nodegraph>";
    const MtlxFolder folder;
    const auto value = [&](const std::string& text) {
        const SceneDesc scene = folder.load_mtlx(text);
        return value_at(material(scene, "m"), material(scene, "m").base_color);
    };
    const auto with = [&](const std::string& x) {
        return mtlx_surface(
            input("base_color", "color3", "nodegraph='g'"),
            definition +
                "<nodegraph name='g'><input name='tint' type='color3' value='1, 0.5, 0'/>"
                "<half name='a' type='color3'>" +
                x + "</half><half name='b' type='color3'>" + input("x", "color3", "nodename='a'") +
                "</half><output name='o' type='color3' nodename='b'/></nodegraph>");
    };
    CHECK(near(value(with(input("x", "color3", "interfacename='tint'"))), {0.25f, 0.125f, 0}));
    CHECK(near(value(with("")), Vec3f(0.1f)));
    CHECK(folder.refusal(with(input("y", "color3", "value='1,1,1'"))).find("has no input 'y'") !=
          std::string::npos);
}

TEST_CASE("mtlx graph: colours are taken from their colour space to the working space") {
    const MtlxFolder folder;
    const auto red = [&](const std::string& head, const std::string& attributes,
                         const std::string& scene = "") {
        std::string text =
            mtlx_surface(input("base_color", "color3", "value='0.5, 0.5, 0.5' " + attributes));
        text.replace(text.find("version='1.39'"), 14, "version='1.39' " + head);
        return material(folder.load_mtlx(text, scene), "m").base_color.value;
    };
    const float linear = 0.21404114f;  // IEC 61966-2-1 of 0.5
    CHECK(red("", "")[0] == 0.5f);
    CHECK(red("colorspace='srgb_texture'", "")[0] == doctest::Approx(linear));
    CHECK(red("colorspace='lin_rec709'", "colorspace='srgb_texture'")[0] ==
          doctest::Approx(linear));
    CHECK(red("colorspace='srgb_texture'", "colorspace='raw'")[0] == 0.5f);
    // Grey stays grey in other primaries.
    CHECK(red("colorspace='lin_rec709'", "", "[film]\nworking_space = 'acescg'")[0] ==
          doctest::Approx(0.5f).epsilon(1e-3));
    CHECK(folder
              .refusal(
                  mtlx_surface(input("base_color", "color3", "value='1,0,0' colorspace='no_such'")))
              .find("colour space 'no_such': unknown") != std::string::npos);
}

TEST_CASE("mtlx graph: circles are found, through nodes, graphs and definitions") {
    const std::string a =
        "<add name='n' type='color3'>" + input("in1", "color3", "nodename='b'") + "</add>\n";
    const std::string b =
        "<add name='b' type='color3'>" + input("in1", "color3", "nodename='n'") + "</add>";
    CHECK(refusal_of(a + b) == "a.mtlx:8:29: input 'in1': goes in a circle");
    const MtlxFolder folder;
    CHECK(folder
              .refusal(mtlx_surface(
                  input("base_color", "color3", "nodegraph='g'"),
                  "<nodegraph name='g'><input name='i' type='color3' nodegraph='g' "
                  "output='o'/><output name='o' type='color3' interfacename='i'/></nodegraph>"))
              .find("goes in a circle") != std::string::npos);
    CHECK(folder
              .refusal(mtlx_surface(
                  input("base_color", "color3", "nodegraph='g'"),
                  "<nodedef name='D' node='own'><output name='out' type='color3'/></nodedef>"
                  "<nodegraph name='g' nodedef='D'><own name='n' type='color3'/>"
                  "<output name='o' type='color3' nodename='n'/></nodegraph>"))
              .find("own 'n': goes in a circle") != std::string::npos);
}

TEST_CASE("mtlx graph: chains too long and graphs that multiply are refused") {
    std::string chain = "<add name='n0' type='color3'/>";
    for (int i = 1; i <= 600; ++i)
        chain += "<add name='n" + std::to_string(i) + "' type='color3'>" +
                 input("in1", "color3", "nodename='n" + std::to_string(i - 1) + "'") + "</add>";
    const MtlxFolder folder;
    CHECK(folder.refusal(graph_document(chain, "color3", "n600")).find("deeper than 512") !=
          std::string::npos);
    // Many materials, each of them of a graph of many nodes.
    std::string crowd;
    for (int i = 0; i < 3000; ++i)
        crowd +=
            "<add name='n" + std::to_string(i) + "' type='color3'>" +
            (i > 1 ? input("in1", "color3", "nodename='n" + std::to_string(i / 2) + "'") : "") +
            "</add>";
    for (int i = 0; i < 90'000; ++i)
        crowd += "<surfacematerial name='m" + std::to_string(i) + "'>" +
                 input("surfaceshader", "surfaceshader", "nodename='s'") + "</surfacematerial>";
    std::string inputs;
    int wanted = 2990;
    visit_openpbr([&]<class Input>(Input MaterialDesc::*, const OpenPbrInput& info) {
        if constexpr (std::is_same_v<Input, ColorInput>)
            inputs += input(info.name, "color3", "nodename='n" + std::to_string(wanted++) + "'");
    });
    CHECK(folder.refusal(mtlx_surface(inputs, crowd)).find("more than a million nodes") !=
          std::string::npos);
    // Twelve definitions, each of four of the next: sixteen million nodes.
    std::string bombs;
    for (int i = 0; i < 12; ++i) {
        const std::string id = std::to_string(i), next = std::to_string(i + 1);
        bombs += "<nodedef name='D" + id + "' node='bomb" + id +
                 "'><output name='out' type='color3'/></nodedef><nodegraph name='G" + id +
                 "' nodedef='D" + id + "'>";
        for (const char* k : {"a", "b", "c", "d"})
            bombs += "<bomb" + next + " name='" + std::string(k) + "' type='color3'/>";
        bombs += "<add name='x' type='color3'>" + input("in1", "color3", "nodename='a'") +
                 input("in2", "color3", "nodename='b'") + "</add><add name='y' type='color3'>" +
                 input("in1", "color3", "nodename='c'") + input("in2", "color3", "nodename='d'") +
                 "</add><add name='n' type='color3'>" + input("in1", "color3", "nodename='x'") +
                 input("in2", "color3", "nodename='y'") +
                 "</add><output name='out' type='color3' nodename='n'/></nodegraph>";
    }
    bombs +=
        "<nodedef name='D12' node='bomb12'><output name='out' type='color3'/></nodedef>"
        "<nodegraph name='G12' nodedef='D12'><geomcolor name='n' type='color3'/>"
        "<output name='out' type='color3' nodename='n'/></nodegraph>";
    const std::string text = folder.refusal(mtlx_surface(
        input("base_color", "color3", "nodegraph='g'"),
        bombs + "<nodegraph name='g'><bomb0 name='n' type='color3'/><output name='o' type='color3' "
                "nodename='n'/></nodegraph>"));
    CHECK(text.find("more than 4096") != std::string::npos);
}

TEST_CASE("mtlx graph: what does not exist or does not fit is named with its place") {
    struct Case {
        std::string nodes, message;
    };
    for (
        const Case& c : std::initializer_list<Case>{
            {"<curveadjust name='n' type='color3'/>",
             "a.mtlx:8:1: curveadjust 'n': node 'curveadjust' is not read"},
            {"<contras name='n' type='color3'/>",
             "a.mtlx:8:1: contras 'n': node 'contras' is not read (did you mean 'contrast'?)"},
            {"<add name='n' type='color3'>\n" + input("in1", "color3", "nodename='nn'") + "</add>",
             "a.mtlx:9:1: input 'in1': there is no node 'nn'"},
            {"<add name='n' type='color3'>\n" + input("inn1", "color3", "value='1,1,1'") + "</add>",
             "a.mtlx:9:1: add 'n': has no input 'inn1' (did you mean 'in1'?)"},
            {"<add name='n' type='color3'>\n" + input("in1", "color3", "value='1,1'") + "</add>",
             "a.mtlx:9:1: input 'in1': value is '1,1', must be of type color3"},
            {"<add name='n' type='color3'>\n" + input("in1", "color3", "value='1,1,nan'") +
                 "</add>",
             "a.mtlx:9:1: input 'in1': value is '1,1,nan', must be of type color3"},
            {"<add name='n' type='color3'>\n" + input("in1", "vector3", "value='1,1,1'") + "</add>",
             "a.mtlx:9:1: add 'n': in1 is of type vector3, which does not go there (see 'convert', "
             "'extract')"},
            {"<noise2d name='f' type='float'/>\n<add name='n' type='color3'>" +
                 input("in1", "color3", "nodename='f'") + "</add>",
             "a.mtlx:9:29: input 'in1': is of type color3, what it is given of type float (see "
             "'convert', 'extract')"},
            {"<dotproduct name='n' type='color3'/>",
             "a.mtlx:8:1: dotproduct 'n': does not come in type 'color3'"},
            {"<worleynoise3d name='n' type='color3'/>",
             "a.mtlx:8:1: worleynoise3d 'n': does not come in that type"},
            {"<noise3d name='n' type='color3'>" + input("amplitude", "vector2", "value='1,1'") +
                 "</noise3d>",
             "a.mtlx:8:1: noise3d 'n': amplitude is of type vector2, which does not go there"},
            {"<viewdirection name='v' type='vector3'>" +
                 input("space", "string", "value='object'") +
                 "</viewdirection><convert name='n' type='color3'>" +
                 input("in", "vector3", "nodename='v'") + "</convert>",
             "a.mtlx:8:1: viewdirection 'v': space is 'object', only 'world' is here"},
            {"<texcoord name='t' type='vector2'>\n" + input("index", "integer", "value='1'") +
                 "</texcoord><checkerboard name='n' type='color3'>" +
                 input("texcoord", "vector2", "nodename='t'") + "</checkerboard>",
             "a.mtlx:9:1: texcoord 't': index must be 0 here"},
            {"<add name='n' type='color3'>\n" + input("in1", "color3", "interfacename='gone'") +
                 "</add>",
             "a.mtlx:9:1: input 'in1': what it stands in has no input 'gone' to take it from"},
            {"<separate3 name='s' type='multioutput'>" + input("in", "color3", "value='1,1,1'") +
                 "</separate3>\n<combine3 name='n' type='color3'>" +
                 input("in1", "float", "nodename='s' output='outx'") + "</combine3>",
             "a.mtlx:8:1: separate3 's': has no output 'outx' of what it is given"},
        }) {
        CAPTURE(c.nodes);
        CHECK(refusal_of(c.nodes) == c.message);
    }
    const MtlxFolder folder;
    CHECK(folder.refusal(mtlx_surface(input("base_color", "color3", "nodegraph='nowhere'"))) ==
          "a.mtlx:4:1: input 'base_color': there is no nodegraph 'nowhere'");
    CHECK(folder.refusal(
              mtlx_surface(input("base_color", "color3", "nodegraph='g' output='p'"),
                           "<nodegraph name='g'><output name='o' type='color3'/></nodegraph>")) ==
          "a.mtlx:4:1: input 'base_color': nodegraph 'g' has no output 'p'");
}

TEST_CASE("mtlx graph: the normal of the object's own space is refused, the world's is there") {
    const std::string tail =
        "<convert name='n' type='color3'>" + input("in", "vector3", "nodename='v'") + "</convert>";
    CHECK(refusal_of("<normal name='v' type='vector3'/>" + tail) ==
          "a.mtlx:8:1: normal 'v': space is 'object', only 'world' is here");
    ShadeInput in;
    in.n = {0, 1, 0};
    CHECK(near(color_of("<normal name='v' type='vector3'>" +
                            input("space", "string", "value='world'") + "</normal>" + tail,
                        in),
               {0, 1, 0}));
}
