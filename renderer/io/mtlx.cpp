#include "renderer/io/mtlx.h"

#include <algorithm>
#include <array>

#include "renderer/core/nearest_name.h"
#include "renderer/io/mtlx_surface.h"

namespace tessera {
namespace {

/// Elements that are told of because a reader might miss what they do.
constexpr std::array<std::string_view, 10> kIgnored{
    "look",        "lookgroup",  "materialassign", "collection", "geominfo",
    "propertyset", "variantset", "geomattr",       "property",   "attributedef"};

template <std::size_t n>
bool is_in(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

class MaterialXReader {
public:
    MaterialXReader(const MtlxDocument& document, SceneReader& reader, const ColorSpaces& colors)
        : reading_{document, reader, colors}, reader_(reader) {
        for (const MtlxElement* one : document.top()) {
            const std::string* defines = one->category == "nodedef" ? one->find("node") : nullptr;
            if (defines) reading_.definitions.emplace(*defines, one);
        }
    }

    /// written: where and how the scene names the document.
    void read(const Value& written) {
        const std::size_t before = reader_.materialx.size();
        bool some = false;
        for (const MtlxElement* one : reading_.document.top()) {
            const bool old = one->category == "material";  // before 1.38
            if (old || one->category == "surfacematerial") {
                some = true;
                read_material(*one, old);
            } else if (is_in(kIgnored, one->category)) {
                reader_.problems.warn(one->loc, one->subject() +
                                                    " is not used: the scene says "
                                                    "what has which material");
            }
        }
        if (!some && reader_.materialx.size() == before)
            reading_.damage(written.loc,
                            "materialx: '" + *written.text() + "' holds no surfacematerial");
    }

private:
    void read_material(const MtlxElement& element, bool old) {
        const std::string name = element.name();
        if (name.empty()) return reading_.damage(element.loc, element.category + " has no name");
        MaterialDesc material;
        material.name = name;
        material.loc = element.loc;
        MtlxGraph graph(reading_, material);
        const auto shader = old ? shader_reference(element, graph) : surface_of(element, graph);
        if (!shader) return;
        const std::string& category = shader_category(shader->node);
        if (category == "open_pbr_surface") {
            read_open_pbr_surface(graph, *shader);
        } else if (category == "standard_surface") {
            read_standard_surface(graph, *shader);
        } else {
            const std::vector<std::string> known{"open_pbr_surface", "standard_surface"};
            return reading_.damage(shader->node.loc,
                                   shader->node.subject() + ": surface '" + category +
                                       "' is not read, 'open_pbr_surface' and 'standard_surface' "
                                       "are");
        }
        const auto [held, is_new] = reader_.materialx.emplace(name, material);
        if (!is_new)
            reading_.damage(element.loc, element.subject() + ": the name stands for another at " +
                                             to_string(held->second.loc) + " already");
    }

    static const std::string& shader_category(const MtlxElement& shader) {
        const std::string* node = shader.category == "shaderref" ? shader.find("node") : nullptr;
        return node ? *node : shader.category;
    }

    std::optional<MtlxGraph::NodeAt> surface_of(const MtlxElement& element, MtlxGraph& graph) {
        for (const MtlxElement* input : element.children) {
            const bool connected = input->find("nodename") || input->find("nodegraph");
            if (input->name() != "surfaceshader" && connected)
                reading_.damage(input->loc, element.subject() + ": " + input->name() +
                                                " is not read, only surfaceshader is");
        }
        const MtlxElement* input = element.child("surfaceshader");
        if (input) return graph.shader(*input, graph.root());
        reading_.damage(element.loc, element.subject() + ": has no surfaceshader");
        return std::nullopt;
    }

    std::optional<MtlxGraph::NodeAt> shader_reference(const MtlxElement& element,
                                                      MtlxGraph& graph) {
        for (const MtlxElement* one : element.children)
            if (one->category == "shaderref")
                return MtlxGraph::NodeAt{*one, graph.root(), MtlxType::other};
        reading_.damage(element.loc, element.subject() + ": has no shaderref");
        return std::nullopt;
    }

    MtlxReading reading_;
    SceneReader& reader_;
};

}  // namespace

void read_materialx(const Value& document, SceneReader& reader) {
    const Value* files = document.find("materialx");
    if (!files || !files->list()) return;  // what is no list is reported with the other keys
    const ColorSpaces colors(reader.scene.film.working_space);
    for (const Value& file : *files->list()) {
        if (!file.text()) continue;
        const AssetPath found = reader.find(*file.text(), file.loc);
        if (!found.note.empty()) reader.problems.note(file.loc, "materialx: " + found.note);
        if (found.path.empty()) {
            reader.problems.error(file.loc,
                                  "materialx: file '" + *file.text() + "' " + found.reason);
            continue;
        }
        const MtlxDocument read(found.path, file.loc, reader);
        MaterialXReader(read, reader, colors).read(file);
    }
}

void place_materialx(SceneReader& reader) {
    std::vector<MaterialDesc>& all = reader.scene.materials;
    for (const auto& [name, material] : reader.materialx) {
        bool placed = false;
        for (MaterialDesc& held : all) {
            if (held.name != name) continue;
            if (held.loc.file)
                reader.problems.note(
                    material.loc, "material '" + name + "' replaces the one of the OBJ's library");
            held = material;
            placed = true;
        }
        if (!placed) all.push_back(material);
    }
}

}  // namespace tessera
