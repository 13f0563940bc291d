#include "renderer/io/obj_checks.h"

#include <cmath>

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

bool holds(const std::vector<bool>& flags, std::uint32_t index) {
    return index < flags.size() && flags[index];
}

}  // namespace

void check_faces(ObjNumbers& numbers, const std::vector<std::uint32_t>& face_lines, Tally& tally) {
    const std::vector<bool> positions = usable(numbers.positions, 3, kFarthest);
    const std::vector<bool> uvs = usable(numbers.uvs, 2, kFarthest);
    const std::vector<bool> normals = usable(numbers.normals, 3, kFarthest);
    std::size_t read = 0;
    std::size_t written = 0;
    for (std::size_t face = 0; face < numbers.face_end.size(); ++face) {
        const std::size_t begin = written;
        bool past_end = false;
        bool not_finite = false;
        bool attribute_past_end = false;
        for (const std::size_t end = numbers.face_end[face]; read < end; ++read) {
            ObjCorner corner = numbers.corners[read];
            past_end |= corner.position >= positions.size();
            not_finite |= !holds(positions, corner.position);
            attribute_past_end |= corner.uv != kNoIndex && corner.uv >= uvs.size();
            attribute_past_end |= corner.normal != kNoIndex && corner.normal >= normals.size();
            if (!holds(uvs, corner.uv)) corner.uv = kNoIndex;
            if (!holds(normals, corner.normal)) corner.normal = kNoIndex;
            numbers.corners[written++] = corner;
        }
        if (past_end || not_finite) {
            tally.add(past_end ? "face dropped: it uses a vertex that is not in the file"
                               : "face dropped: it uses a vertex that is not finite or beyond 1e15",
                      face_lines[face]);
            written = begin;
        } else if (attribute_past_end) {
            tally.add("face names a vt or vn that is not there; it is ignored", face_lines[face]);
        }
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
