#include "renderer/core/murmur3.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <set>
#include <string>

using namespace tessera;
using namespace std::string_literals;

TEST_CASE("murmur3: published values of every length of tail and several seeds come out") {
    struct {
        std::string bytes;
        std::uint32_t seed, hash;
    } const cases[] = {
        {"", 0, 0},
        {"", 1, 0x514e28b7},
        {"", 0xffffffff, 0x81f16f39},
        {"\xff\xff\xff\xff", 0, 0x76293b50},
        {"\x21\x43\x65\x87", 0, 0xf55b516b},
        {"\x21\x43\x65\x87", 0x5082edee, 0x2362f9de},
        {"\x21\x43\x65", 0, 0x7e4a8634},
        {"\x21\x43", 0, 0xa0f7b07a},
        {"\x21", 0, 0x72661cf4},
        {"\0\0\0\0"s, 0, 0x2362f9de},
        {"\0\0\0"s, 0, 0x85f0b427},
        {"\0\0"s, 0, 0x30f4c306},
        {"\0"s, 0, 0x514e28b7},
        {"test", 0, 0xba6bd213},
        {"test", 0x9747b28c, 0x704b81dc},
        {"Hello, world!", 0, 0xc0363e43},
        {"Hello, world!", 0x9747b28c, 0x24884cba},
        {"The quick brown fox jumps over the lazy dog", 0, 0x2e4ff723},
        {"The quick brown fox jumps over the lazy dog", 0x9747b28c, 0x2fa826cd},
        {"torus", 0, 4053562365},
        {"равнина", 0, 2518896926},
    };
    for (const auto& c : cases) {
        CAPTURE(c.bytes);
        CHECK(murmur3(c.bytes, c.seed) == c.hash);
    }
}

TEST_CASE("cryptomatte id: the specification's examples come out") {
    CHECK(cryptomatte_id("bunny") == 0x13851a76);
    // As the specification prints them; half a unit of their last digit.
    const auto id = [](const char* name) {
        return static_cast<double>(std::bit_cast<float>(cryptomatte_id(name)));
    };
    CHECK(id("torus") == doctest::Approx(-1.54943624832e+30).epsilon(1e-11));
    CHECK(id("равнина") == doctest::Approx(-1.31926312124e-25).epsilon(1e-11));
}

TEST_CASE("cryptomatte id: every name gives a normal number and never nothing's 0") {
    CHECK(cryptomatte_id("") == 0x00800000);  // the hash 0 with the exponent's last bit turned
    int turned = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string name = "n" + std::to_string(i);
        const std::uint32_t id = cryptomatte_id(name);
        REQUIRE(std::isnormal(std::bit_cast<float>(id)));
        if (id == murmur3(name)) continue;
        ++turned;
        CHECK((id ^ murmur3(name)) == 1u << 23);
    }
    // Two exponents of 256: 156 expected, 4 sigma are 50.
    CHECK(turned > 106);
    CHECK(turned < 206);
}
