#include "renderer/io/obj_number.h"

#include <charconv>
#include <limits>

namespace tessera {
namespace {

bool is_digit(char c) noexcept { return static_cast<unsigned>(c - '0') < 10; }

std::int64_t parse_index(const char*& at, const char* end) noexcept {
    constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
    const bool negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+')) ++at;
    std::int64_t value = 0;
    for (; at < end && is_digit(*at); ++at) {
        const int digit = *at - '0';
        value = value > (kMax - digit) / 10 ? kMax : value * 10 + digit;
    }
    return negative ? -value : value;
}

}  // namespace

bool is_coordinate(std::string_view word) noexcept {
    constexpr int kMaxPlaces = 15;
    const char* at = word.data();
    const char* const end = at + word.size();
    if (at < end && (*at == '-' || *at == '+')) ++at;

    const char* const whole = at;
    while (at < end && *at == '0') ++at;
    const char* const significant = at;
    while (at < end && is_digit(*at)) ++at;
    std::int64_t places = at - significant;  // the value is below 10^places
    std::int64_t digits = at - whole;
    if (at < end && *at == '.') {
        const char* const fraction = ++at;
        while (at < end && is_digit(*at)) ++at;
        digits += at - fraction;
        if (places == 0) {
            const char* zero = fraction;
            while (zero < at && *zero == '0') ++zero;
            places = fraction - zero;
        }
    }
    if (digits == 0) return false;
    if (at == end) return places <= kMaxPlaces;
    if (*at != 'e' && *at != 'E') return false;

    ++at;
    const bool negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+')) ++at;
    if (at == end) return false;
    std::int64_t exponent = 0;
    for (; at < end && is_digit(*at); ++at) {
        if (exponent < 100000) exponent = exponent * 10 + (*at - '0');
    }
    // tinyobjloader keeps the exponent in an int and raises 5 to it: thousands are no length.
    return at == end && exponent < 1000 && places + (negative ? -exponent : exponent) <= kMaxPlaces;
}

double coordinate(std::string_view word) noexcept {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    std::from_chars(word.data(), word.data() + word.size(), value);
    return value;
}

std::optional<ObjCornerText> parse_corner(std::string_view word) noexcept {
    const char* at = word.data();
    const char* const end = at + word.size();
    if (at == end || *at == '/') return std::nullopt;
    ObjCornerText corner;
    corner.position = parse_index(at, end);
    if (at < end && *at == '/') corner.uv = parse_index(++at, end);
    if (at < end && *at == '/') corner.normal = parse_index(++at, end);
    if (at != end) return std::nullopt;
    return corner;
}

}  // namespace tessera
