#include "renderer/film/pass.h"

#include <algorithm>
#include <cctype>

#include "renderer/core/light_event.h"
#include "renderer/core/nearest_name.h"
#include "renderer/film/blame.h"

namespace tessera {
namespace {

constexpr std::size_t kLongestName = 31;  // what compositors take
constexpr std::size_t kMostPasses = 1000;

constexpr std::uint32_t bits(std::initializer_list<LobeEvent> events) {
    std::uint32_t b = 0;
    for (const LobeEvent e : events) b |= 1u << static_cast<int>(e);
    return b;
}
using E = LobeEvent;
using S = PassSource;
constexpr LayerKind kColor = LayerKind::color, kData = LayerKind::data;

constexpr PassInfo light(std::string_view name, std::string_view expression,
                         std::string_view meaning) {
    return {name, "RGB", S::light_paths, kColor, expression, 0, meaning};
}
constexpr PassInfo data(std::string_view name, std::string_view channels, S source,
                        std::string_view meaning) {
    return {name, channels, source, kData, {}, 0, meaning};
}
constexpr PassInfo albedo(std::string_view name, std::uint32_t events, std::string_view meaning) {
    return {name, "RGB", S::event_albedo, kColor, {}, events, meaning};
}

constexpr std::string_view kStraight =
    "of it, straight from lamps, glowing surfaces and surroundings";
constexpr std::string_view kByOthers = "of it, by way of other surfaces";

constexpr PassInfo kReady[] = {
    data("Z", "Z", S::z, "depth along the camera's axis, of the nearest sample; 1e10: nothing"),
    data("depth", "Z", S::depth, "the same depth, filtered: the mean over the samples that hit"),
    data("P", "XYZ", S::p, "position in the world, of the nearest sample"),
    data("Pref", "XYZ", S::pref, "position in the object's own space, before it is placed"),
    data("N", "XYZ", S::n, "shading normal in the world, facing the camera; the mean"),
    data("Ng", "XYZ", S::ng, "geometric normal in the world, facing the camera; the mean"),
    data("uv", "UVA", S::uv, "texture coordinates of the nearest sample; A: 1 where there are any"),
    data("facing", "A", S::facing, "cosine between shading normal and view; the mean"),
    data("object_id", "V", S::object_id, "number of the object, from 1; of the nearest sample"),
    data("material_id", "V", S::material_id, "number of the material, from 1; likewise"),
    data("CryptoObject", "RGBA", S::crypto_object, "Cryptomatte of objects, three layers"),
    data("CryptoMaterial", "RGBA", S::crypto_material, "Cryptomatte of materials"),
    data("CryptoAsset", "RGBA", S::crypto_asset, "Cryptomatte of instances"),

    light("direct", "C.[LOB]", "light that was scattered once"),
    light("indirect", "C..+[LOB]", "light that was scattered more than once"),
    light("emission", "C[LO]", "lamps and glowing surfaces as the camera sees them"),
    light("background", "CB", "the surroundings as the camera sees them"),
    light("diffuse", "C'diffuse'.*[LOB]", "diffuse reflection, direct and indirect"),
    light("diffuse_direct", "C'diffuse'[LOB]", kStraight),
    light("diffuse_indirect", "C'diffuse'.+[LOB]", kByOthers),
    light("specular", "C'specular'.*[LOB]", "metal and dielectric reflection, rough and smooth"),
    light("specular_direct", "C'specular'[LOB]", kStraight),
    light("specular_indirect", "C'specular'.+[LOB]", kByOthers),
    light("coat", "C'coat'.*[LOB]", "reflection of the coat"),
    light("coat_direct", "C'coat'[LOB]", kStraight),
    light("coat_indirect", "C'coat'.+[LOB]", kByOthers),
    light("transmission", "C'transmission'.*[LOB]", "light through glass and thin sheets"),
    light("transmission_direct", "C'transmission'[LOB]", kStraight),
    light("transmission_indirect", "C'transmission'.+[LOB]", kByOthers),
    light("sss", "C'sss'.*[LOB]", "subsurface: in, scattered about, and out again"),
    light("sss_direct", "C'sss'[LOB]", kStraight),
    light("sss_indirect", "C'sss'.+[LOB]", kByOthers),
    light("sheen", "C'sheen'.*[LOB]", "fuzz"),
    light("sheen_direct", "C'sheen'[LOB]", kStraight),
    light("sheen_indirect", "C'sheen'.+[LOB]", kByOthers),
    light("volume", "C'volume'.*[LOB]", "scattering in what the camera is inside of"),
    light("volume_direct", "C'volume'[LOB]", kStraight),
    light("volume_indirect", "C'volume'.+[LOB]", kByOthers),

    {"albedo",
     "RGB",
     S::albedo,
     kColor,
     {},
     0,
     "white light that the surface reflects, at most 1; behind mirrors and clear glass that of "
     "what is seen there"},
    albedo("diffuse_albedo", bits({E::diffuse}), "of the first surface, diffuse lobes alone"),
    albedo("specular_albedo", bits({E::specular, E::mirror}),
           "its metal and dielectric reflection, that of glass too"),
    albedo("coat_albedo", bits({E::coat, E::coat_mirror}), "its coat"),
    albedo("transmission_albedo", bits({E::transmission, E::clear_transmission}),
           "what glass and thin sheets let through"),
    albedo("sss_albedo", bits({E::sss}), "its subsurface"),
    albedo("sheen_albedo", bits({E::sheen}), "its fuzz"),

    {"shadow",
     "RGB",
     S::shadow,
     kColor,
     {},
     0,
     "light of lamps that shadows keep from the first surface"},
    data("shadow_matte", "A", S::shadow_matte,
         "the share of that light which they keep: 0 lit, 1 dark"),
    data("ao", "A", S::ao, "ambient occlusion of the first surface: 1 open, 0 shut in"),
    data("sample_count", "A", S::sample_count, "samples in the pixel"),
    data("seconds", "A", S::seconds, "time spent on the pixel; not the same from run to run"),
    data("variance", "RGB", S::variance,
         "of beauty's mean, as if its samples were independent: as a rule too much"),
    data("standard_error", "RGB", S::standard_error,
         "of beauty, from four runs of its samples: right on the mean, rough in each "
         "pixel"),
};

constexpr PassPreset kPresets[] = {
    {"basic", "Z N P albedo", "what is written when nothing is asked for"},
    {"compositing",
     "Z CryptoObject CryptoMaterial diffuse_direct diffuse_indirect specular_direct "
     "specular_indirect coat_direct "
     "coat_indirect transmission_direct transmission_indirect sss_direct sss_indirect sheen_direct "
     "sheen_indirect volume_direct volume_indirect emission background",
     "beauty taken apart, whose colours add up to it; depth and mattes"},
    {"lookdev",
     "Z P Pref N Ng uv facing ao diffuse specular coat transmission sss sheen volume emission "
     "background albedo diffuse_albedo specular_albedo coat_albedo transmission_albedo sss_albedo "
     "sheen_albedo shadow shadow_matte",
     "surfaces: lobes, their albedos, and geometry"},
    {"cryptomatte", "CryptoObject CryptoMaterial CryptoAsset", "mattes of everything by name"},
    {"denoise", "albedo N Z variance", "what denoisers take beside beauty"},
    {"debug",
     "Z P N Ng uv facing object_id material_id sample_count seconds variance standard_error",
     "what to look at when something is wrong"},
};

std::vector<std::string> channels_of(std::string_view letters) {
    std::vector<std::string> out;
    for (const char c : letters) out.emplace_back(1, c);
    return out;
}

std::string trimmed(std::string_view s) {
    while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
    while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
    return std::string(s);
}

struct Chooser {
    const std::vector<std::string>& groups;
    const SourceLoc& loc;
    Passes out;

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(blame(loc), loc, message);
    }

    static const PassInfo* find(std::string_view name) {
        const auto* it = std::find_if(std::begin(kReady), std::end(kReady),
                                      [&](const PassInfo& p) { return p.name == name; });
        return it == std::end(kReady) ? nullptr : it;
    }

    void add(Pass pass) {
        const auto same = [&](const Pass& p) {
            return p.name == pass.name && p.channels == pass.channels;
        };
        const auto it = std::find_if(out.begin(), out.end(), same);
        if (it == out.end() && out.size() >= kMostPasses)
            fail("more than " + std::to_string(kMostPasses) + " passes");
        if (it == out.end()) return out.push_back(std::move(pass));
        if (it->expression != pass.expression || it->group != pass.group)
            fail("pass '" + pass.name + "' is there twice, with different expressions");
    }

    void ready(const PassInfo& info) {
        const bool root = info.source == S::z;
        add({root ? "" : std::string(info.name), channels_of(info.channels), info.kind, info.source,
             std::string(info.expression), info.events, -1});
    }

    void one(const std::string& entry) {
        if (const auto equals = entry.find('='); equals != std::string::npos)
            return own(trimmed(entry.substr(0, equals)), trimmed(entry.substr(equals + 1)));
        const std::string name = trimmed(entry);
        if (name == "beauty") return;
        if (name == "light_groups") return by_group("RGBA", "C.*[LOB]");
        if (const auto at = name.find("@groups"); at != std::string::npos && at + 7 == name.size())
            return split(name.substr(0, at));
        if (const PassInfo* info = find(name)) return ready(*info);
        for (const PassPreset& preset : kPresets) {
            if (preset.name == name) return all_of(preset.passes);
        }
        unknown(name);
    }

    void all_of(std::string_view names) {
        while (!names.empty()) {
            const std::size_t end = std::min(names.find(' '), names.size());
            ready(*find(names.substr(0, end)));
            names.remove_prefix(std::min(end + 1, names.size()));
        }
    }

    [[noreturn]] void unknown(const std::string& name) const {
        std::vector<std::string> names{"beauty", "light_groups"};
        for (const PassPreset& p : kPresets) names.emplace_back(p.name);
        for (const PassInfo& p : kReady) names.emplace_back(p.name);
        fail("pass '" + name + "' is unknown" + did_you_mean(name, names) +
             "; `tessera render --list-aovs` shows them all, and \"name = C<RD>L\" makes one");
    }

    void split(const std::string& name) {
        if (name == "beauty") return by_group("RGBA", "C.*[LOB]");
        const PassInfo* info = find(name);
        if (!info) unknown(name);
        if (info->source != S::light_paths)
            fail("pass '" + name + "' is not made of light and has no light groups");
        by_group(name, std::string(info->expression));
    }

    void by_group(const std::string& name, const std::string& expression) {
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const std::string layer = name + "_" + groups[g];
            check_name(layer);
            add({layer, channels_of("RGB"), kColor, S::light_paths, expression, 0,
                 static_cast<int>(g)});
        }
    }

    void own(const std::string& name, const std::string& expression) {
        if (expression.empty()) fail("pass '" + name + "' has no expression after '='");
        if (find(name)) fail("pass '" + name + "' is a ready one: give yours another name");
        check_name(name);
        if (name == "beauty" || name == "light_groups")
            fail("'" + name + "' is what is there already: give yours another name");
        if (name.starts_with("Crypto"))
            fail("'" + name + "': names that begin with Crypto are those of Cryptomatte's layers");
        add({name, channels_of("RGB"), kColor, S::light_paths, expression, 0, -1});
    }

    void check_name(const std::string& name) const {
        const auto is_word = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
        };
        if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0])) ||
            !std::all_of(name.begin(), name.end(), is_word))
            fail("'" + name + "' is no name for a pass: letters, digits and _, a letter first");
        if (name.size() > kLongestName)
            fail("'" + name + "' is longer than 31 characters, more than Blender reads");
        // Nuke takes these for the eyes of a stereo picture.
        const auto is_of = [&](const std::string& eye) {
            return name == eye || name.starts_with(eye + "_") || name.ends_with("_" + eye);
        };
        for (const char* eye : {"left", "right"}) {
            if (is_of(eye))
                fail("'" + name + "': Nuke takes '" + eye + "' for a view and loses the pass");
        }
    }
};

}  // namespace

std::span<const PassInfo> ready_passes() { return kReady; }
std::span<const PassPreset> pass_presets() { return kPresets; }

Passes choose_passes(const std::vector<std::string>& names, const std::vector<std::string>& groups,
                     const SourceLoc& loc) {
    Chooser chooser{groups, loc, {}};
    if (names.empty()) chooser.one("basic");
    for (const std::string& name : names) chooser.one(name);
    return std::move(chooser.out);
}

bool needs_path(const Passes& passes) {
    return std::any_of(passes.begin(), passes.end(), [](const Pass& p) {
        return p.source == S::light_paths || p.source == S::event_albedo || p.source == S::shadow ||
               p.source == S::shadow_matte || p.source == S::ao;
    });
}

}  // namespace tessera
