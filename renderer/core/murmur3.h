#pragma once
// Names as numbers, the way Cryptomatte has them.

#include <cstdint>
#include <string_view>

namespace tessera {

/// MurmurHash3_x86_32 (Appleby, public domain).
std::uint32_t murmur3(std::string_view bytes, std::uint32_t seed = 0) noexcept;

/// The bits of a name's id as a float: its hash, kept from being zero, denormal, infinite or no
/// number. Friedman and Jones, "Cryptomatte specification" 1.2.0. Never 0, which is nothing's id.
std::uint32_t cryptomatte_id(std::string_view name) noexcept;

}  // namespace tessera
