#include "renderer/image/texture.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <new>
#include <utility>

#include "renderer/core/parallel.h"
#include "renderer/image/colour_names.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/image_format.h"
#include "renderer/image/pixel_reader.h"
#include "renderer/image/pyramid.h"
#include "renderer/image/tile_cache.h"

namespace tessera {
namespace {

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

/// The placement and arithmetic of one TextureDesc; what it reads lies in a Source.
struct Use {
    std::size_t source = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Float2 scale{1, 1}, offset{0, 0};
    float gain = 1, bias = 0;
};

float finite_or(float value, float otherwise) { return std::isfinite(value) ? value : otherwise; }

/// value * gain + bias on RGB, kept finite.
void grade(Texel& t, const Use& use) noexcept {
    if (use.gain == 1 && use.bias == 0) return;
    constexpr float kMax = std::numeric_limits<float>::max();
    for (std::size_t c = 0; c < 3; ++c) t[c] = std::clamp(t[c] * use.gain + use.bias, -kMax, kMax);
}

constexpr const char* kMagentaInstead = "; magenta in its place";

/// A file in one colour space, read once however many textures use it.
struct Source {
    std::string file;
    std::string color_space;
    SourceLoc loc;
    Pyramid pyramid;
    int tile = -1;  // in the tile cache instead
    bool alpha = false;
    int width = 1, height = 1;
    bool to_cache = false;
    bool srgb = false;
    int channels = 3;
    std::vector<std::string> damages, warnings, notes;
    std::string error;  // the colour space is unknown: the user's mistake, not the file's
    std::exception_ptr fatal;
};

std::string named(const Source& s) { return "texture '" + s.file + "': "; }

/// Whether the picture is one for the tile cache. That applies the sRGB curve or nothing: pictures
/// in other spaces are converted in memory, whatever it costs.
bool wants_cache(Source& s, const PixelReader& reader, bool needs_conversion, std::int64_t bytes) {
    if (bytes <= TextureStore::kInCoreBytes) return false;
    const ImageInfo& info = reader.info();
    const std::string size = named(s) + std::to_string(bytes >> 20) + " MiB";
    const bool first_channels = info.channels != 2 || reader.alpha_channel() == 1;
    if (!first_channels || (needs_conversion && !s.srgb) ||
        !extension_agrees(s.file, reader.format())) {
        s.notes.push_back(size +
                          " kept in memory: the tile cache takes only pictures in sRGB, raw or the "
                          "working space whose extension is that of their format");
        return false;
    }
    if (s.srgb)
        s.notes.push_back(size +
                          ", filtered in sRGB codes, which is too dark at a distance (run 'maketx "
                          "--colorconvert sRGB linear -d half')");
    else if (!info.tiled)
        s.notes.push_back(size + ", not tiled or mip-mapped: slow to read (run 'maketx')");
    return true;
}

void load(Source& s, const ColorSpaces& colors, const ByteTables& tables) {
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
    const TexelType type = texel_type(reader, s.color_space, colors);
    s.channels = pick.count;
    s.alpha = pick.count == 2 || pick.count == 4;
    s.srgb = colors.is_plain_srgb(s.color_space);
    s.width = info.width;
    s.height = info.height;
    const std::int64_t bytes =
        std::int64_t(info.width) * info.height * pick.count * (type == TexelType::byte ? 1 : 2);
    s.to_cache = wants_cache(s, reader, probe != kProbe, bytes);
    if (s.to_cache) return;
    s.pyramid = build_pyramid(reader, s.color_space, colors, tables);
    if (s.pyramid.non_finite > 0)
        s.warnings.push_back(named(s) + std::to_string(s.pyramid.non_finite) +
                             " values are not finite; read as 0");
    if (s.pyramid.clamped > 0)
        s.warnings.push_back(named(s) + std::to_string(s.pyramid.clamped) +
                             " values are beyond 65504; clamped to that");
}

void become_magenta(Source& s, const ByteTables& tables, const Error& why) {
    if (claims_to_be_image(s.file))
        s.damages.emplace_back(why.what());
    else
        s.warnings.push_back(std::string(why.what()) + kMagentaInstead);
    s.pyramid = constant_pyramid({255, 0, 255}, tables);
    s.to_cache = s.alpha = false;
    s.width = s.height = 1;
}

/// load() with every failure of the file told and turned into magenta.
void load_or_magenta(Source& s, const ColorSpaces& colors, const ByteTables& tables) noexcept {
    try {
        try {
            load(s, colors, tables);
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

struct TextureStore::Impl {
    ByteTables tables;
    std::vector<Use> uses;
    std::vector<Source> sources;
    std::unique_ptr<TileCache> cache;

    void list(const std::vector<TextureRequest>& requests);
    void report(Problems& problems);
    const Source& source(int texture) const noexcept {
        return sources[uses[static_cast<std::size_t>(texture)].source];
    }
};

void TextureStore::Impl::list(const std::vector<TextureRequest>& requests) {
    std::map<std::pair<std::string, std::string>, std::size_t> known;
    for (const TextureRequest& request : requests) {
        if (!request.desc) throw Error(ExitCode::bug, "TextureStore: a request without a texture");
        const TextureDesc& d = *request.desc;
        const bool raw = d.color_space.empty() && request.use == TextureUse::data;
        const std::string space = raw ? std::string(kRaw) : own_name(d.color_space);
        const auto [it, added] = known.try_emplace({d.file, space}, sources.size());
        if (added) {
            Source& s = sources.emplace_back();
            s.file = d.file;
            s.color_space = space;
            s.loc = d.loc;
        }
        uses.push_back({it->second,
                        d.wrap_u,
                        d.wrap_v,
                        {finite_or(d.scale[0], 1), finite_or(d.scale[1], 1)},
                        {finite_or(d.offset[0], 0), finite_or(d.offset[1], 0)},
                        finite_or(d.gain, 1),
                        finite_or(d.bias, 0)});
    }
}

/// In the order of the requests, after all are loaded. The tile cache is filled here, by one
/// thread.
void TextureStore::Impl::report(Problems& problems) {
    for (Source& s : sources) {
        if (s.fatal) std::rethrow_exception(s.fatal);
        if (s.to_cache) {
            try {
                if (!cache) cache = std::make_unique<TileCache>();
                s.tile = cache->add(s.file, s.channels, s.srgb);
            } catch (const Error& error) {
                become_magenta(s, tables, error);
            }
        }
        if (!s.error.empty()) problems.error(s.loc, s.error);
        for (const std::string& line : s.damages)
            problems.damage(s.loc, line + (problems.lenient() ? kMagentaInstead : ""));
        for (const std::string& line : s.warnings) problems.warn(s.loc, line);
        for (const std::string& line : s.notes) problems.note(s.loc, line);
    }
}

TextureStore::TextureStore(const std::vector<TextureRequest>& requests, const ColorSpaces& colors,
                           Problems& problems, Workers* workers)
    : impl_(std::make_unique<Impl>()) {
    impl_->list(requests);
    const auto load_one = [&](int i) {
        load_or_magenta(impl_->sources[static_cast<std::size_t>(i)], colors, impl_->tables);
    };
    const int count = static_cast<int>(impl_->sources.size());
    if (workers && count > 1)
        workers->for_each(count, load_one);
    else
        for (int i = 0; i < count; ++i) load_one(i);
    impl_->report(problems);
}

TextureStore::~TextureStore() = default;

Texel TextureStore::sample(int texture, float u, float v, float width) const noexcept {
    assert(texture >= 0 && texture < size());
    const Use& use = impl_->uses[static_cast<std::size_t>(texture)];
    const Source& s = impl_->sources[use.source];
    u = u * use.scale[0] + use.offset[0];
    v = v * use.scale[1] + use.offset[1];
    if (!std::isfinite(u)) u = 0;
    if (!std::isfinite(v)) v = 0;
    constexpr float kWidest = 1e6f;  // more texels than any picture has
    width = width > 0 ? std::min(width, kWidest) : 0;
    const float width_u = width * std::abs(use.scale[0]);
    const float width_v = width * std::abs(use.scale[1]);
    Texel texel;
    if (s.tile < 0) {
        const float texels =
            std::max(width_u * static_cast<float>(s.width), width_v * static_cast<float>(s.height));
        const float level = texels > 1 ? std::log2(texels) : 0;
        texel = sample_pyramid(s.pyramid, u, v, level, use.wrap_u, use.wrap_v);
    } else {
        texel = impl_->cache->sample(s.tile, u, v, width_u, width_v, use.wrap_u, use.wrap_v);
    }
    grade(texel, use);
    return texel;
}

int TextureStore::size() const noexcept { return static_cast<int>(impl_->uses.size()); }

Texel TextureStore::mean(int texture) const noexcept {
    const Source& s = impl_->source(texture);
    Texel texel = s.tile < 0 ? s.pyramid.mean : impl_->cache->mean(s.tile);
    grade(texel, impl_->uses[static_cast<std::size_t>(texture)]);
    return texel;
}

bool TextureStore::channel_is_one(int texture, int c) const noexcept {
    const Use& use = impl_->uses[static_cast<std::size_t>(texture)];
    const Source& s = impl_->sources[use.source];
    if (c == 3 && !s.alpha) return true;
    const bool bounded = use.wrap_u == Wrap::black || use.wrap_v == Wrap::black;
    const bool graded = c < 3 && (use.gain != 1 || use.bias != 0);
    return s.tile < 0 && !bounded && !graded && s.pyramid.is_one[static_cast<std::size_t>(c)];
}

bool TextureStore::has_alpha(int texture) const noexcept { return impl_->source(texture).alpha; }

std::int64_t TextureStore::memory_bytes() const noexcept {
    std::int64_t total = impl_->cache ? impl_->cache->memory_bytes() : 0;
    for (const Source& s : impl_->sources) total += s.pyramid.memory_bytes();
    return total;
}

}  // namespace tessera
