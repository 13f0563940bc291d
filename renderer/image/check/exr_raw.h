#pragma once
// An EXR's headers and chunk table as they are, read without trust and without a library: what a
// damaged or hostile file says is known before anything is allocated for it.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

enum class ExrType : std::uint8_t { integer, half, real };

struct RawChannel {
    std::string name;
    ExrType type = ExrType::half;
    int sampling_x = 1, sampling_y = 1;

    std::string layer() const;  // "" = root
    std::string token() const;  // after the last dot
};

struct RawBox {
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // x1, y1 excluded
    bool operator==(const RawBox&) const = default;
    std::int64_t width() const { return x1 - x0; }
    std::int64_t height() const { return y1 - y0; }
    bool sane() const;
};

struct RawPart {
    std::string name;
    int compression = 0;
    RawBox data, display;
    std::vector<RawChannel> channels;
    std::map<std::string, std::pair<std::string, std::string>> attributes;  // type, bytes
    bool tiled = false, deep = false;
    std::uint64_t table = 0;  // where the chunks' places are listed
    std::uint64_t chunks = 0, missing = 0;

    /// A string attribute, "" if there is none.
    std::string text(const std::string& attribute) const;
    bool lossy() const { return compression == 8 || compression == 9; }  // DWAA, DWAB
    /// B44 and PXR24 change values too: of halves, of floats.
    bool lossy(ExrType type) const;
    int chunk_lines() const;
};

struct RawExr {
    std::vector<RawPart> parts;
    std::string damage;  // why reading stopped; parts hold what came before
};

RawExr read_raw_exr(const std::string& path);

}  // namespace tessera
