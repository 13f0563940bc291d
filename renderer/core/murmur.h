#pragma once
// MurmurHash3_x86_32 (Appleby, 2011) of a name, and the float that Cryptomatte makes of it
// (Friedman and Jones, Cryptomatte Specification 1.2.0).

#include <bit>
#include <cstdint>
#include <string_view>

namespace tessera {

constexpr std::uint32_t murmur3(std::string_view text, std::uint32_t seed = 0) noexcept {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    };
    const auto mix = [](std::uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; };
    std::uint32_t h = seed;
    const std::size_t whole = text.size() & ~std::size_t{3};
    for (std::size_t i = 0; i < whole; i += 4) {
        const std::uint32_t k = byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24;
        h = std::rotl(h ^ mix(k), 13) * 5 + 0xe6546b64u;
    }
    std::uint32_t tail = 0;
    for (std::size_t i = text.size(); i > whole; --i) tail = tail << 8 | byte(i - 1);
    h ^= mix(tail);
    h ^= static_cast<std::uint32_t>(text.size());
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

/// The bits of a name's id: the hash, moved away from the exponents of 0, infinity and NaN.
constexpr std::uint32_t cryptomatte_bits(std::string_view name) noexcept {
    const std::uint32_t h = murmur3(name);
    const std::uint32_t exponent = h >> 23 & 255u;
    return exponent == 0 || exponent == 255 ? h ^ 1u << 23 : h;
}

}  // namespace tessera
