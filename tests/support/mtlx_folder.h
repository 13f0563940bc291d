#pragma once
// MaterialX documents in a folder of their own, beside a scene that names them.

#include "materials/graph.h"
#include "tests/support/scene_folder.h"

namespace tessera {

inline constexpr const char* kMtlxHead = "<?xml version='1.0'?>\n<materialx version='1.39'>\n";

/// A document of these elements (from line 3 on).
inline std::string mtlx(const std::string& elements) {
    return kMtlxHead + elements + "\n</materialx>\n";
}

/// Material 'm' of a surface of that category and inputs, and elements beside it.
inline std::string mtlx_surface(const std::string& inputs, const std::string& elements = "",
                                const std::string& category = "open_pbr_surface") {
    return mtlx("<" + category + " name='s' type='surfaceshader'>\n" + inputs + "\n</" + category +
                ">\n<surfacematerial name='m' type='material'><input name='surfaceshader' "
                "type='surfaceshader' nodename='s'/></surfacematerial>\n" +
                elements);
}

class MtlxFolder : public SceneFolder {
public:
    SceneDesc load_mtlx(const std::string& text, const std::string& scene = "") const {
        write("a.mtlx", text);
        return load("materialx = ['a.mtlx']\n" + scene);
    }
    /// What reading the document says, without the folder and the hint at --lenient; "" when it
    /// says nothing.
    std::string refusal(const std::string& text, const std::string& scene = "") const {
        write("a.mtlx", text);
        const std::string all = failure("materialx = ['a.mtlx']\n" + scene);
        return all.substr(0, all.find("\n(--lenient"));
    }
    SceneDesc load_leniently(const std::string& text) const {
        write("a.mtlx", text);
        LoadOptions options;
        options.strictness = Strictness::lenient;
        return load_scene(write("s.toml", "tessera = 1\nmaterialx = ['a.mtlx']\n"), options);
    }
};

/// What an input is at a point.
template <class Input>
Vec3f value_at(const MaterialDesc& m, const Input& input, const ShadeInput& in = {}) {
    if (input.node < 0) return Vec3f(input.value);
    Graph graph;
    const Wire wire = graph.add(m.nodes, input.node, input.output);
    GraphRun run(graph, in, nullptr);
    return run.value(wire);
}

}  // namespace tessera
