#include "renderer/io/obj_normalise.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "renderer/io/obj_number.h"

namespace tessera {
namespace {

constexpr std::size_t kChunkBytes = 1 << 16;
constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();

// The next word of a line of numbers; a '#' ends the line wherever it stands.
std::string_view next_number_word(std::string_view& rest) noexcept {
    const char* at = rest.data();
    const char* const end = at + rest.size();
    while (at < end && is_blank(*at)) ++at;
    const char* const begin = at;
    while (at < end && !is_blank(*at) && *at != '#') ++at;
    rest = (at < end && *at == '#') ? std::string_view()
                                    : std::string_view(at, static_cast<std::size_t>(end - at));
    return {begin, static_cast<std::size_t>(at - begin)};
}

std::int32_t smoothing_group(std::string_view text) noexcept {
    const std::string_view word = next_number_word(text);
    if (word == "on") return 1;
    std::int32_t group = 0;
    std::from_chars(word.data(), word.data() + word.size(), group);
    return std::max(group, 0);
}

std::string quoted(std::string_view text) {
    constexpr std::size_t kShown = 60;
    std::string out = "'";
    for (const char c : text.substr(0, kShown)) {
        const auto byte = static_cast<unsigned char>(c);
        out += byte < 32 || byte == 127 ? '?' : c;
    }
    return out + (text.size() > kShown ? "...'" : "'");
}

bool is_index_bad(std::int64_t index, std::int64_t count_so_far) noexcept {
    return index > kMaxCount || index < -count_so_far;
}

}  // namespace

ObjStatements ObjNormaliser::take() {
    if (failure_) std::rethrow_exception(failure_);
    found_.remainder.vertices = static_cast<std::uint64_t>(vertices_);
    return std::move(found_);
}

// The stream that reads from here swallows exceptions, so they are kept for take().
ObjNormaliser::int_type ObjNormaliser::underflow() {
    out_.clear();
    try {
        while (out_.size() < kChunkBytes && !failure_) {
            const auto line = reader_.next();
            if (!line) break;
            statement(*line);
        }
    } catch (...) {
        failure_ = std::current_exception();
    }
    if (failure_ || out_.empty()) return traits_type::eof();
    setg(out_.data(), out_.data(), out_.data() + out_.size());
    return traits_type::to_int_type(out_.front());
}

void ObjNormaliser::statement(std::string_view line) {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    if (line.empty() || line.front() == '#') return;
    std::size_t length = 0;
    while (length < line.size() && !is_blank(line[length]) && line[length] != '#') ++length;
    const std::string_view keyword = line.substr(0, length);
    const std::string_view rest = line.substr(length);
    if (keyword == "v") return vertex(rest);
    if (keyword == "f" || keyword == "fo") return face(rest);
    if (keyword == "vn") return attribute(rest, "vn", 3, 3);
    if (keyword == "vt") return attribute(rest, "vt", 1, 2);
    other(keyword, rest);
}

void ObjNormaliser::vertex(std::string_view rest) {
    std::array<std::string_view, 6> words;
    std::size_t count = 0;
    for (; count < words.size(); ++count) {
        words[count] = next_number_word(rest);
        if (words[count].empty()) break;
    }
    if (++vertices_ > kMaxCount)
        throw Error(ExitCode::scene, {tally_->file()}, "too many vertices");
    const bool good = count >= 3 && std::all_of(words.begin(), words.begin() + 3, is_coordinate);
    if (!good) {
        for (const std::string_view word : words) refuse_decimal_comma(word);
        tally_->add("vertex is not three finite numbers below 1e15", reader_.line());
        found_.bad_vertices.push_back({static_cast<std::uint32_t>(vertices_ - 1), reader_.line()});
        out_ += "v 1e999 0 0\n";
        return;
    }
    out_ += "v ";
    out_.append(words[0].data(), words[2].data() + words[2].size());
    out_ += '\n';
    if (count == words.size()) color(words.data() + 3);
}

// Vertex colours are taken as linear: files do not say, and most writers store them so.
void ObjNormaliser::color(const std::string_view* words) {
    std::vector<float>& colors = found_.colors;
    if (!std::all_of(words, words + 3, is_coordinate)) {
        tally_->damage("broken vertex colour: not three finite numbers", reader_.line());
        return;
    }
    colors.resize(static_cast<std::size_t>(vertices_ - 1) * 3, 1.0f);
    for (int i = 0; i < 3; ++i) colors.push_back(static_cast<float>(coordinate(words[i])));
}

void ObjNormaliser::attribute(std::string_view rest, const char* keyword, int wanted, int passed) {
    std::array<std::string_view, 3> words;
    int count = 0;
    bool good = true;
    for (; count < passed; ++count) {
        words[count] = next_number_word(rest);
        if (words[count].empty()) break;
        good = good && is_coordinate(words[count]);
    }
    std::int64_t& total = passed == 3 ? normals_ : uvs_;
    if (++total > kMaxCount)
        throw Error(ExitCode::scene, {tally_->file()}, "too many vt or vn lines");
    out_ += keyword;
    if (good && count >= wanted) {
        out_ += ' ';
        const std::string_view last = words[count - 1];
        out_.append(words[0].data(), last.data() + last.size());
    } else {
        for (const std::string_view word : words) refuse_decimal_comma(word);
        tally_->damage(passed == 3 ? "broken vn: not three finite numbers"
                                   : "broken vt: not one to three finite numbers",
                       reader_.line());
        out_ += " 1e999 0 0";
    }
    out_ += '\n';
}

void ObjNormaliser::face(std::string_view rest) {
    ++found_.remainder.faces_seen;
    const std::size_t begin = out_.size();
    const std::uint32_t line = reader_.line();
    const auto drop = [&](const char* why, const std::string& detail = {}) {
        out_.resize(begin);
        tally_->damage(why, line, detail);
    };
    std::size_t corners = 0;
    bool attributes_bad = false;
    out_ += 'f';
    for (std::string_view word; !(word = next_number_word(rest)).empty(); ++corners) {
        const auto corner = parse_corner(word);
        if (!corner)
            return drop("broken face: corners must be v, v/vt, v//vn or v/vt/vn, not",
                        quoted(word));
        if (corner->position == 0)
            return drop("broken face: indices count from 1, index 0 is in", quoted(word));
        if (is_index_bad(corner->position, vertices_))
            return drop("broken face: there is no such vertex:", quoted(word));
        out_ += ' ';
        if (is_index_bad(corner->uv, uvs_) || is_index_bad(corner->normal, normals_)) {
            attributes_bad = true;
            out_ += std::to_string(corner->position);
        } else {
            out_ += word;
        }
    }
    if (corners < 3) {
        // Exporters write edges so.
        out_.resize(begin);
        return tally_->add("face of fewer than three corners dropped", line);
    }
    if (attributes_bad) tally_->add("face names a vt or vn that is not there; it is ignored", line);
    out_ += '\n';
    if (found_.face_lines.size() >= static_cast<std::size_t>(kMaxCount))
        throw Error(ExitCode::scene, {tally_->file()}, "too many faces");
    found_.face_lines.push_back(line);
}

void ObjNormaliser::other(std::string_view keyword, std::string_view rest) {
    if (keyword == "usemtl") ++found_.remainder.materials_named;
    if (keyword == "usemtl") return event(ObjStatement::material, name_index(clean_name(rest)));
    if (keyword == "o") return event(ObjStatement::object, name_index(clean_name(rest)));
    if (keyword == "g") return event(ObjStatement::group, name_index(clean_name(rest)));
    if (keyword == "s") return event(ObjStatement::smoothing, smoothing_group(rest));
    if (keyword == "mtllib") {
        found_.libraries.push_back({std::string(clean_name(rest)), reader_.line()});
    } else if (keyword == "l" || keyword == "p") {
        ++found_.remainder.points_and_lines;
    } else if (++found_.remainder.not_understood == 1) {
        found_.remainder.first_not_understood = quoted(keyword);
        found_.remainder.first_not_understood_line = reader_.line();
    }
}

void ObjNormaliser::event(ObjStatement kind, std::int32_t value) {
    const auto face = static_cast<std::uint32_t>(found_.face_lines.size());
    found_.events.push_back({face, reader_.line(), value, kind});
}

std::int32_t ObjNormaliser::name_index(std::string_view name) {
    const auto next = static_cast<std::int32_t>(found_.names.size());
    const auto [entry, added] = name_numbers_.try_emplace(std::string(name), next);
    if (added) found_.names.emplace_back(name);
    return entry->second;
}

// Readers that stop at the comma see whole numbers and build a wrong model in silence.
void ObjNormaliser::refuse_decimal_comma(std::string_view word) const {
    const std::size_t comma = word.find(',');
    if (comma == std::string_view::npos || comma == 0 || comma + 1 >= word.size()) return;
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (!is_digit(word[comma - 1]) || !is_digit(word[comma + 1])) return;
    throw Error(ExitCode::scene, {tally_->file(), static_cast<int>(reader_.line()), 0},
                "decimal comma in " + quoted(word) + "; write numbers with a point");
}

}  // namespace tessera
