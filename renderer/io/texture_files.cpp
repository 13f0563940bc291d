#include "renderer/io/texture_files.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace tessera {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr int kWidest = 9;       // digits of a frame
constexpr int kColumns = 10;     // of a UDIM set
constexpr int kMostRows = 1000;  // of either kind

/// Where a token stands in a name.
struct Token {
    std::size_t at = 0, length = 0;
    int width = 0;  // of a frame's number, padded with zeros
    bool udim = true;
};

bool all_digits(std::string_view text) {
    return text.find_first_not_of(kDigits) == std::string_view::npos;
}

std::optional<int> width_in(std::string_view digits) {
    int width = 0;
    if (!digits.empty() && (!all_digits(digits) || digits.size() > 2)) return std::nullopt;
    std::from_chars(digits.data(), digits.data() + digits.size(), width);
    if (width > kWidest) return std::nullopt;
    return width;
}

/// "%d", "%04d" at a place.
std::optional<Token> printf_token(std::string_view name, std::size_t at) {
    const std::size_t end = name.find_first_not_of(kDigits, at + 1);
    if (end == std::string_view::npos || name[end] != 'd') return std::nullopt;
    const auto width = width_in(name.substr(at + 1, end - at - 1));
    if (!width) return std::nullopt;
    return Token{at, end + 1 - at, *width};
}

/// "<frame>", "<F>", "<F4>", "<f4>" at a place.
std::optional<Token> bracket_token(std::string_view name, std::size_t at) {
    const std::size_t end = name.find('>', at);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view word = name.substr(at + 1, end - at - 1);
    if (word == "frame") return Token{at, end + 1 - at};
    if (word.empty() || (word[0] != 'F' && word[0] != 'f')) return std::nullopt;
    const auto width = width_in(word.substr(1));
    if (!width) return std::nullopt;
    return Token{at, end + 1 - at, *width};
}

/// The last one in the name: "shot_##_tex.####.png" counts by the second.
std::optional<Token> frame_token(std::string_view name) {
    for (std::size_t i = name.size(); i-- > 0 && name[i] != '/';) {
        std::optional<Token> token;
        if (name[i] == '#') {
            std::size_t first = i;
            while (first > 0 && name[first - 1] == '#') --first;
            const auto width = static_cast<int>(i + 1 - first);
            if (width <= kWidest) return Token{first, i + 1 - first, width};
            i = first;
        } else if (name[i] == '%') {
            token = printf_token(name, i);
        } else if (name[i] == '<') {
            token = bracket_token(name, i);
        }
        if (token) return token;
    }
    return std::nullopt;
}

std::optional<Token> tile_token(std::string_view name) {
    for (const auto& [word, udim] :
         {std::pair{std::string_view("<UDIM>"), true}, {std::string_view("<UVTILE>"), false}}) {
        const std::size_t at = name.rfind(word);
        if (at != std::string_view::npos && name.find('/', at) == std::string_view::npos)
            return Token{at, word.size(), 0, udim};
    }
    return std::nullopt;
}

std::string with(const std::string& name, const Token& token, const std::string& text) {
    return name.substr(0, token.at) + text + name.substr(token.at + token.length);
}

/// The whole number that text is, to the last character.
std::optional<int> number_in(std::string_view text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<int> frame_in(std::string_view text, int width) {
    const auto frame = number_in(text);
    if (!frame || fmt::format("{:0{}}", *frame, width) != text) return std::nullopt;
    return frame;
}

std::optional<TextureTile> tile_in(std::string_view text, bool udim) {
    if (udim) {
        const auto number = number_in(text);
        if (!number || text.size() < 4 || *number < 1001) return std::nullopt;
        const int index = *number - 1001;
        if (index / kColumns >= kMostRows) return std::nullopt;
        return TextureTile{index % kColumns, index / kColumns, ""};
    }
    const std::size_t cut = text.find("_v");
    if (cut == std::string_view::npos || text[0] != 'u') return std::nullopt;
    const auto u = number_in(text.substr(1, cut - 1)), v = number_in(text.substr(cut + 2));
    if (!u || !v || *u < 1 || *v < 1 || *u > kMostRows || *v > kMostRows) return std::nullopt;
    return TextureTile{*u - 1, *v - 1, ""};
}

/// Calls visit(text in the token's place, full name) for the files there that fit the name.
template <class Visit>
void each_fitting(const AssetRules& assets, const std::string& name, const Token& token,
                  const std::string& base_dir, const Visit& visit) {
    const std::size_t slash = name.rfind('/');
    const std::size_t skip = slash == std::string::npos ? 0 : slash + 1;
    const std::string before = name.substr(skip, token.at - skip);
    const std::string after = name.substr(token.at + token.length);
    for (const std::string& file : assets.names_beside(name, base_dir)) {
        if (file.size() <= before.size() + after.size() || !file.starts_with(before) ||
            !file.ends_with(after))
            continue;
        visit(file.substr(before.size(), file.size() - before.size() - after.size()),
              name.substr(0, skip) + file);
    }
}

std::vector<TextureTile> find_tiles(const AssetRules& assets, const std::string& name,
                                    const Token& token, const std::string& base_dir) {
    std::vector<TextureTile> tiles;
    each_fitting(assets, name, token, base_dir,
                 [&](const std::string& text, const std::string& file) {
                     auto tile = tile_in(text, token.udim);
                     if (!tile) return;
                     tile->file = assets.find(file, base_dir).path;
                     if (!tile->file.empty()) tiles.push_back(*std::move(tile));
                 });
    std::sort(tiles.begin(), tiles.end(), [](const TextureTile& a, const TextureTile& b) {
        return std::pair(a.row, a.column) < std::pair(b.row, b.column);
    });
    // "1001" and "01001" would be the same one: the first by name stays.
    const auto same = [](const TextureTile& a, const TextureTile& b) {
        return a.row == b.row && a.column == b.column;
    };
    tiles.erase(std::unique(tiles.begin(), tiles.end(), same), tiles.end());
    return tiles;
}

/// The frames whose files are there, of a name that may have a tile token too.
std::vector<int> frames_there(const AssetRules& assets, const std::string& name, const Token& token,
                              const std::string& base_dir) {
    std::set<int> frames;
    const auto tile = tile_token(name);
    const auto look = [&](const std::string& plain, const Token& at) {
        each_fitting(assets, plain, at, base_dir, [&](const std::string& text, const std::string&) {
            if (const auto frame = frame_in(text, token.width)) frames.insert(*frame);
        });
    };
    if (!tile) {
        look(name, token);
    } else {
        for (const char* first : {"1001", "u1_v1"}) {
            const std::string plain = with(name, *tile, first);
            if (const auto at = frame_token(plain)) look(plain, *at);
        }
    }
    return {frames.begin(), frames.end()};
}

}  // namespace

std::string ranges_of(const std::vector<int>& numbers) {
    constexpr std::size_t kEnough = 120;
    std::string text;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        if (text.size() > kEnough) return text + ", ...";
        text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
        if (last > i) text += "-" + std::to_string(numbers[last]);
        i = last + 1;
    }
    return text;
}

TextureFiles find_texture_files(const AssetRules& assets, const std::string& written,
                                const std::string& base_dir, int frame) {
    TextureFiles out;
    out.name = written;
    out.found = assets.find(written, base_dir);
    if (!out.found.path.empty() || out.found.refused) return out;
    std::string name = written;
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::string pattern = name;
    const auto counted = frame_token(name);
    if (counted) name = with(name, *counted, fmt::format("{:0{}}", frame, counted->width));
    const auto tile = tile_token(name);
    if (counted) {
        out.name = name;
        out.found = assets.find(name, base_dir);
    }
    if (tile) {
        out.tiles = find_tiles(assets, name, *tile, base_dir);
        if (!out.tiles.empty()) {
            // Tiles lie side by side: the set's own name is the token in one of theirs.
            const std::string& first = out.tiles.front().file;
            const std::size_t slash = first.rfind('/') + 1, cut = name.rfind('/');
            out.found = {};
            out.found.path =
                first.substr(0, slash) + name.substr(cut == std::string::npos ? 0 : cut + 1);
        }
    }
    if (!out.found.path.empty() || out.found.refused) return out;
    if (!counted) {
        if (tile)
            out.missing = "has no tiles (looked for '" +
                          with(name, *tile, tile->udim ? "1001" : "u1_v1") + "', '" +
                          with(name, *tile, tile->udim ? "1002" : "u2_v1") + "', ... in " +
                          base_dir + ")";
        return out;
    }
    const std::string there = ranges_of(frames_there(assets, pattern, *counted, base_dir));
    out.missing = there.empty() ? "is missing, and so is every other frame"
                                : "is missing (there are frames " + there + ")";
    return out;
}

}  // namespace tessera
