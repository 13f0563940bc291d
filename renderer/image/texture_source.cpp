#include "renderer/image/texture_source.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <new>

#include "renderer/image/colour_names.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/image_format.h"
#include "renderer/image/pixel_reader.h"

namespace tessera {
namespace {

constexpr std::size_t kNamedUsers = 4;

/// The library picks its reader by extension, so only a name that tells the truth may go there.
bool extension_agrees(const std::string& path, ImageFormat format) {
    std::string e = std::filesystem::path(path).extension().string();
    std::transform(e.begin(), e.end(), e.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    switch (format) {
        case ImageFormat::png:
            return e == ".png";
        case ImageFormat::jpeg:
            return e == ".jpg" || e == ".jpeg";
        case ImageFormat::tiff:
            return e == ".tif" || e == ".tiff" || e == ".tx";
        case ImageFormat::exr:
            return e == ".exr";
        case ImageFormat::hdr:
            return e == ".hdr";
    }
    return false;
}

void read_header(TextureSource& s, const ColorSpaces& colors) {
    PixelReader reader(s.file, ImageLimits());
    const ImageInfo& info = reader.info();
    if (s.color_space.empty()) s.color_space = info.is_float ? kLinRec709 : kSrgbTexture;
    // The conversion of one pixel tells an unknown space from a bad file, and whether anything
    // changes.
    constexpr std::array<float, 3> kProbe{0.2f, 0.5f, 0.7f};
    std::array<float, 3> probe = kProbe;
    try {
        colors.to_working(probe, s.color_space);
    } catch (const Error& error) {
        s.error = error.what();
        throw;
    }
    const ChannelPick pick = pick_channels(info.channels, reader.alpha_channel());
    s.width = info.width;
    s.height = info.height;
    s.channels = stored_channels(reader, s.color_space, colors);
    s.alpha = s.channels == 2 || s.channels == 4;
    s.srgb = colors.is_plain_srgb(s.color_space);
    s.tiled = info.tiled;
    s.type = texel_type(reader, s.color_space, colors);
    s.bytes = pyramid_bytes(s.width, s.height, s.channels, s.type);
    s.finest_bytes =
        std::int64_t(s.width) * s.height * s.channels * (s.type == TexelType::byte ? 1 : 2);
    const bool first_channels = info.channels != 2 || reader.alpha_channel() == 1;
    s.cacheable = first_channels && s.channels == pick.count && (probe == kProbe || s.srgb) &&
                  extension_agrees(s.file, reader.format());
}

void read_pixels(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) {
    PixelReader reader(s.file, ImageLimits());
    s.pyramid = build_pyramid(reader, s.color_space, colors, tables, s.skip);
    if (s.pyramid.non_finite > 0)
        s.warnings.push_back(named(s) + std::to_string(s.pyramid.non_finite) +
                             " values are not finite; read as 0");
    if (s.pyramid.clamped > 0)
        s.warnings.push_back(named(s) + std::to_string(s.pyramid.clamped) +
                             " values are beyond 65504; clamped to that");
}

void set_skip(TextureSource& s, int skip) {
    s.skip = skip;
    if (s.bytes > 0) s.bytes = pyramid_bytes(s.width, s.height, s.channels, s.type, skip);
}

/// Drops the finest level of the largest, and so on. Returns the bytes of all.
std::int64_t halve_until(const std::vector<TextureSource*>& sources, std::int64_t room) {
    // The first of the largest in front.
    const auto before = [](const TextureSource* a, const TextureSource* b) {
        return a->bytes != b->bytes ? a->bytes < b->bytes : a > b;
    };
    std::vector<TextureSource*> heap = sources;
    std::make_heap(heap.begin(), heap.end(), before);
    std::int64_t total = 0;
    for (const TextureSource* s : sources) total += s->bytes;
    while (total > room && !heap.empty()) {
        std::pop_heap(heap.begin(), heap.end(), before);
        TextureSource& s = *heap.back();
        if (std::max(s.width, s.height) >> (s.skip + 1) == 0) {
            heap.pop_back();
            continue;
        }
        total -= s.bytes;
        set_skip(s, s.skip + 1);
        total += s.bytes;
        std::push_heap(heap.begin(), heap.end(), before);
    }
    return total;
}

/// Every failure of the file told and turned into magenta.
template <class Step>
void or_magenta(TextureSource& s, const ByteTables& tables, const Step& step) noexcept {
    try {
        try {
            step();
        } catch (const Error& error) {
            if (error.code() == ExitCode::memory) throw;
            if (s.error.empty()) become_magenta(s, tables, error);
        } catch (const std::bad_alloc&) {
            throw Error(ExitCode::memory, named(s) + "out of memory");
        }
    } catch (...) {
        s.fatal = std::current_exception();
    }
}

}  // namespace

std::string named(const TextureSource& s) { return "texture '" + s.file + "': "; }

void become_magenta(TextureSource& s, const ByteTables& tables, const Error& why) {
    // The place is that of one of them.
    std::string users;
    for (std::size_t i = 0; s.users.size() > 1 && i < s.users.size(); ++i) {
        if (i > kNamedUsers) continue;
        users += i == 0 ? " (of materials " : i + 1 == s.users.size() ? " and " : ", ";
        users += i == kNamedUsers ? "others" : "'" + s.users[i] + "'";
    }
    const std::string text = why.what() + users + (users.empty() ? "" : ")");
    if (claims_to_be_image(s.file))
        s.damages.push_back(text);
    else
        s.warnings.push_back(text + "; magenta in its place");
    s.pyramid = constant_pyramid({255, 0, 255}, tables);
    s.in_core = s.magenta = true;
    s.alpha = false;
    s.width = s.height = 1;
    s.bytes = s.finest_bytes = 0;
}

void survey(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) noexcept {
    or_magenta(s, tables, [&] { read_header(s, colors); });
}

void load_pixels(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) noexcept {
    or_magenta(s, tables, [&] { read_pixels(s, colors, tables); });
}

std::int64_t place_sources(std::vector<TextureSource>& sources, const TextureOptions& options) {
    const std::int64_t memory_bytes = options.memory_bytes;
    const auto may_leave = [&](const TextureSource& s) {
        return s.bytes > 0 && (fits_cache(s) || (options.auto_tx && !s.no_tx));
    };
    const auto is_large = [&](const TextureSource& s) {
        return s.finest_bytes > options.in_core_bytes;
    };
    std::int64_t total = 0;
    bool any_leaves = false, any_large = false;
    std::vector<TextureSource*> staying, leaving;
    for (TextureSource& s : sources) {
        set_skip(s, 0);
        s.in_core = true;
        total += s.bytes;
        (may_leave(s) ? leaving : staying).push_back(&s);
        any_leaves = any_leaves || may_leave(s);
        any_large = any_large || (reads_well(s) && is_large(s));
    }
    if (!any_large && total <= memory_bytes) return 0;
    const std::int64_t room = any_leaves ? memory_bytes / 2 : memory_bytes;
    std::int64_t used = halve_until(staying, room);
    std::stable_sort(leaving.begin(), leaving.end(),
                     [](const auto* a, const auto* b) { return a->bytes < b->bytes; });
    for (TextureSource* s : leaving) {
        s->in_core = !is_large(*s) && used + s->bytes <= room;
        if (s->in_core) used += s->bytes;
    }
    if (leaving.empty()) return 0;
    // The cache's own limit is on texels: its tables, open files and the heap's gaps come on top.
    const std::int64_t rest = std::max<std::int64_t>(0, memory_bytes - used);
    return std::max<std::int64_t>(1, rest - rest / 8);
}

}  // namespace tessera
