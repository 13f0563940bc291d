#include "renderer/io/obj_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tessera {
namespace {

constexpr double kFarthest = 1e15;

template <class T>
std::vector<bool> usable(const std::vector<T>& values, std::size_t width, double limit) {
    std::vector<bool> out(values.size() / width);
    for (std::size_t i = 0; i < out.size(); ++i) {
        bool good = true;
        for (std::size_t k = 0; k < width; ++k)
            good = good && std::abs(static_cast<double>(values[i * width + k])) <= limit;
        out[i] = good;
    }
    return out;
}

std::string place_of(std::uint32_t vertex, const std::vector<ObjBadVertex>& bad) {
    const auto at = std::lower_bound(
        bad.begin(), bad.end(), vertex,
        [](const ObjBadVertex& entry, std::uint32_t wanted) { return entry.vertex < wanted; });
    const std::string name = "vertex " + std::to_string(vertex + 1);
    if (at == bad.end() || at->vertex != vertex) return name;
    return name + " in line " + std::to_string(at->line);
}

bool holds(const std::vector<bool>& flags, std::uint32_t index) {
    return index < flags.size() && flags[index];
}

}  // namespace

void check_faces(ObjNumbers& numbers, const ObjStatements& statements, Tally& tally) {
    const std::vector<bool> positions = usable(numbers.positions, 3, kFarthest);
    const std::vector<bool> uvs = usable(numbers.uvs, 2, kFarthest);
    const std::vector<bool> normals = usable(numbers.normals, 3, kFarthest);
    std::size_t read = 0;
    std::size_t written = 0;
    for (std::size_t face = 0; face < numbers.face_end.size(); ++face) {
        const std::size_t begin = written;
        const std::uint32_t line = statements.face_lines[face];
        bool past_end = false;
        std::uint32_t unusable = kNoIndex;
        bool attribute_past_end = false;
        for (const std::size_t end = numbers.face_end[face]; read < end; ++read) {
            ObjCorner corner = numbers.corners[read];
            past_end |= corner.position >= positions.size();
            if (!holds(positions, corner.position)) unusable = corner.position;
            attribute_past_end |= corner.uv != kNoIndex && corner.uv >= uvs.size();
            attribute_past_end |= corner.normal != kNoIndex && corner.normal >= normals.size();
            if (!holds(uvs, corner.uv)) corner.uv = kNoIndex;
            if (!holds(normals, corner.normal)) corner.normal = kNoIndex;
            numbers.corners[written++] = corner;
        }
        if (past_end)
            tally.damage("broken face: it uses a vertex that is not in the file", line);
        else if (unusable != kNoIndex)
            tally.damage("broken face: its vertex is not three finite numbers below 1e15:", line,
                         place_of(unusable, statements.bad_vertices));
        else if (attribute_past_end)
            tally.add("face names a vt or vn that is not there; it is ignored", line);
        if (unusable != kNoIndex) written = begin;
        numbers.face_end[face] = written;
    }
    numbers.corners.resize(written);
}

const ObjState& StatementCursor::advance(std::uint32_t face) {
    const std::vector<ObjEvent>& events = statements_->events;
    for (; at_ < events.size() && events[at_].face <= face; ++at_) {
        const ObjEvent& event = events[at_];
        const auto name = [&] {
            return statements_->names[static_cast<std::size_t>(event.value)].empty() ? -1
                                                                                     : event.value;
        };
        switch (event.kind) {
            case ObjStatement::object:
                state_.object = name();
                break;
            case ObjStatement::group:
                state_.group = name();
                break;
            case ObjStatement::smoothing:
                state_.smoothing = event.value;
                break;
            case ObjStatement::material:
                state_.material = event.value;
                state_.material_line = event.line;
                break;
        }
    }
    return state_;
}

}  // namespace tessera
