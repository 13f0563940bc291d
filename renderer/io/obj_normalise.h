#pragma once
// Between an OBJ file and the parser: passes on only `v`, `vt`, `vn` and `f` lines whose every
// number and index was checked, and keeps the other statements (names, groups, smoothing,
// libraries) itself.
//
// What is wrong stays in place, so that indices keep their meaning: an unreadable vertex is passed
// on as an infinite one, which the checks after the parser know. A face that cannot be right is
// left out.

#include <cstdint>
#include <exception>
#include <streambuf>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "renderer/io/obj_text.h"
#include "renderer/io/tally.h"

namespace tessera {

enum class ObjStatement : std::uint8_t { object, group, material, smoothing };

/// A statement that holds from face `face` (counted over the faces passed on) until the next of its
/// kind.
struct ObjEvent {
    std::uint32_t face = 0;
    std::uint32_t line = 0;
    std::int32_t value =
        0;  // index into ObjStatements::names; the group number for smoothing (0 = off)
    ObjStatement kind = ObjStatement::object;
};

/// A vertex whose position is unusable, and the line it stands on.
struct ObjBadVertex {
    std::uint32_t vertex = 0, line = 0;
};

struct ObjLibrary {
    std::string text;  // all that follows 'mtllib'
    std::uint32_t line = 0;
};

/// What gives no face.
struct ObjRemainder {
    std::uint64_t faces_seen = 0;  // 'f' lines, good or not
    std::uint64_t vertices = 0;
    std::uint64_t materials_named = 0;
    std::uint64_t points_and_lines = 0;
    std::uint64_t not_understood = 0;
    std::string first_not_understood;
    std::uint32_t first_not_understood_line = 0;
};

/// Everything the parser does not see.
struct ObjStatements {
    std::vector<ObjEvent> events;
    std::vector<std::string> names;
    std::vector<ObjLibrary> libraries;
    std::vector<std::uint32_t> face_lines;   // per face passed on
    std::vector<ObjBadVertex> bad_vertices;  // in their order
    std::vector<float> colors;               // r g b per vertex; empty: none, may end early (white)
    ObjRemainder remainder;
};

class ObjNormaliser : public std::streambuf {
public:
    /// text must outlive this.
    ObjNormaliser(std::string_view text, Tally& tally) : reader_(text), tally_(&tally) {}

    /// What was collected; call after the parser is through. Throws what ended the reading early.
    ObjStatements take();

protected:
    int_type underflow() override;

private:
    void statement(std::string_view line);
    void vertex(std::string_view rest);
    void attribute(std::string_view rest, const char* keyword, int wanted, int passed);
    void color(const std::string_view* words);
    void face(std::string_view rest);
    void other(std::string_view keyword, std::string_view rest);
    void event(ObjStatement kind, std::int32_t value);
    std::int32_t name_index(std::string_view name);
    void refuse_decimal_comma(std::string_view word) const;

    LineReader reader_;
    Tally* tally_;
    ObjStatements found_;
    std::unordered_map<std::string, std::int32_t> name_numbers_;
    std::int64_t vertices_ = 0, uvs_ = 0, normals_ = 0;
    std::string out_;
    std::exception_ptr failure_;
};

}  // namespace tessera
