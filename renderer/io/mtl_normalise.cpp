#include "renderer/io/mtl_normalise.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "renderer/core/cie.h"
#include "renderer/io/obj_text.h"

namespace tessera {
namespace {

enum class Kind : std::uint8_t { color, number, texture, ignored, unsupported };

struct Key {
    std::string_view lower;     // as compared
    std::string_view spelling;  // as the parser knows it
    Kind kind;
};

constexpr std::array kKeys{
    Key{"ka", "Ka", Kind::color},
    Key{"kd", "Kd", Kind::color},
    Key{"ks", "Ks", Kind::color},
    Key{"ke", "Ke", Kind::color},
    Key{"tf", "Tf", Kind::color},
    Key{"kt", "Tf", Kind::color},
    Key{"ns", "Ns", Kind::number},
    Key{"ni", "Ni", Kind::number},
    Key{"d", "d", Kind::number},
    Key{"tr", "Tr", Kind::number},
    Key{"illum", "illum", Kind::number},
    Key{"pr", "Pr", Kind::number},
    Key{"pm", "Pm", Kind::number},
    Key{"aniso", "aniso", Kind::number},
    Key{"ps", "Ps", Kind::number},
    Key{"pc", "Pc", Kind::number},
    Key{"pcr", "Pcr", Kind::number},
    Key{"map_ps", "map_Ps", Kind::texture},
    Key{"map_kd", "map_Kd", Kind::texture},
    Key{"map_ks", "map_Ks", Kind::texture},
    Key{"map_ke", "map_Ke", Kind::texture},
    Key{"map_d", "map_d", Kind::texture},
    Key{"map_opacity", "map_d", Kind::texture},
    Key{"map_tr", "map_Tr", Kind::texture},
    Key{"map_pr", "map_Pr", Kind::texture},
    Key{"map_pm", "map_Pm", Kind::texture},
    Key{"norm", "norm", Kind::texture},
    Key{"map_norm", "norm", Kind::texture},
    Key{"map_kn", "norm", Kind::texture},
    Key{"bump", "bump", Kind::texture},
    Key{"map_bump", "bump", Kind::texture},
    Key{"disp", "disp", Kind::texture},
    Key{"map_disp", "disp", Kind::texture},
    Key{"map_ka", "map_Ka", Kind::ignored},
    Key{"sharpness", "sharpness", Kind::ignored},
    Key{"anisor", "anisor", Kind::unsupported},
    Key{"map_ns", "map_Ns", Kind::unsupported},
    Key{"map_pc", "map_Pc", Kind::unsupported},
    Key{"map_pcr", "map_Pcr", Kind::unsupported},
    Key{"map_aniso", "map_aniso", Kind::unsupported},
    Key{"map_anisor", "map_anisor", Kind::unsupported},
    Key{"decal", "decal", Kind::unsupported},
    Key{"refl", "refl", Kind::unsupported},
    Key{"map_refl", "refl", Kind::unsupported},
};

// How many words follow a texture option: numbers (padded to `count` with `fill`) or one other
// word.
struct Option {
    std::string_view name;
    int count;
    bool numeric;
    std::array<std::string_view, 3> fill;
    bool passed;  // the parser knows it and we use it
};

constexpr std::array kOptions{
    Option{"-s", 3, true, {"1", "1", "1"}, true},
    Option{"-o", 3, true, {"0", "0", "0"}, true},
    Option{"-t", 3, true, {"0", "0", "0"}, false},
    Option{"-mm", 2, true, {"0", "1", ""}, true},
    Option{"-bm", 1, true, {"1", "", ""}, true},
    Option{"-boost", 1, true, {"0", "", ""}, false},
    Option{"-texres", 1, true, {"0", "", ""}, false},
    Option{"-clamp", 1, false, {"on", "", ""}, true},
    Option{"-imfchan", 1, false, {"m", "", ""}, true},
    Option{"-colorspace", 1, false, {"", "", ""}, true},
    Option{"-blendu", 1, false, {"", "", ""}, false},
    Option{"-blendv", 1, false, {"", "", ""}, false},
    Option{"-cc", 1, false, {"", "", ""}, false},
    Option{"-type", 1, false, {"", "", ""}, false},
};

std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = end == word.data() + word.size();
    if (error != std::errc() || !whole || !(std::abs(value) <= 1e30)) return std::nullopt;
    return value;
}

void append_number(std::string& out, double value) {
    // Plain or exponent notation of 17 figures: short enough for the parser's own grammar.
    std::array<char, 40> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::scientific)
                         .ptr;
    out += ' ';
    out.append(digits.data(), end);
}

class BlockWriter {
public:
    BlockWriter(Tally& tally, std::set<std::string, std::less<>>& seen)
        : tally_(&tally), seen_(&seen) {}

    void statement(std::string_view line, std::uint32_t number);
    MtlBlock take() { return std::move(block_); }

private:
    void color(std::string_view key, std::string_view rest);
    void number(std::string_view key, std::string_view rest);
    void texture(std::string_view key, std::string_view rest);
    std::string_view option(const Option& option, std::string_view rest, std::string& out);
    void begin(std::string_view key);
    void complain(const char* what, std::string_view key);
    void damage(const char* what, std::string_view key);

    Tally* tally_;
    std::set<std::string, std::less<>>* seen_;
    MtlBlock block_;
    std::uint32_t line_ = 0;
};

void BlockWriter::begin(std::string_view key) {
    block_.given[std::string(key)] = line_;
    // The parser's own names for what we tell apart.
    block_.text += key == "map_Tr" ? "map_d" : key;
}

void BlockWriter::complain(const char* what, std::string_view key) {
    tally_->add(what, line_, "'" + std::string(key.substr(0, 40)) + "'");
}

void BlockWriter::damage(const char* what, std::string_view key) {
    tally_->damage(what, line_, "'" + std::string(key.substr(0, 40)) + "'");
}

void BlockWriter::statement(std::string_view line, std::uint32_t number_of_line) {
    const auto [word, rest] = split_word(line);
    if (word.empty() || word.front() == '#') return;
    line_ = number_of_line;
    const std::string lower = to_lower(word);
    const auto key =
        std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.lower == lower; });
    const Kind kind = key == kKeys.end() ? Kind::unsupported : key->kind;
    switch (kind) {
        case Kind::color:
            return color(key->spelling, rest);
        case Kind::number:
            return number(key->spelling, rest);
        case Kind::texture:
            return texture(key->spelling, rest);
        case Kind::ignored:
            return;
        case Kind::unsupported:
            break;
    }
    const bool known = key != kKeys.end();
    constexpr std::size_t kMostReported = 20;
    if (seen_->size() >= kMostReported ||
        !seen_->insert(known ? std::string(key->spelling) : lower).second)
        return;
    complain(known ? "not supported yet, ignored:" : "unknown material statement, ignored:", word);
}

void BlockWriter::color(std::string_view key, std::string_view rest) {
    auto [word, more] = split_word(rest.substr(0, rest.find('#')));
    const bool xyz = word == "xyz";
    if (word == "spectral") return complain("spectral colours are not supported, ignored:", key);
    if (xyz) {
        const WordSplit next = split_word(more);
        word = next.word;
        more = next.rest;
    }
    std::array<double, 3> c{};
    std::size_t count = 0;
    while (count < c.size() && !word.empty()) {
        const auto value = finite_number(word);
        if (!value) return damage("broken material statement: not a finite number in", key);
        c[count++] = *value;
        const WordSplit next = split_word(more);
        word = next.word;
        more = next.rest;
    }
    if (count == 0) return damage("broken material statement: a value is missing after", key);
    // One value is grey; so are the channels that two leave out.
    for (std::size_t i = count; i < c.size(); ++i) c[i] = c[0];
    if (xyz) {
        const Vec3d rgb = xyz_to_rec709(Vec3d(c));
        c = {rgb.x, rgb.y, rgb.z};
    }
    begin(key);
    for (const double value : c) append_number(block_.text, value);
    block_.text += '\n';
}

void BlockWriter::number(std::string_view key, std::string_view rest) {
    auto [word, more] = split_word(rest.substr(0, rest.find('#')));
    if (word == "-halo") word = split_word(more).word;
    if (word.empty()) return damage("broken material statement: a value is missing after", key);
    const auto value = finite_number(word);
    if (!value) return damage("broken material statement: not a finite number in", key);
    begin(key);
    if (key == "illum") {
        block_.text += ' ' + std::to_string(static_cast<int>(std::clamp(*value, -1.0, 99.0)));
    } else {
        append_number(block_.text, *value);
    }
    block_.text += '\n';
}

// Appends the option with all its values to out; returns what follows.
std::string_view BlockWriter::option(const Option& option, std::string_view rest,
                                     std::string& out) {
    std::string text = " " + std::string(option.name);
    for (int i = 0; i < option.count; ++i) {
        const auto [word, more] = split_word(rest);
        const auto value = option.numeric ? finite_number(word) : std::nullopt;
        // The last word is the file, even if it looks like a number.
        const bool taken = !more.empty() && (!option.numeric || value);
        if (value && taken) {
            append_number(text, *value);
        } else {
            text += ' ';
            text += taken ? word : option.fill[static_cast<std::size_t>(i)];
        }
        if (taken) rest = more;
    }
    if (option.passed) out += text;
    return rest;
}

void BlockWriter::texture(std::string_view key, std::string_view rest) {
    std::string options;
    rest = clean_name(rest);
    while (rest.starts_with('-')) {
        const auto [word, more] = split_word(rest);
        if (more.empty()) break;
        const std::string lower = to_lower(word);
        const auto known = std::find_if(kOptions.begin(), kOptions.end(),
                                        [&](const Option& o) { return o.name == lower; });
        if (known != kOptions.end()) {
            rest = option(*known, more, options);
            continue;
        }
        complain("unknown texture option, ignored:", word);
        rest = more;
        for (WordSplit next = split_word(rest); !next.rest.empty(); next = split_word(rest)) {
            const bool value = finite_number(next.word) || next.word == "on" || next.word == "off";
            if (!value) break;
            rest = next.rest;
        }
    }
    if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"')
        rest = rest.substr(1, rest.size() - 2);
    rest = trim(rest);
    if (rest.empty()) return complain("a file name is missing, statement ignored:", key);
    std::string file(rest);
    std::replace(file.begin(), file.end(), '\\', '/');
    std::replace(file.begin(), file.end(), '\0', '_');
    if (file.front() == '-') file.insert(0, "./");
    begin(key);
    block_.text += options + ' ' + file + '\n';
}

}  // namespace

std::unordered_map<std::string, MtlSection> index_mtl(std::string_view text, Tally& tally) {
    std::unordered_map<std::string, MtlSection> out;
    LineReader reader(text);
    MtlSection* open = nullptr;
    while (const auto line = reader.next()) {
        const auto [word, rest] = split_word(*line);
        if (to_lower(word.substr(0, 7)) != "newmtl") continue;
        if (open) open->end = reader.offset();
        const std::string name(clean_name(rest));
        const auto [entry, added] = out.try_emplace(name);
        if (!added)
            tally.add("material is defined twice, the first counts:", reader.line(),
                      "'" + name + "'");
        open = added ? &entry->second : nullptr;
        if (open) *open = {reader.offset(), text.size(), reader.line()};
    }
    return out;
}

MtlBlock normalise_mtl(std::string_view text, const MtlSection& section, Tally& tally,
                       std::set<std::string, std::less<>>& seen) {
    LineReader reader(text.substr(section.begin, section.end - section.begin), section.line);
    BlockWriter writer(tally, seen);
    reader.next();  // newmtl itself
    while (const auto line = reader.next()) writer.statement(*line, reader.line());
    return writer.take();
}

}  // namespace tessera
