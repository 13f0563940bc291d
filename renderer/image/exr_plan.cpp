#include "renderer/image/exr_plan.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace tessera {

std::string pass_name(const Layer& layer) {
    if (!layer.name.empty()) return layer.name;
    return layer.channels.size() == 1 ? layer.channels[0] : "beauty";
}

namespace {

constexpr std::string_view kPlaceholder = "<aov>";
// Above some 40000 the quantised waves of DWA overshoot half's range and a whole 8x8 block comes
// back infinite (at the coarsest level, measured); a quarter of the range is safe.
constexpr float kLossyLimit = 16384;

[[noreturn]] void fail(const std::string& message) { throw Error(ExitCode::usage, message); }

std::string codec_name(ExrCompression c) { return c == ExrCompression::dwaa ? "dwaa" : "dwab"; }

void check(const LayeredImage& image, const WriteOptions& options) {
    if (!is_lossy(options.compression)) return;
    const std::string codec = codec_name(options.compression);
    if (options.all_float)
        fail("compression " + codec + ": stores colours as halves, float has no use with it");
    if (options.layout != ExrLayout::single) return;
    for (const Layer& layer : image.layers) {
        if (layer.kind == LayerKind::data)
            fail("compression " + codec + ": would damage '" + pass_name(layer) +
                 "', and a single-part file has one codec; use exr multipart or split, where data "
                 "stays lossless, or leave the pass out");
    }
}

// Data that no codec may touch is ZIP where colour is lossy.
ExrCompression codec_of(const Layer& layer, const WriteOptions& options) {
    return layer.kind == LayerKind::data && is_lossy(options.compression) ? ExrCompression::zip
                                                                          : options.compression;
}

/// Channels in the layer's order under the given prefix ("" = bare).
void append(const Layer& layer, const std::string& prefix, bool all_float,
            std::vector<ExrChannel>& out) {
    for (std::size_t i = 0; i < layer.channels.size(); ++i)
        out.push_back({prefix.empty() ? layer.channels[i] : prefix + "." + layer.channels[i],
                       layer.kind == LayerKind::color && !all_float, &layer, static_cast<int>(i)});
}

ExrFile plan_single(const LayeredImage& image, const std::string& path,
                    const WriteOptions& options) {
    ExrPart part{"", options.compression, {}};
    for (const Layer& layer : image.layers)
        append(layer, layer.name, options.all_float, part.channels);
    return {path, {part}, {}};
}

// Every part but beauty has prefixed names: readers that throw all parts into one namespace must
// not meet two channels X. Root Z becomes depth.Z, which is what Nuke calls it, unless a layer is
// called so: then Z.Z.
ExrFile plan_multipart(const LayeredImage& image, const std::string& path,
                       const WriteOptions& options) {
    ExrFile file{path, {}, {}};
    const bool has_depth = std::any_of(image.layers.begin(), image.layers.end(),
                                       [](const Layer& l) { return l.name == "depth"; });
    for (const Layer& layer : image.layers) {
        const std::string pass = pass_name(layer);
        ExrPart part{pass == "Z" && !has_depth ? "depth" : pass, codec_of(layer, options), {}};
        append(layer, pass == "beauty" ? "" : part.name, options.all_float, part.channels);
        file.parts.push_back(std::move(part));
    }
    return file;
}

std::string split_path(const std::string& path, const std::string& pass) {
    const std::size_t at = path.find(kPlaceholder);
    if (at != std::string::npos)
        return path.substr(0, at) + pass + path.substr(at + kPlaceholder.size());
    if (pass == "beauty") return path;
    const std::filesystem::path p(path);
    return (p.parent_path() / (p.stem().string() + "." + pass + p.extension().string())).string();
}

bool is_cryptomatte(const Layer& layer) { return layer.name.starts_with("Crypto"); }

/// Ranks of a cryptomatte belong together: CryptoObject00, 01 ... are one file.
std::string file_pass(const Layer& layer) {
    std::string name = pass_name(layer);
    while (is_cryptomatte(layer) && name.size() > 6 && name.back() >= '0' && name.back() <= '9')
        name.pop_back();
    return name;
}

// Readers that know no layers want R, G, B; what the channels are is told in the header.
void append_bare(const Layer& layer, const WriteOptions& options, ExrFile& file) {
    std::vector<ExrChannel>& channels = file.parts[0].channels;
    append(layer, "", options.all_float, channels);
    std::string names;
    for (const std::string& name : layer.channels) names += (names.empty() ? "" : ",") + name;
    file.metadata.emplace_back("tessera/channels", names);
    // Of a lone channel most readers show luminance only; depth is known by its name.
    if (channels.size() == 1 && channels[0].name != "Z") channels[0].name = "Y";
    if (channels.size() != 3 && channels.size() != 4) return;
    for (std::size_t i = 0; i < channels.size(); ++i) channels[i].name = "RGBA"[i];
}

std::vector<ExrFile> plan_split(const LayeredImage& image, const std::string& path,
                                const WriteOptions& options) {
    std::vector<ExrFile> files;
    for (const Layer& layer : image.layers) {
        const std::string pass = file_pass(layer);
        const std::string name = split_path(path, pass);
        auto file = std::find_if(files.begin(), files.end(),
                                 [&](const ExrFile& f) { return f.path == name; });
        if (file == files.end()) {
            const MetadataValue told(pass);
            file = files.insert(
                file, {name, {{"", codec_of(layer, options), {}}}, {{"tessera/pass", told}}});
        }
        if (is_cryptomatte(layer))
            append(layer, layer.name, options.all_float, file->parts[0].channels);
        else
            append_bare(layer, options, *file);
    }
    std::stable_partition(files.begin(), files.end(), [](const ExrFile& file) {
        return file.metadata[0].second == MetadataValue("beauty");
    });
    return files;
}

std::vector<ExrFile> plan_files(const LayeredImage& image, const std::string& path,
                                const WriteOptions& options) {
    check(image, options);
    if (options.layout == ExrLayout::split) return plan_split(image, path, options);
    if (path.find(kPlaceholder) != std::string::npos)
        fail(path + ": <aov> stands for the pass in file names of exr split only");
    if (options.layout == ExrLayout::multipart) return {plan_multipart(image, path, options)};
    return {plan_single(image, path, options)};
}

}  // namespace

std::vector<ExrFile> plan_exr(const LayeredImage& image, const std::string& path,
                              const WriteOptions& options) {
    std::vector<ExrFile> files = plan_files(image, path, options);
    for (ExrFile& file : files) {
        for (ExrPart& part : file.parts) {
            if (!is_lossy(part.compression)) continue;
            for (ExrChannel& channel : part.channels) channel.limit = kLossyLimit;
        }
    }
    return files;
}

std::vector<std::string> exr_files(const LayeredImage& image, const std::string& path,
                                   const WriteOptions& options) {
    std::vector<std::string> paths;
    for (const ExrFile& file : plan_exr(image, path, options)) paths.push_back(file.path);
    return paths;
}

}  // namespace tessera
