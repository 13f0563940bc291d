#include "renderer/image/tile_cache.h"

#include <OpenImageIO/imagecache.h>
#include <half.h>
#include <malloc.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/image_format.h"
#include "renderer/image/texel_filter.h"
#include "renderer/image/tx_file.h"

namespace tessera {
namespace {

/// What a level's tiles look like.
struct LevelShape {
    int width = 1, height = 1;
    int x = 0, y = 0;  // of the data window
    int tile_width = 1, tile_height = 1;
};

struct Entry {
    OIIO::ImageCache::ImageHandle* handle = nullptr;
    int channels = 3;
    bool srgb = false;
    std::vector<LevelShape> levels;
    std::optional<TexelSummary> summary;
};

/// The texels of one look-up: holds on to the tile it read last.
class TileTexels {
public:
    TileTexels(OIIO::ImageCache& cache, const Entry& entry, const ByteTables& tables)
        : cache_(cache), entry_(entry), tables_(tables), thread_(cache.get_perthread_info()) {}
    ~TileTexels() { release(); }
    TileTexels(const TileTexels&) = delete;
    TileTexels& operator=(const TileTexels&) = delete;

    int levels() const noexcept { return static_cast<int>(entry_.levels.size()); }
    int width(int level) const noexcept { return shape(level).width; }
    int height(int level) const noexcept { return shape(level).height; }
    bool has_alpha() const noexcept { return entry_.channels == 2 || entry_.channels == 4; }
    bool failed() const noexcept { return failed_; }

    Texel texel(int level, int x, int y) {
        const LevelShape& l = shape(level);
        const int column = x / l.tile_width, row = y / l.tile_height;
        if (level != level_ || column != column_ || row != row_) fetch(level, column, row);
        if (failed_) return {1, 0, 1, 1};
        const auto across = static_cast<std::size_t>(x - column * l.tile_width),
                   down = static_cast<std::size_t>(y - row * l.tile_height);
        const std::size_t at = (down * l.tile_width + across) * n();
        const auto get = [&](std::size_t c) { return value(at + c, has_alpha() && c + 1 == n()); };
        switch (entry_.channels) {
            case 1:
                return grey(get(0), 1);
            case 2:
                return grey(get(0), get(1));
            case 3:
                return {get(0), get(1), get(2), 1};
            default:
                return {get(0), get(1), get(2), get(3)};
        }
    }

private:
    static Texel grey(float value, float alpha) { return {value, value, value, alpha}; }
    std::size_t n() const noexcept { return static_cast<std::size_t>(entry_.channels); }
    const LevelShape& shape(int level) const noexcept {
        return entry_.levels[static_cast<std::size_t>(level)];
    }

    void release() noexcept {
        if (tile_) cache_.release_tile(tile_);
        tile_ = nullptr;
    }

    void fetch(int level, int column, int row) {
        release();
        level_ = level, column_ = column, row_ = row;
        const LevelShape& l = shape(level);
        tile_ = cache_.get_tile(entry_.handle, thread_, 0, level, l.x + column * l.tile_width,
                                l.y + row * l.tile_height, 0, 0, entry_.channels);
        pixels_ = tile_ ? cache_.tile_pixels(tile_, format_) : nullptr;
        if (pixels_) return;
        failed_ = true;
        static_cast<void>(cache_.geterror());  // else it grows with every look-up
    }

    float value(std::size_t at, bool is_alpha) const noexcept {
        const bool curve = entry_.srgb && !is_alpha;
        float v = 0;
        switch (format_.basetype) {
            case OIIO::TypeDesc::UINT8:
                return (curve ? tables_.srgb
                              : tables_.linear)[static_cast<const std::uint8_t*>(pixels_)[at]];
            case OIIO::TypeDesc::UINT16:
                v = static_cast<float>(static_cast<const std::uint16_t*>(pixels_)[at]) *
                    (1.0f / 65535.0f);
                break;
            case OIIO::TypeDesc::HALF:
                v = imath_half_to_float(static_cast<const std::uint16_t*>(pixels_)[at]);
                break;
            default:  // the cache turns all else into floats
                v = static_cast<const float*>(pixels_)[at];
        }
        if (!std::isfinite(v)) return 0;
        return curve ? srgb_to_linear(v) : v;
    }

    OIIO::ImageCache& cache_;
    const Entry& entry_;
    const ByteTables& tables_;
    OIIO::ImageCache::Perthread* thread_;
    OIIO::ImageCache::Tile* tile_ = nullptr;
    const void* pixels_ = nullptr;
    OIIO::TypeDesc format_;
    int level_ = -1, column_ = -1, row_ = -1;
    bool failed_ = false;
};

/// Tiles are made and dropped by all threads: with an arena for each, the C library would keep what
/// one thread freed from the others, a fifth of the cache and more.
void share_heap() {
#ifdef __GLIBC__
    ::mallopt(M_ARENA_MAX, 2);
#endif
}

}  // namespace

struct TileCache::Impl {
    explicit Impl(const ByteTables& byte_tables) : tables(byte_tables) {}

    struct Destroy {
        void operator()(OIIO::ImageCache* owned) const { OIIO::ImageCache::destroy(owned, true); }
    };
    std::unique_ptr<OIIO::ImageCache, Destroy> cache{OIIO::ImageCache::create(false)};
    const ByteTables& tables;
    std::vector<Entry> entries;
    std::atomic<std::int64_t> failures{0};

    std::int64_t statistic(const char* name) const noexcept {
        long long value = 0;
        cache->getattribute(name, OIIO::TypeDesc::INT64, &value);
        return value;
    }
};

TileCache::TileCache(std::int64_t bytes, const ByteTables& tables)
    : impl_(std::make_unique<Impl>(tables)) {
    share_heap();
    OIIO::ImageCache& cache = *impl_->cache;
    cache.attribute("max_memory_MB", static_cast<float>(bytes) / (1 << 20));
    cache.attribute("unassociatedalpha", 1);  // values as stored
}

TileCache::~TileCache() = default;

int TileCache::add(const std::string& path, int channels, bool srgb) {
    OIIO::ImageCache& cache = *impl_->cache;
    Entry entry{cache.get_image_handle(OIIO::ustring(path)), channels, srgb, {}, {}};
    if (!entry.handle || !cache.good(entry.handle))
        fail_image(path, "the tile cache refused it: " + cache.geterror());
    OIIO::ImageSpec spec;
    while (cache.get_imagespec(entry.handle, nullptr, spec, 0,
                               static_cast<int>(entry.levels.size()), false)) {
        if (entry.levels.empty())
            entry.summary = parse_texels(spec.get_string_attribute("ImageDescription"));
        entry.levels.push_back(
            {spec.width, spec.height, spec.x, spec.y, spec.tile_width, spec.tile_height});
        if (spec.width <= 0 || spec.height <= 0 || spec.tile_width <= 0 || spec.tile_height <= 0)
            fail_image(path, "the tile cache refused it: a level without pixels");
    }
    static_cast<void>(cache.geterror());  // "no such level" ends the list
    if (entry.levels.empty()) fail_image(path, "the tile cache refused it: no picture in it");
    impl_->entries.push_back(std::move(entry));
    return static_cast<int>(impl_->entries.size()) - 1;
}

Texel TileCache::sample(int handle, TextureFilter filter, float u, float v, float level,
                        Wrap wrap_u, Wrap wrap_v, std::uint32_t seed) const noexcept {
    const Entry& entry = impl_->entries[static_cast<std::size_t>(handle)];
    try {
        TileTexels texels(*impl_->cache, entry, impl_->tables);
        const Texel texel = TexelFilter(texels, wrap_u, wrap_v)(filter, fold(u, wrap_u),
                                                                fold(v, wrap_v), level, seed);
        if (!texels.failed()) return texel;
    } catch (...) {
    }
    impl_->failures.fetch_add(1, std::memory_order_relaxed);
    return {1, 0, 1, 1};
}

Texel TileCache::mean(int handle) const noexcept {
    constexpr int kGrid = 16;
    constexpr float kStep = 1.0f / kGrid;
    const Entry& entry = impl_->entries[static_cast<std::size_t>(handle)];
    if (entry.summary) return entry.summary->mean;
    const int size = std::max(entry.levels[0].width, entry.levels[0].height);
    const float level = std::log2(std::max(1.0f, static_cast<float>(size) * kStep));
    Texel sum{0, 0, 0, 0};
    for (int j = 0; j < kGrid; ++j)
        for (int i = 0; i < kGrid; ++i) {
            const Texel t =
                sample(handle, TextureFilter::trilinear, (static_cast<float>(i) + 0.5f) * kStep,
                       (static_cast<float>(j) + 0.5f) * kStep, level, Wrap::clamp, Wrap::clamp, 0);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += t[c] * kStep * kStep;
        }
    return sum;
}

bool TileCache::channel_is_one(int handle, int c) const noexcept {
    const Entry& entry = impl_->entries[static_cast<std::size_t>(handle)];
    return entry.summary && entry.summary->is_one[static_cast<std::size_t>(c)];
}

std::int64_t TileCache::memory_bytes() const noexcept {
    return impl_->statistic("stat:cache_memory_used");
}

std::int64_t TileCache::bytes_read() const noexcept { return impl_->statistic("stat:bytes_read"); }

std::int64_t TileCache::failures() const noexcept { return impl_->failures.load(); }

}  // namespace tessera
