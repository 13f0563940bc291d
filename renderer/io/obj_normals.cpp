#include "renderer/io/obj_normals.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "renderer/io/triangulate.h"

namespace tessera {
namespace {

class NormalBuilder {
public:
    explicit NormalBuilder(ObjNumbers& numbers) : numbers_(&numbers) {}

    void normalise_given();
    bool has_own(std::size_t face) const;
    void add_flat(std::size_t face);
    void add_smooth(std::span<const std::uint32_t> faces);

private:
    std::span<ObjCorner> corners(std::size_t face) const;
    const std::vector<Vec3d>& points(std::size_t face);
    std::uint32_t push(Vec3d normal);

    ObjNumbers* numbers_;
    std::vector<bool> given_;  // per vn of the file: has a direction
    std::vector<Vec3d> points_;
    std::vector<std::uint32_t> slot_;  // per position: its sum in the group at hand, else kNoIndex
    std::vector<Vec3d> sums_;
};

std::span<ObjCorner> NormalBuilder::corners(std::size_t face) const {
    const std::size_t begin = face > 0 ? numbers_->face_end[face - 1] : 0;
    return {numbers_->corners.data() + begin, numbers_->face_end[face] - begin};
}

const std::vector<Vec3d>& NormalBuilder::points(std::size_t face) {
    points_.clear();
    for (const ObjCorner& corner : corners(face)) {
        const double* p = numbers_->positions.data() + std::size_t(corner.position) * 3;
        points_.emplace_back(p[0], p[1], p[2]);
    }
    return points_;
}

std::uint32_t NormalBuilder::push(Vec3d normal) {
    const double size = length(normal);
    // A face without area is dropped later; its normal only has to be a direction.
    const Vec3d unit = size > 0 ? normal / size : Vec3d(0, 0, 1);
    for (int i = 0; i < 3; ++i) numbers_->normals.push_back(static_cast<float>(unit[i]));
    return static_cast<std::uint32_t>(numbers_->normals.size() / 3 - 1);
}

void NormalBuilder::normalise_given() {
    std::vector<float>& n = numbers_->normals;
    given_.resize(n.size() / 3);
    for (std::size_t i = 0; i < given_.size(); ++i) {
        const Vec3d normal(Vec3f(n[3 * i], n[3 * i + 1], n[3 * i + 2]));
        const double size = length(normal);
        given_[i] = size > 0 && std::isfinite(size);
        for (int k = 0; k < 3; ++k)
            n[3 * i + k] = given_[i] ? static_cast<float>(normal[k] / size) : 0.0f;
    }
}

bool NormalBuilder::has_own(std::size_t face) const {
    const std::span<const ObjCorner> all = corners(face);
    return std::all_of(all.begin(), all.end(), [this](const ObjCorner& corner) {
        return corner.normal < given_.size() && given_[corner.normal];
    });
}

void NormalBuilder::add_flat(std::size_t face) {
    const std::uint32_t index = push(newell(points(face)));
    for (ObjCorner& corner : corners(face)) corner.normal = index;
}

void NormalBuilder::add_smooth(std::span<const std::uint32_t> faces) {
    slot_.resize(numbers_->positions.size() / 3, kNoIndex);
    sums_.clear();
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t face : faces) {
        const std::vector<Vec3d>& p = points(face);
        const Vec3d area = newell(p);
        const std::span<const ObjCorner> all = corners(face);
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3d to_next = p[i + 1 < p.size() ? i + 1 : 0] - p[i];
            const Vec3d to_previous = p[i > 0 ? i - 1 : p.size() - 1] - p[i];
            const double angle =
                std::atan2(length(cross(to_next, to_previous)), dot(to_next, to_previous));
            std::uint32_t& slot = slot_[all[i].position];
            if (slot == kNoIndex) {
                slot = static_cast<std::uint32_t>(sums_.size());
                sums_.emplace_back();
                touched.push_back(all[i].position);
            }
            sums_[slot] += area * angle;
        }
    }
    const auto first = static_cast<std::uint32_t>(numbers_->normals.size() / 3);
    for (const Vec3d& sum : sums_) push(sum);
    for (const std::uint32_t face : faces) {
        for (ObjCorner& corner : corners(face)) {
            // Opposite faces can cancel to nothing: such a corner takes its face's own normal.
            const std::uint32_t slot = slot_[corner.position];
            corner.normal = length2(sums_[slot]) > 0 ? first + slot : push(newell(points(face)));
        }
    }
    for (const std::uint32_t position : touched) slot_[position] = kNoIndex;
}

}  // namespace

void resolve_normals(ObjNumbers& numbers, const ObjStatements& statements) {
    struct Smooth {
        std::int32_t group;
        std::uint32_t face;
    };
    NormalBuilder builder(numbers);
    builder.normalise_given();
    StatementCursor cursor(statements);
    std::vector<Smooth> smooth;
    std::vector<std::uint32_t> flat;
    bool any_own = false;
    std::size_t begin = 0;
    for (std::uint32_t face = 0; face < numbers.face_end.size(); ++face) {
        const bool empty = numbers.face_end[face] == begin;
        begin = numbers.face_end[face];
        const std::int32_t group = cursor.advance(face).smoothing;
        if (empty) continue;
        if (builder.has_own(face)) {
            any_own = true;
        } else if (group > 0) {
            smooth.push_back({group, face});
        } else {
            flat.push_back(face);
        }
    }
    if (!any_own && smooth.empty()) {
        numbers.normals.clear();
        for (ObjCorner& corner : numbers.corners) corner.normal = kNoIndex;
        return;
    }
    const auto by_group = [](const Smooth& a, const Smooth& b) { return a.group < b.group; };
    if (!std::is_sorted(smooth.begin(), smooth.end(), by_group))
        std::stable_sort(smooth.begin(), smooth.end(), by_group);
    std::vector<std::uint32_t> faces;
    for (std::size_t i = 0; i < smooth.size(); ++i) {
        faces.push_back(smooth[i].face);
        if (i + 1 < smooth.size() && smooth[i + 1].group == smooth[i].group) continue;
        builder.add_smooth(faces);
        faces.clear();
    }
    for (const std::uint32_t face : flat) builder.add_flat(face);
}

}  // namespace tessera
