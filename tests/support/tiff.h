#pragma once
// Writes small uncompressed TIFF files, so that tests know every stored value.

#include <bit>
#include <cstdint>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace tessera {

/// values: row-major from the top, channels interleaved. alpha: 0 none, 1 premultiplied, 2 as
/// painted. T is std::uint8_t, std::uint16_t, or float for up to two channels.
template <class T>
void write_tiff(const std::string& path, int width, int height, int channels, int alpha,
                const std::vector<T>& values) {
    std::string out("II*\0", 4);
    const auto put = [&](std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
    };
    const auto data_bytes = static_cast<std::uint32_t>(values.size() * sizeof(T));
    constexpr std::uint32_t kBits = 8 * sizeof(T);
    const std::uint32_t bits_at = 8 + data_bytes, ifd_at = bits_at + 8;
    put(ifd_at, 4);
    for (const T value : values) {
        if constexpr (std::is_floating_point_v<T>)
            put(std::bit_cast<std::uint32_t>(value), sizeof(T));
        else
            put(value, sizeof(T));
    }
    for (int i = 0; i < 4; ++i) put(kBits, 2);
    struct Entry {
        std::uint32_t tag, type, count, value;
    };
    const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
    const auto n = static_cast<std::uint32_t>(channels);
    std::vector<Entry> entries{{256, 4, 1, w},
                               {257, 4, 1, h},
                               {258, 3, n, n > 2 ? bits_at : kBits * 0x10001u},
                               {259, 3, 1, 1},
                               {262, 3, 1, n < 3 ? 1u : 2u},
                               {273, 4, 1, 8},
                               {277, 3, 1, n},
                               {278, 4, 1, h},
                               {279, 4, 1, data_bytes}};
    if (n == 1) entries[2].value = kBits;
    if (alpha > 0) entries.push_back({338, 3, 1, static_cast<std::uint32_t>(alpha)});
    if (std::is_floating_point_v<T>) entries.push_back({339, 3, n, n > 1 ? 0x30003u : 3u});
    put(static_cast<std::uint32_t>(entries.size()), 2);
    for (const Entry& e : entries) {
        put(e.tag, 2);
        put(e.type, 2);
        put(e.count, 4);
        put(e.value, 4);
    }
    put(0, 4);
    std::ofstream(path, std::ios::binary) << out;
}

}  // namespace tessera
