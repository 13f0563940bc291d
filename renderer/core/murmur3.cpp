#include "renderer/core/murmur3.h"

#include <bit>

namespace tessera {
namespace {

constexpr std::uint32_t kC1 = 0xcc9e2d51u, kC2 = 0x1b873593u;

std::uint32_t scrambled(std::uint32_t k) noexcept { return std::rotl(k * kC1, 15) * kC2; }

// Little-endian, whatever the machine; fewer than four bytes fill up with zeros.
std::uint32_t word_at(std::string_view bytes, std::size_t at, std::size_t count) noexcept {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < count; ++i)
        word |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return word;
}

}  // namespace

std::uint32_t murmur3(std::string_view bytes, std::uint32_t seed) noexcept {
    std::uint32_t h = seed;
    const std::size_t whole = bytes.size() & ~std::size_t{3};
    for (std::size_t i = 0; i < whole; i += 4)
        h = std::rotl(h ^ scrambled(word_at(bytes, i, 4)), 13) * 5 + 0xe6546b64u;
    h ^= scrambled(word_at(bytes, whole, bytes.size() - whole));
    h ^= static_cast<std::uint32_t>(bytes.size());
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

std::uint32_t cryptomatte_id(std::string_view name) noexcept {
    const std::uint32_t h = murmur3(name);
    const std::uint32_t exponent = (h >> 23) & 255u;
    return exponent == 0 || exponent == 255 ? h ^ (1u << 23) : h;
}

}  // namespace tessera
