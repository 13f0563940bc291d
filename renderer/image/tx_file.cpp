#include "renderer/image/tx_file.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>
#include <xxhash.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "renderer/image/atomic_file.h"
#include "renderer/image/colour_space.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr int kTile = 64;
constexpr std::uint64_t kFormat = 1;  // changed when files of before are of no use

OIIO::TypeDesc type_of(TexelType type) {
    switch (type) {
        case TexelType::byte:
            return OIIO::TypeDesc::UINT8;
        case TexelType::unorm16:
            return OIIO::TypeDesc::UINT16;
        case TexelType::half:
            return OIIO::TypeDesc::HALF;
    }
    return OIIO::TypeDesc::UINT8;
}

OIIO::ImageSpec spec_of(const Pyramid& p, const Pyramid::Level& level) {
    OIIO::ImageSpec spec(level.width, level.height, p.channels, type_of(p.type));
    spec.tile_width = spec.tile_height = kTile;
    spec.alpha_channel = -1;  // values as they are: nobody shall multiply them
    spec.attribute("textureformat", "Plain Texture");  // by it levels are told from pages
    spec.attribute("compression", "zip");
    spec.attribute("planarconfig", "contig");
    if (p.type == TexelType::half) spec.attribute("tiff:half", 1);
    spec.attribute("Software", "tessera");
    spec.attribute("ImageDescription", describe_texels({p.mean, p.is_one}));
    return spec;
}

/// A tile's texels out of a pyramid's blocks; beyond the edge they are 0.
template <class T>
void gather(const std::vector<T>& from, std::size_t n, const Pyramid::Level& level, int x0, int y0,
            std::vector<T>& tile) {
    tile.assign(std::size_t(kTile) * kTile * n, T{0});
    for (int y = y0; y < std::min(y0 + kTile, level.height); ++y)
        for (int x = x0; x < std::min(x0 + kTile, level.width); ++x) {
            const std::size_t at = (level.first + level.row(y) + level.column(x)) * n;
            const auto to = static_cast<std::size_t>((y - y0) * kTile + (x - x0)) * n;
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), n,
                        tile.begin() + static_cast<std::ptrdiff_t>(to));
        }
}

template <class T>
bool write_level(OIIO::ImageOutput& out, const Pyramid& p, const Pyramid::Level& level,
                 const std::vector<T>& texels) {
    std::vector<T> tile;
    for (int y = 0; y < level.height; y += kTile)
        for (int x = 0; x < level.width; x += kTile) {
            gather(texels, static_cast<std::size_t>(p.channels), level, x, y, tile);
            if (!out.write_tile(x, y, 0, type_of(p.type), tile.data())) return false;
        }
    return true;
}

void write_levels(const Pyramid& p, const std::string& temp, const std::string& path) {
    const auto out = OIIO::ImageOutput::create("tiff");
    if (!out) fail_output(path, "no writer for TIFF: " + OIIO::geterror());
    const auto check = [&](bool good) {
        if (!good) fail_output(path, out->geterror());
    };
    for (std::size_t k = 0; k < p.levels.size(); ++k) {
        const auto mode = k == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
        check(out->open(temp, spec_of(p, p.levels[k]), mode));
        check(p.type == TexelType::byte ? write_level(*out, p, p.levels[k], p.bytes)
                                        : write_level(*out, p, p.levels[k], p.words));
    }
    check(out->close());
}

/// Bits of what a space makes of some colours: a config may change under its name.
std::uint64_t meaning_of(const std::string& space, const ColorSpaces& colors) {
    std::array<float, 15> probe{0,    0,    0,    0.05f, 0.2f, 0.6f, 0.5f, 0.5f,
                                0.5f, 0.9f, 0.3f, 0.1f,  1,    1,    1};
    colors.to_working(probe, space);
    return XXH3_64bits(probe.data(), sizeof probe);
}

}  // namespace

std::string describe_texels(const TexelSummary& s) {
    return fmt::format("tessera texels {:a} {:a} {:a} {:a} {:d}{:d}{:d}{:d}", s.mean[0], s.mean[1],
                       s.mean[2], s.mean[3], s.is_one[0], s.is_one[1], s.is_one[2], s.is_one[3]);
}

std::optional<TexelSummary> parse_texels(const std::string& text) {
    TexelSummary s;
    char ones[5] = {};
    if (std::sscanf(text.c_str(), "tessera texels %f %f %f %f %4[01]", &s.mean[0], &s.mean[1],
                    &s.mean[2], &s.mean[3], ones) != 5)
        return std::nullopt;
    for (std::size_t c = 0; c < 4; ++c) {
        if (!std::isfinite(s.mean[c])) return std::nullopt;
        s.is_one[c] = ones[c] == '1';
    }
    return s;
}

std::string default_tx_folder() {
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache == '/') return std::string(cache) + "/tessera/tx";
    const char* const home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.cache/tessera/tx" : std::string();
}

std::string tx_path(const std::string& folder, const std::string& file,
                    const std::string& color_space, const ColorSpaces& colors) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(file, error);
    if (error) return {};
    const std::uint64_t bytes = fs::file_size(real, error);
    if (error) return {};
    const auto time = fs::last_write_time(real, error).time_since_epoch().count();
    if (error) return {};
    const std::string all = fmt::format("{}\n{}\n{}\n{}\n{}\n{:x}", kFormat, real.string(), bytes,
                                        time, color_space, meaning_of(color_space, colors));
    constexpr std::size_t kLongest = 64;
    const std::string stem = real.stem().string().substr(0, kLongest);
    return fmt::format("{}/{}.{:016x}.tx", folder, stem, XXH3_64bits(all.data(), all.size()));
}

void write_tx(const Pyramid& pyramid, const std::string& path) {
    std::error_code error;
    const fs::path target(path);
    fs::create_directories(target.parent_path(), error);
    if (error) fail_output(path, error.message());
    const std::string temp =
        (target.parent_path() / fmt::format(".{}.tmp.{}", target.filename().string(), ::getpid()))
            .string();
    try {
        write_levels(pyramid, temp, path);
        fs::rename(temp, target);
    } catch (const fs::filesystem_error& failed) {
        fs::remove(temp, error);
        fail_output(path, failed.code().message());
    } catch (...) {
        fs::remove(temp, error);
        throw;
    }
}

}  // namespace tessera
