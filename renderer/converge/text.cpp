#include "renderer/converge/text.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/core/utf8.h"

namespace tessera {

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : as_utf8(std::string(text))) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
        }
    }
    return out;
}

std::string inside_script(std::string_view json) {
    std::string out;
    for (const char c : json) {
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    }
    return out;
}

std::string csv_field(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

std::string base64(std::string_view bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three =
                three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
}

std::string three_figures(double v) {
    if (!std::isfinite(v)) return "-";
    if (v == 0) return "0";
    if ((std::fabs(v) < 1e-4 || std::fabs(v) >= 1e6)) return fmt::format("{:.2e}", v);
    if (std::fabs(v) >= 100) return fmt::format("{:.0f}", v);
    return fmt::format("{:#.3g}", v);
}

std::string duration(double seconds) {
    if (!std::isfinite(seconds)) return "-";
    if (seconds < 0.1) return fmt::format("{:.3g} ms", seconds * 1e3);
    if (seconds < 600) return fmt::format("{:.3g} s", seconds);
    if (seconds < 2 * 3600) return fmt::format("{:.3g} min", seconds / 60);
    return fmt::format("{:.3g} h", seconds / 3600);
}

std::string with_prefix(double v) {
    if (!std::isfinite(v)) return "-";
    if (v >= 1e9) return fmt::format("{:.3g} G", v * 1e-9);
    if (v >= 1e6) return fmt::format("{:.3g} M", v * 1e-6);
    if (v >= 1e3) return fmt::format("{:.3g} k", v * 1e-3);
    return fmt::format("{:.3g}", v);
}

}  // namespace tessera
