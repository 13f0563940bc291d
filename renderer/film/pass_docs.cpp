#include "renderer/film/pass_docs.h"

#include "renderer/film/pass.h"

namespace tessera {
namespace {

std::string channels_of(const PassInfo& p) {
    std::string out;
    for (const char c : p.channels) out += (out.empty() ? "" : " ") + std::string(1, c);
    return out;
}

std::string padded(std::string_view text, std::size_t width) {
    std::string out(text);
    out.resize(std::max(width, out.size() + 1), ' ');
    return out;
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
    return out;
}

}  // namespace

std::string list_of_passes() {
    std::string text = "Passes (--aov NAME, or film.aovs in a scene):\n";
    for (const PassInfo& p : ready_passes()) {
        text += "  " + padded(p.name, 24) + padded(channels_of(p), 8) + std::string(p.meaning);
        if (!p.expression.empty()) text += "  [" + std::string(p.expression) + "]";
        text += "\n";
    }
    text += "Sets of them:\n";
    for (const PassPreset& p : pass_presets())
        text += "  " + padded(p.name, 24) + std::string(p.meaning) + "\n";
    text +=
        "Of one's own:\n"
        "  light_groups            beauty by light group: RGBA_default, RGBA_<group> ...\n"
        "  PASS@groups             a pass of light by light group: diffuse_key, diffuse_fill ...\n"
        "  NAME=EXPRESSION         light whose paths an expression takes: key=C<RD><L.'key'>\n";
    return text;
}

std::string passes_markdown() {
    std::string text =
        "| pass | channels | stored as | what lies in it | light paths |\n|---|---|---|---|---|\n";
    for (const PassInfo& p : ready_passes()) {
        text += "| `" + std::string(p.name) + "` | " + channels_of(p) + " | " +
                (p.kind == LayerKind::color ? "half" : "float") + " | " + std::string(p.meaning) +
                " | " + (p.expression.empty() ? "" : "`" + escaped(p.expression) + "`") + " |\n";
    }
    text += "\n| set | what for | passes |\n|---|---|---|\n";
    for (const PassPreset& p : pass_presets())
        text += "| `" + std::string(p.name) + "` | " + std::string(p.meaning) + " | " +
                std::string(p.passes) + " |\n";
    return text;
}

}  // namespace tessera
