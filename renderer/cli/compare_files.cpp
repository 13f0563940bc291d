#include "renderer/cli/compare_files.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <set>

#include "renderer/api/error.h"
#include "renderer/film/film_file.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/exr_layers.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_io.h"
#include "renderer/image/pass_names.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

bool is_id_layer(const std::string& name) {
    constexpr std::array<std::string_view, 8> kIds{"id",         "objectid",    "object_id",
                                                   "materialid", "material_id", "indexob",
                                                   "indexma",    "asset_id"};
    std::string lower = name;
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return std::find(kIds.begin(), kIds.end(), lower) != kIds.end();
}

bool is_beauty(const std::string& channel) {
    return channel == "R" || channel == "G" || channel == "B" || channel == "A" || channel == "Y";
}

// Channels of one name in one layer, whatever their type; those of the root that are no beauty each
// by themselves.
std::vector<Layer> regroup(std::vector<Layer> layers, std::size_t pixels) {
    std::vector<Layer> out;
    for (Layer& from : layers) {
        const std::size_t count = from.channels.size();
        const bool alone = from.name.empty() && !is_beauty(from.channels[0]);
        const auto known = std::find_if(out.begin(), out.end(), [&](const Layer& l) {
            return !alone && l.name == from.name && (!l.name.empty() || is_beauty(l.channels[0]));
        });
        if (known == out.end() && (!alone || count == 1)) {
            out.push_back(std::move(from));
            continue;
        }
        for (std::size_t c = 0; c < count; ++c) {
            if (alone) out.push_back({"", {}, from.kind, {}});
            Layer& to = alone ? out.back() : *known;
            const std::size_t had = to.channels.size();
            std::vector<float> merged;
            merged.reserve(pixels * (had + 1));
            for (std::size_t i = 0; i < pixels; ++i) {
                for (std::size_t k = 0; k < had; ++k) merged.push_back(to.pixels[i * had + k]);
                merged.push_back(from.pixels[i * count + c]);
            }
            to.channels.push_back(from.channels[c]);
            to.pixels = std::move(merged);
        }
    }
    return out;
}

std::string text_of(const LayeredImage& image, const std::string& name) {
    for (const auto& [key, value] : image.metadata)
        if (key == name && std::holds_alternative<std::string>(value))
            return std::get<std::string>(value);
    return {};
}

ComparedPicture read_layers(const std::string& path) {
    ComparedPicture picture;
    picture.image = read_exr(path);
    const PixelWindow& w = picture.image.window;
    picture.image.layers =
        regroup(std::move(picture.image.layers),
                static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height()));
    picture.scene_hash = text_of(picture.image, "tessera/sceneHash");
    picture.seed = text_of(picture.image, "tessera/seed");
    return picture;
}

std::vector<std::string> channel_names(int count) {
    switch (count) {
        case 1:
            return {"Y"};
        case 2:
            return {"Y", "A"};
        case 3:
            return {"R", "G", "B"};
        case 4:
            return {"R", "G", "B", "A"};
        default:
            break;
    }
    std::vector<std::string> names;
    for (int c = 0; c < count; ++c) names.push_back("channel" + std::to_string(c));
    return names;
}

ComparedPicture read_flat(const std::string& path) {
    ComparedPicture picture;
    picture.encoded = !image_info(path).is_float;
    Image image = read_image(path);
    picture.image.width = image.width, picture.image.height = image.height;
    picture.image.window = {0, 0, image.width, image.height};
    picture.image.layers.push_back(
        {"", channel_names(image.channels), LayerKind::color, std::move(image.pixels)});
    return picture;
}

std::vector<std::string> matches(const std::string& pattern) {
    std::error_code none;
    if (pattern.find_first_of("*?[") == std::string::npos || fs::exists(pattern, none))
        return {pattern};
    ::glob_t found{};
    const int code = ::glob(pattern.c_str(), 0, nullptr, &found);
    const std::unique_ptr<::glob_t, void (*)(::glob_t*)> guard(&found, ::globfree);
    if (code != 0 || found.gl_pathc == 0)
        throw Error(ExitCode::scene, pattern + ": no file matches the pattern");
    return {found.gl_pathv, found.gl_pathv + found.gl_pathc};
}

}  // namespace

const Layer* ComparedPicture::find(const std::string& name) const {
    for (const Layer& layer : image.layers)
        if (title_of(layer) == name) return &layer;
    return nullptr;
}

const Layer* counterpart(const Layer& layer, const ComparedPicture& picture,
                         const ComparedPicture& other) {
    const std::string title = title_of(layer);
    if (const Layer* const same = other.find(title)) return same;
    if (title != "Z" && title != "depth") return nullptr;
    const char* const alias = title == "Z" ? "depth" : "Z";
    return picture.find(alias) ? nullptr : other.find(alias);
}

ComparedPicture read_compared(const std::string& path) {
    if (names_film_file(path))
        throw Error(ExitCode::scene,
                    path + ": is a film file, no picture (tessera merge " + path + " -o FILE.exr)");
    ComparedPicture picture =
        sniff_image(path) == ImageFormat::exr ? read_layers(path) : read_flat(path);
    picture.path = path;
    return picture;
}

std::string title_of(const Layer& layer) {
    if (!layer.name.empty()) return layer.name;
    return is_beauty(layer.channels[0]) || layer.channels.size() > 1 ? "beauty" : layer.channels[0];
}

LayerContent content_of(const Layer& layer) {
    const std::string title = title_of(layer);
    if (is_cryptomatte_pass(title) || is_id_layer(title)) return LayerContent::ids;
    if (is_data_pass(title)) return LayerContent::data;
    const auto has = [&](const char* name) {
        return std::find(layer.channels.begin(), layer.channels.end(), name) !=
               layer.channels.end();
    };
    const bool colour = (has("R") && has("G") && has("B")) || has("Y");
    return colour && !has("X") ? LayerContent::colour : LayerContent::data;
}

ToLight to_light(const ComparedPicture& picture) {
    if (picture.encoded)
        return [](std::span<float> rgb) {
            for (float& v : rgb) v = srgb_to_linear(v);
        };
    const std::string& space = picture.image.working_space;
    if (space.empty() || space == "lin_rec709") return {};
    return [space, spaces = std::make_shared<ColorSpaces>("lin_rec709")](std::span<float> rgb) {
        spaces->to_working(rgb, space);
    };
}

std::vector<std::string> expand_files(const std::string& text) {
    std::vector<std::string> files;
    std::error_code none;
    if (fs::exists(text, none)) return {text};
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        if (comma == at) throw Error(ExitCode::usage, "'" + text + "': a file's name is empty");
        for (std::string& file : matches(text.substr(at, comma - at)))
            files.push_back(std::move(file));
        at = comma + 1;
    }
    std::set<std::string> seen;
    for (const std::string& file : files) {
        const fs::path real = fs::weakly_canonical(file, none);
        if (!seen.insert(real.string()).second)
            throw Error(ExitCode::usage, file + ": is given twice, which is not two seeds");
    }
    return files;
}

}  // namespace tessera
