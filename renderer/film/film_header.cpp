#include "renderer/film/film_header.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tessera {
namespace {

using nlohmann::json;

constexpr int kMaxSide = 1 << 20;
constexpr std::size_t kMaxPasses = 10000;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 32;

// In files: enumerators may move.
const char* name_of(PassSource source) {
    switch (source) {
        case PassSource::z:
            return "z";
        case PassSource::depth:
            return "depth";
        case PassSource::p:
            return "p";
        case PassSource::pref:
            return "pref";
        case PassSource::uv:
            return "uv";
        case PassSource::n:
            return "n";
        case PassSource::ng:
            return "ng";
        case PassSource::facing:
            return "facing";
        case PassSource::albedo:
            return "albedo";
        case PassSource::event_albedo:
            return "event_albedo";
        case PassSource::light_paths:
            return "light_paths";
        case PassSource::shadow:
            return "shadow";
        case PassSource::shadow_matte:
            return "shadow_matte";
        case PassSource::ao:
            return "ao";
        case PassSource::object_id:
            return "object_id";
        case PassSource::material_id:
            return "material_id";
        case PassSource::crypto_object:
            return "crypto_object";
        case PassSource::crypto_material:
            return "crypto_material";
        case PassSource::crypto_asset:
            return "crypto_asset";
        case PassSource::sample_count:
            return "sample_count";
        case PassSource::seconds:
            return "seconds";
        case PassSource::variance:
            return "variance";
        case PassSource::standard_error:
            return "standard_error";
    }
    return "";
}

PassSource source_of(const std::string& name) {
    for (int i = 0; i <= 255; ++i) {
        const auto source = static_cast<PassSource>(i);
        if (name == name_of(source)) return source;
    }
    throw std::runtime_error("unknown source of a pass '" + name + "'");
}

std::int64_t whole(const json& j, const char* key, std::int64_t low, std::int64_t high) {
    const json& v = j.at(key);
    const bool fits =
        v.is_number_integer() &&
        !(v.is_number_unsigned() && v.get<std::uint64_t>() > static_cast<std::uint64_t>(high)) &&
        v.get<std::int64_t>() >= low && v.get<std::int64_t>() <= high;
    if (!fits) throw std::runtime_error(std::string(key) + " is " + v.dump());
    return v.get<std::int64_t>();
}

int small(const json& j, const char* key, int low, int high) {
    return static_cast<int>(whole(j, key, low, high));
}

json metadata_json(const FilmHeader& h) {
    json out = json::array();
    for (const auto& [name, value] : h.metadata)
        std::visit([&, &n = name](const auto& v) { out.push_back({n, v}); }, value);
    return out;
}

MetadataValue metadata_value(const json& v) {
    if (v.is_number_integer()) return v.get<int>();
    if (v.is_number()) return v.get<float>();
    return v.get<std::string>();
}

Pass pass_from(const json& j) {
    Pass p;
    p.name = j.at("name");
    p.channels = j.at("channels").get<std::vector<std::string>>();
    const std::string kind = j.at("kind");
    if (kind != "color" && kind != "data") throw std::runtime_error("unknown kind of a pass");
    p.kind = kind == "color" ? LayerKind::color : LayerKind::data;
    p.source = source_of(j.at("source"));
    p.expression = j.at("expression");
    p.events = static_cast<std::uint32_t>(whole(j, "events", 0, 0xffffffff));
    p.group = small(j, "group", -1, 0xffff);
    return p;
}

PixelWindow window_from(const json& j) {
    const auto c = j.at("window").get<std::vector<std::int64_t>>();
    const bool sane = c.size() == 4 && std::all_of(c.begin(), c.end(), [](std::int64_t v) {
                          return v >= -kMaxSide && v <= kMaxSide;
                      });
    if (!sane || c[0] >= c[2] || c[1] >= c[3] || (c[2] - c[0]) * (c[3] - c[1]) > kMaxPixels)
        throw std::runtime_error("window is " + j.at("window").dump());
    return {static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]),
            static_cast<int>(c[3])};
}

std::string text_of(const Pass& p) {
    std::string text = p.name.empty() ? p.channels.front() : p.name;
    if (!p.expression.empty()) text += " = " + p.expression;
    return text;
}

bool same(const Pass& a, const Pass& b) {
    return a.name == b.name && a.channels == b.channels && a.kind == b.kind &&
           a.source == b.source && a.expression == b.expression && a.events == b.events &&
           a.group == b.group;
}

std::optional<FilmDifference> pass_difference(const Passes& a, const Passes& b) {
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
        if (i < a.size() && i < b.size() && same(a[i], b[i])) continue;
        return FilmDifference{"pass " + std::to_string(i + 1),
                              i < a.size() ? "'" + text_of(a[i]) + "'" : "none",
                              i < b.size() ? "'" + text_of(b[i]) + "'" : "none"};
    }
    return std::nullopt;
}

}  // namespace

std::string to_string(const PixelWindow& w) {
    return std::to_string(w.x0) + "," + std::to_string(w.y0) + "," + std::to_string(w.x1) + "," +
           std::to_string(w.y1);
}

std::string to_json(const FilmHeader& h) {
    json passes = json::array();
    for (std::size_t i = 0; i < h.passes.size(); ++i) {
        const Pass& p = h.passes[i];
        passes.push_back({{"name", p.name},
                          {"channels", p.channels},
                          {"kind", p.kind == LayerKind::color ? "color" : "data"},
                          {"source", name_of(p.source)},
                          {"expression", p.expression},
                          {"events", p.events},
                          {"group", p.group},
                          {"ids", h.ids.at(i)}});
    }
    const json j = {
        {"version", h.version},
        {"isa", h.isa},
        {"scene", h.scene},
        {"scene_hash", h.scene_hash},
        {"working_space", h.working_space},
        {"width", h.width},
        {"height", h.height},
        {"window", {h.window.x0, h.window.y0, h.window.x1, h.window.y1}},
        {"seed", h.seed},
        {"passes", passes},
        {"deep", h.extras.deep},
        {"replicates", h.extras.replicates},
        {"first_sample", h.first_sample},
        {"least_samples", h.least},
        {"most_samples", h.most},
        {"seconds", h.seconds},
        {"parts", h.parts},
        {"metadata", metadata_json(h)},
    };
    // A file name need not be UTF-8.
    return j.dump(1, ' ', false, json::error_handler_t::replace);
}

FilmHeader film_header_from(const std::string& text) {
    const json j = json::parse(text);
    FilmHeader h;
    h.version = j.at("version");
    h.isa = j.at("isa");
    h.scene = j.at("scene");
    h.scene_hash = j.at("scene_hash");
    h.working_space = j.at("working_space");
    h.width = small(j, "width", 1, kMaxSide);
    h.height = small(j, "height", 1, kMaxSide);
    h.window = window_from(j);
    h.seed = j.at("seed").get<std::uint64_t>();
    for (const json& p : j.at("passes")) {
        h.passes.push_back(pass_from(p));
        h.ids.push_back(p.at("ids").get<std::vector<std::uint32_t>>());
        const Pass& pass = h.passes.back();
        const bool of_beauty =
            pass.source == PassSource::variance || pass.source == PassSource::standard_error;
        const std::size_t most = of_beauty ? 3 : 4;
        if (pass.channels.empty() || pass.channels.size() > most || h.passes.size() > kMaxPasses)
            throw std::runtime_error("passes that no scene has");
    }
    h.extras = {j.at("deep"), j.at("replicates"), h.seed};
    constexpr int kMost = std::numeric_limits<int>::max();
    h.first_sample = small(j, "first_sample", 0, kMost);
    h.least = static_cast<std::uint32_t>(whole(j, "least_samples", 0, kMost));
    h.most = static_cast<std::uint32_t>(whole(j, "most_samples", h.least, kMost));
    h.seconds = j.at("seconds");
    h.parts = small(j, "parts", 1, kMost);
    for (const json& m : j.at("metadata"))
        h.metadata.emplace_back(m.at(0).get<std::string>(), metadata_value(m.at(1)));
    return h;
}

std::optional<FilmDifference> difference(const FilmHeader& a, const FilmHeader& b) {
    const auto unequal = [](const char* what, const auto& x,
                            const auto& y) -> std::optional<FilmDifference> {
        if (x == y) return std::nullopt;
        return FilmDifference{what, x, y};
    };
    const auto size = [](const FilmHeader& h) {
        return std::to_string(h.width) + "x" + std::to_string(h.height);
    };
    if (const auto d = unequal("version of Tessera", a.version, b.version)) return d;
    if (const auto d = unequal("resolution", size(a), size(b))) return d;
    if (const auto d = unequal("seed", std::to_string(a.seed), std::to_string(b.seed))) return d;
    if (const auto d = pass_difference(a.passes, b.passes)) return d;
    const auto kept = [](bool yes) { return yes ? "kept" : "not kept"; };
    const FilmExtras &x = a.extras, &y = b.extras;
    if (x.deep != y.deep)
        return FilmDifference{"set of depths (--deep)", kept(x.deep), kept(y.deep)};
    if (x.replicates != y.replicates)
        return FilmDifference{"set of replicates (--no-error-estimate)", kept(x.replicates),
                              kept(y.replicates)};
    if (const auto d = unequal("working space", a.working_space, b.working_space)) return d;
    if (const auto d = unequal("instruction set (--isa)", a.isa, b.isa)) return d;
    if (const auto d = unequal("hash of the scene and its files", a.scene_hash, b.scene_hash))
        return d;
    if (a.ids != b.ids) return FilmDifference{"names for mattes", "others", "others"};
    return std::nullopt;
}

}  // namespace tessera
