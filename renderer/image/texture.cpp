#include "renderer/image/texture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "renderer/core/parallel.h"
#include "renderer/image/colour_names.h"
#include "renderer/image/pyramid.h"
#include "renderer/image/texture_source.h"
#include "renderer/image/tile_cache.h"
#include "renderer/image/tx_file.h"

namespace tessera {
namespace {

constexpr Texel kMagenta{1, 0, 1, 1};

/// The placement and arithmetic of one TextureDesc; what it reads lies in a TextureSource.
struct Use {
    std::size_t source = 0;  // the first one's of a set of tiles
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::trilinear;
    int set = -1;  // of tiles
    Float2 scale{1, 1}, offset{0, 0};
    float gain = 1, bias = 0;
};

/// A grid of tiles.
struct TileSet {
    int columns = 0, rows = 0;
    std::vector<int> source;  // row by row; -1: no tile
    std::string pattern;
    SourceLoc loc;

    int at(float column, float row) const noexcept {
        if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns) &&
              row < static_cast<float>(rows)))
            return -1;
        return source[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
};

float finite_or(float value, float otherwise) { return std::isfinite(value) ? value : otherwise; }

/// value * gain + bias on RGB, kept finite.
void grade(Texel& t, const Use& use) noexcept {
    if (use.gain == 1 && use.bias == 0) return;
    constexpr float kMax = std::numeric_limits<float>::max();
    for (std::size_t c = 0; c < 3; ++c) t[c] = std::clamp(t[c] * use.gain + use.bias, -kMax, kMax);
}

std::string mib(std::int64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

/// Tells what a picture lost to the limit, and takes the size it is left with.
void tell_place(TextureSource& s, const TextureOptions& options) {
    if (s.tile >= 0 && fits_cache(s) && s.srgb && !options.auto_tx)
        s.notes.push_back(named(s) + mib(s.bytes) +
                          " in the tile cache, its coarser levels are means of sRGB codes: too "
                          "dark at a distance (use --auto-tx)");
    if (s.skip == 0) return;
    const auto size = [&] { return std::to_string(s.width) + "x" + std::to_string(s.height); };
    const std::string whole = size();
    s.width = std::max(1, s.width >> s.skip);
    s.height = std::max(1, s.height >> s.skip);
    s.warnings.push_back(named(s) + (s.tiled ? "not fit for" : "untiled, too slow for") +
                         " the tile cache; read as " + size() + " in place of " + whole +
                         " to stay within the " + mib(options.memory_bytes) +
                         " of --texture-memory (--auto-tx reads it whole)");
}

}  // namespace

struct TextureStore::Impl {
    ByteTables tables;
    std::vector<Use> uses;
    std::vector<TextureSource> sources;
    std::vector<TileSet> sets;
    std::unique_ptr<TileCache> cache;
    std::map<std::pair<std::string, std::string>, std::size_t> known;
    std::map<const TextureSource*, bool> tx;  // that there are: whether they were made now

    void list(const std::vector<TextureRequest>& requests);
    std::size_t add_source(const std::string& file, const std::string& space,
                           const TextureRequest& request);
    int add_set(const TextureRequest& request, const std::string& space);
    template <class Step>
    void for_each(Workers* workers, const Step& step);
    void place(const TextureOptions& options, const ColorSpaces& colors, Problems& problems);
    bool to_cache(TextureSource& s, const TextureOptions& options, const ColorSpaces& colors);
    bool by_tx(TextureSource& s, const std::string& folder, const ColorSpaces& colors);
    void report(Problems& problems);

    const TextureSource& source(int texture) const noexcept {
        return sources[uses[static_cast<std::size_t>(texture)].source];
    }
    /// Calls visit(source) for all that a texture reads.
    template <class Visit>
    void each_source(const Use& use, const Visit& visit) const {
        if (use.set < 0) return visit(sources[use.source]);
        for (const int s : sets[static_cast<std::size_t>(use.set)].source)
            if (s >= 0) visit(sources[static_cast<std::size_t>(s)]);
    }
    Texel filtered(const Use& use, const TextureSource& s, float u, float v, float level,
                   std::uint32_t seed) const noexcept;
};

std::size_t TextureStore::Impl::add_source(const std::string& file, const std::string& space,
                                           const TextureRequest& request) {
    const auto [it, added] = known.try_emplace({file, space}, sources.size());
    if (added) {
        TextureSource& s = sources.emplace_back();
        s.file = file;
        s.color_space = space;
        s.loc = request.desc->loc;
    }
    std::vector<std::string>& users = sources[it->second].users;
    for (const std::string& user : request.users)
        if (std::find(users.begin(), users.end(), user) == users.end()) users.push_back(user);
    return it->second;
}

int TextureStore::Impl::add_set(const TextureRequest& request, const std::string& space) {
    const TextureDesc& desc = *request.desc;
    TileSet& set = sets.emplace_back();
    set.pattern = desc.file;
    set.loc = desc.loc;
    for (const TextureTile& t : desc.tiles) {
        set.columns = std::max(set.columns, t.column + 1);
        set.rows = std::max(set.rows, t.row + 1);
    }
    set.source.assign(static_cast<std::size_t>(set.columns) * static_cast<std::size_t>(set.rows),
                      -1);
    for (const TextureTile& t : desc.tiles)
        set.source[static_cast<std::size_t>(t.row) * static_cast<std::size_t>(set.columns) +
                   static_cast<std::size_t>(t.column)] =
            static_cast<int>(add_source(t.file, space, request));
    return static_cast<int>(sets.size()) - 1;
}

void TextureStore::Impl::list(const std::vector<TextureRequest>& requests) {
    for (const TextureRequest& request : requests) {
        if (!request.desc) throw Error(ExitCode::bug, "TextureStore: a request without a texture");
        const TextureDesc& d = *request.desc;
        const bool raw = d.color_space.empty() && request.use == TextureUse::data;
        const std::string space = raw ? std::string(kRaw) : own_name(d.color_space);
        Use use{0,
                d.wrap_u,
                d.wrap_v,
                d.filter,
                -1,
                {finite_or(d.scale[0], 1), finite_or(d.scale[1], 1)},
                {finite_or(d.offset[0], 0), finite_or(d.offset[1], 0)},
                finite_or(d.gain, 1),
                finite_or(d.bias, 0)};
        if (d.tiles.empty()) {
            use.source = add_source(d.file, space, request);
        } else {
            use.set = add_set(request, space);
            use.source = add_source(d.tiles[0].file, space, request);
            use.wrap_u = use.wrap_v = Wrap::clamp;  // a tile knows nothing of its neighbours
        }
        uses.push_back(use);
    }
}

template <class Step>
void TextureStore::Impl::for_each(Workers* workers, const Step& step) {
    const int count = static_cast<int>(sources.size());
    const auto one = [&](int i) { step(sources[static_cast<std::size_t>(i)]); };
    if (workers && count > 1)
        workers->for_each(count, one);
    else
        for (int i = 0; i < count; ++i) one(i);
}

/// True if the cache now reads a .tx in the file's place, made if there was none.
bool TextureStore::Impl::by_tx(TextureSource& s, const std::string& folder,
                               const ColorSpaces& colors) {
    const std::string path = folder.empty() ? "" : tx_path(folder, s.file, s.color_space, colors);
    try {
        if (path.empty()) throw Error(ExitCode::output, "no folder for it (--tx-cache names one)");
        std::error_code error;
        const bool there = std::filesystem::is_regular_file(path, error);
        if (!there) {
            load_pixels(s, colors, tables);
            if (s.fatal || !s.damages.empty() || s.bytes == 0) return false;
            write_tx(s.pyramid, path);
        }
        // Bytes stay codes; all else was made linear.
        s.tile = cache->add(path, s.channels, s.srgb && s.type == TexelType::byte);
        s.pyramid = {};
        tx.try_emplace(&s, !there);
        return true;
    } catch (const Error& why) {
        s.pyramid = {};
        s.no_tx = true;
        s.warnings.push_back(named(s) + "no .tx: " + why.what());
        return false;
    }
}

/// False if the file has to stay in memory after all.
bool TextureStore::Impl::to_cache(TextureSource& s, const TextureOptions& options,
                                  const ColorSpaces& colors) {
    const std::string& folder = options.tx_folder.empty() ? default_tx_folder() : options.tx_folder;
    if (options.auto_tx && !s.no_tx && !reads_well(s)) {
        if (by_tx(s, folder, colors)) return true;
        if (s.fatal || s.in_core) return true;  // magenta
    }
    if (!fits_cache(s)) return false;
    try {
        s.tile = cache->add(s.file, s.channels, s.srgb);
    } catch (const Error& error) {
        become_magenta(s, tables, error);
    }
    return true;
}

/// Which sources go to the tile cache; it is filled by one thread, in the order of the requests.
void TextureStore::Impl::place(const TextureOptions& options, const ColorSpaces& colors,
                               Problems& problems) {
    // Again without those that turn out to have no .tx: now memory has to take them.
    for (bool all_placed = false; !all_placed;) {
        cache.reset();
        for (TextureSource& s : sources) s.tile = -1;
        const std::int64_t rest = place_sources(sources, options);
        if (rest > 0) cache = std::make_unique<TileCache>(rest, tables);
        all_placed = true;
        for (TextureSource& s : sources)
            if (!s.in_core && !s.fatal) all_placed = to_cache(s, options, colors) && all_placed;
    }
    for (TextureSource& s : sources) tell_place(s, options);
    const auto made = std::count_if(tx.begin(), tx.end(), [](const auto& t) { return t.second; });
    if (!tx.empty())
        problems.note({}, "auto-tx: " + std::to_string(made) + " .tx made, " +
                              std::to_string(static_cast<std::ptrdiff_t>(tx.size()) - made) +
                              " there from before");
}

/// In the order of the requests, after all are loaded.
void TextureStore::Impl::report(Problems& problems) {
    for (const TextureSource& s : sources) {
        if (s.fatal) std::rethrow_exception(s.fatal);
        if (!s.error.empty()) problems.error(s.loc, s.error);
        for (const std::string& line : s.damages)
            problems.damage(s.loc, line + (problems.lenient() ? "; magenta in its place" : ""));
        for (const std::string& line : s.warnings) problems.warn(s.loc, line);
        for (const std::string& line : s.notes) problems.note(s.loc, line);
    }
    for (const TileSet& set : sets) {
        const auto holes = std::count(set.source.begin(), set.source.end(), -1);
        // Rows of a UDIM set end where they like: a hole has a tile after it in its row.
        std::string first;
        int inside = 0;
        for (int row = 0; holes > 0 && row < set.rows; ++row) {
            bool after = false;
            for (int column = set.columns - 1; column >= 0; --column) {
                const bool there = set.at(static_cast<float>(column), static_cast<float>(row)) >= 0;
                if (!there && after) {
                    ++inside;
                    first = "u " + std::to_string(column) + ", v " + std::to_string(row);
                }
                after = after || there;
            }
        }
        if (inside > 0)
            problems.warn(set.loc, "texture '" + set.pattern + "': " + std::to_string(inside) +
                                       " tiles are missing between others (one at " + first +
                                       "); magenta where they are read");
    }
}

TextureStore::TextureStore(const std::vector<TextureRequest>& requests, const ColorSpaces& colors,
                           Problems& problems, Workers* workers, const TextureOptions& options)
    : impl_(std::make_unique<Impl>()) {
    Impl& impl = *impl_;
    impl.list(requests);
    impl.for_each(workers, [&](TextureSource& s) { survey(s, colors, impl.tables); });
    impl.place(options, colors, problems);
    impl.for_each(workers, [&](TextureSource& s) {
        if (s.in_core && s.pyramid.levels.empty() && !s.fatal && s.error.empty())
            load_pixels(s, colors, impl.tables);
    });
    impl.report(problems);
}

TextureStore::~TextureStore() = default;

Texel TextureStore::Impl::filtered(const Use& use, const TextureSource& s, float u, float v,
                                   float level, std::uint32_t seed) const noexcept {
    if (s.tile >= 0)
        return cache->sample(s.tile, use.filter, u, v, level, use.wrap_u, use.wrap_v, seed);
    return filter_pyramid(s.pyramid, use.filter, u, v, level, use.wrap_u, use.wrap_v, seed);
}

Texel TextureStore::sample(int texture, float u, float v, float width,
                           std::uint32_t seed) const noexcept {
    assert(texture >= 0 && texture < size());
    const Use& use = impl_->uses[static_cast<std::size_t>(texture)];
    const TextureSource* s = &impl_->sources[use.source];
    u = u * use.scale[0] + use.offset[0];
    v = v * use.scale[1] + use.offset[1];
    if (!std::isfinite(u)) u = 0;
    if (!std::isfinite(v)) v = 0;
    if (use.set >= 0) [[unlikely]] {
        const float column = std::floor(u), row = std::floor(v);
        const int tile = impl_->sets[static_cast<std::size_t>(use.set)].at(column, row);
        if (tile < 0) return kMagenta;
        s = &impl_->sources[static_cast<std::size_t>(tile)];
        u -= column;
        v -= row;
    }
    constexpr float kWidest = 1e6f;  // more texels than any picture has
    width = width > 0 ? std::min(width, kWidest) : 0;
    const float width_u = width * std::abs(use.scale[0]);
    const float width_v = width * std::abs(use.scale[1]);
    const float texels =
        std::max(width_u * static_cast<float>(s->width), width_v * static_cast<float>(s->height));
    const float level = texels > 1 ? std::log2(texels) : 0;
    Texel texel;
    if (s->tile < 0 && use.filter == TextureFilter::trilinear) [[likely]]
        texel = sample_pyramid(s->pyramid, u, v, level, use.wrap_u, use.wrap_v);
    else
        texel = impl_->filtered(use, *s, u, v, level, seed);
    grade(texel, use);
    return texel;
}

int TextureStore::size() const noexcept { return static_cast<int>(impl_->uses.size()); }

Texel TextureStore::mean(int texture) const noexcept {
    const Use& use = impl_->uses[static_cast<std::size_t>(texture)];
    Texel sum{0, 0, 0, 0};
    float count = 0;
    impl_->each_source(use, [&](const TextureSource& s) {
        const Texel t = s.tile < 0 ? s.pyramid.mean : impl_->cache->mean(s.tile);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += t[c];
        ++count;
    });
    for (float& c : sum) c /= count;
    grade(sum, use);
    return sum;
}

bool TextureStore::channel_is_one(int texture, int c) const noexcept {
    const Use& use = impl_->uses[static_cast<std::size_t>(texture)];
    const bool bounded = use.wrap_u == Wrap::black || use.wrap_v == Wrap::black;
    const bool graded = c < 3 && (use.gain != 1 || use.bias != 0);
    bool one = true, any_alpha = false;
    impl_->each_source(use, [&](const TextureSource& s) {
        one = one && (s.tile < 0 ? s.pyramid.is_one[static_cast<std::size_t>(c)]
                                 : impl_->cache->channel_is_one(s.tile, c));
        any_alpha = any_alpha || s.alpha;
    });
    // Where a tile is missing stands magenta, whose green is 0.
    const bool whole = use.set < 0 || c != 1;
    return (c == 3 && !any_alpha) || (one && !bounded && !graded && whole);
}

bool TextureStore::is_missing(int texture) const noexcept {
    bool missing = false;
    impl_->each_source(impl_->uses[static_cast<std::size_t>(texture)],
                       [&](const TextureSource& s) { missing = missing || s.magenta; });
    return missing;
}

bool TextureStore::has_alpha(int texture) const noexcept {
    bool any = false;
    impl_->each_source(impl_->uses[static_cast<std::size_t>(texture)],
                       [&](const TextureSource& s) { any = any || s.alpha; });
    return any;
}

std::int64_t TextureStore::memory_bytes() const noexcept { return counts().memory_bytes; }

TextureCounts TextureStore::counts() const noexcept {
    TextureCounts c;
    for (const TextureSource& s : impl_->sources) {
        ++(s.tile < 0 ? c.in_core : c.cached);
        c.memory_bytes += s.pyramid.memory_bytes();
    }
    if (!impl_->cache) return c;
    c.memory_bytes += impl_->cache->memory_bytes();
    c.bytes_read = impl_->cache->bytes_read();
    c.failures = impl_->cache->failures();
    return c;
}

}  // namespace tessera
