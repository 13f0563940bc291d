#include "renderer/io/obj_mesh.h"

#include <algorithm>
#include <span>

#include "renderer/io/triangulate.h"

namespace tessera {
namespace {

// Faces of one size, in file order.
struct FaceList {
    std::vector<ObjCorner> corners;
    std::vector<std::uint32_t> material, object;
};

// Numbers handed out in order of first use. Keys are name indices from -1.
class Slots {
public:
    explicit Slots(std::size_t names) : slot_(names + 1, kNoIndex) {}

    std::uint32_t of(std::int32_t key) {
        std::uint32_t& slot = slot_[static_cast<std::size_t>(key) + 1];
        if (slot == kNoIndex) {
            slot = static_cast<std::uint32_t>(keys_.size());
            keys_.push_back(key);
        }
        return slot;
    }
    const std::vector<std::int32_t>& keys() const noexcept { return keys_; }

private:
    std::vector<std::uint32_t> slot_;
    std::vector<std::int32_t> keys_;
};

class MeshBuilder {
public:
    MeshBuilder(ObjNumbers numbers, ObjStatements statements)
        : numbers_(std::move(numbers)),
          statements_(std::move(statements)),
          materials_(statements_.names.size()),
          objects_(statements_.names.size()) {}

    ObjMesh build(const std::string& name);

private:
    void add_face(std::span<const ObjCorner> corners, std::uint32_t material, std::uint32_t object);
    Vec3d point(const ObjCorner& corner) const;
    void collect(std::span<const ObjCorner> corners);
    void take_names(const std::string& name);
    void take_arrays();

    ObjNumbers numbers_;
    ObjStatements statements_;
    Slots materials_, objects_;
    FaceList triangles_, quads_;
    Triangulator triangulator_;
    std::vector<ObjCorner> ring_;
    std::vector<Vec3d> points_;
    ObjMesh out_;
};

Vec3d MeshBuilder::point(const ObjCorner& corner) const {
    const double* p = numbers_.positions.data() + std::size_t(corner.position) * 3;
    return {p[0], p[1], p[2]};
}

// The outline without corners that repeat the one before.
void MeshBuilder::collect(std::span<const ObjCorner> corners) {
    ring_.clear();
    points_.clear();
    for (const ObjCorner& corner : corners) {
        const Vec3d p = point(corner);
        if (!points_.empty() && points_.back() == p) continue;
        ring_.push_back(corner);
        points_.push_back(p);
    }
    while (points_.size() > 1 && points_.back() == points_.front()) {
        ring_.pop_back();
        points_.pop_back();
    }
}

void MeshBuilder::add_face(std::span<const ObjCorner> corners, std::uint32_t material,
                           std::uint32_t object) {
    collect(corners);
    const auto add = [&](FaceList& list, const auto& numbers) {
        for (const auto i : numbers) list.corners.push_back(ring_[i]);
        list.material.push_back(material);
        list.object.push_back(object);
    };
    const std::size_t before = triangles_.material.size() + quads_.material.size();
    if (ring_.size() == 3) {
        if (!is_degenerate(points_[0], points_[1], points_[2]))
            add(triangles_, std::array<std::uint8_t, 3>{0, 1, 2});
    } else if (ring_.size() == 4) {
        const QuadShape shape = shape_quad(std::span<const Vec3d, 4>(points_));
        if (shape.is_quad) add(quads_, shape.quad);
        for (std::size_t i = 0; i < static_cast<std::size_t>(shape.triangles); ++i)
            add(triangles_, shape.triangle[i]);
    } else if (ring_.size() > 4) {
        for (const Triangulator::Triangle& triangle : triangulator_.run(points_))
            add(triangles_, triangle);
        out_.fanned += triangulator_.fell_back();
    }
    out_.degenerate += triangles_.material.size() + quads_.material.size() == before;
}

// Drops the values no index names. `partner` (may be empty) is parallel to values.
template <class T>
void keep_used(std::vector<T>& values, std::size_t width, std::vector<std::uint32_t>& index,
               std::vector<float>* partner = nullptr) {
    const std::size_t count = values.size() / width;
    std::vector<std::uint32_t> place(count, kNoIndex);
    for (const std::uint32_t i : index) place[i] = 0;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (place[i] == kNoIndex) continue;
        for (std::size_t k = 0; k < width; ++k) values[kept * width + k] = values[i * width + k];
        for (std::size_t k = 0; partner && k < 3; ++k)
            (*partner)[std::size_t(kept) * 3 + k] = (*partner)[i * 3 + k];
        place[i] = kept++;
    }
    if (kept == count) return;
    values.resize(std::size_t(kept) * width);
    values.shrink_to_fit();
    if (partner) partner->resize(std::size_t(kept) * 3);
    for (std::uint32_t& i : index) i = place[i];
}

// Unclear in the format: whole numbers above 1 can only be bytes; anything else is brought to [0,
// 1].
void tidy_colors(std::vector<float>& colors) {
    const auto all = [&](auto test) { return std::all_of(colors.begin(), colors.end(), test); };
    if (all([](float c) { return c == 1.0f; })) return colors.clear();
    const bool above = !all([](float c) { return c <= 1.0f; });
    const bool bytes =
        above && all([](float c) {
            return c >= 0 && c <= 255 && c == static_cast<float>(static_cast<int>(c));
        });
    for (float& c : colors) c = std::clamp(bytes ? c / 255.0f : c, 0.0f, 1.0f);
}

void MeshBuilder::take_arrays() {
    MeshDesc& mesh = out_.mesh;
    mesh.triangles = static_cast<std::uint32_t>(triangles_.material.size());
    mesh.quads = static_cast<std::uint32_t>(quads_.material.size());
    mesh.positions = std::move(numbers_.positions);
    mesh.normals = std::move(numbers_.normals);
    mesh.uvs = std::move(numbers_.uvs);
    mesh.colors = std::move(statements_.colors);

    const std::size_t corners = triangles_.corners.size() + quads_.corners.size();
    mesh.position_index.reserve(corners);
    bool any_uv = false;
    bool all_uv = true;
    for (const FaceList* list : {&triangles_, &quads_}) {
        for (const ObjCorner& corner : list->corners) {
            mesh.position_index.push_back(corner.position);
            any_uv |= corner.uv != kNoIndex;
            all_uv &= corner.uv != kNoIndex;
        }
    }
    if (any_uv && !all_uv) mesh.uvs.insert(mesh.uvs.end(), {0.0f, 0.0f});
    const auto last_uv = static_cast<std::uint32_t>(mesh.uvs.size() / 2 - 1);
    if (!any_uv) mesh.uvs.clear();
    mesh.uv_index.reserve(any_uv ? corners : 0);
    mesh.normal_index.reserve(mesh.normals.empty() ? 0 : corners);
    for (FaceList* list : {&triangles_, &quads_}) {
        for (const ObjCorner& corner : list->corners) {
            if (any_uv) mesh.uv_index.push_back(corner.uv == kNoIndex ? last_uv : corner.uv);
            if (!mesh.normals.empty()) mesh.normal_index.push_back(corner.normal);
        }
        list->corners = {};
    }
    if (!mesh.colors.empty()) mesh.colors.resize(mesh.positions.size(), 1.0f);
    keep_used(mesh.positions, 3, mesh.position_index, mesh.colors.empty() ? nullptr : &mesh.colors);
    keep_used(mesh.normals, 3, mesh.normal_index);
    keep_used(mesh.uvs, 2, mesh.uv_index);
    tidy_colors(mesh.colors);
    if (mesh.normal_index == mesh.position_index) mesh.normal_index = {};
    if (mesh.uv_index == mesh.position_index) mesh.uv_index = {};
}

void MeshBuilder::take_names(const std::string& name) {
    MeshDesc& mesh = out_.mesh;
    const auto join = [](FaceList& list, std::vector<std::uint32_t> FaceList::*of, auto& into) {
        into.insert(into.end(), (list.*of).begin(), (list.*of).end());
        list.*of = {};
    };
    for (FaceList* list : {&triangles_, &quads_}) {
        if (materials_.keys().size() > 1) join(*list, &FaceList::material, mesh.face_material);
        if (objects_.keys().size() > 1) join(*list, &FaceList::object, mesh.face_object);
    }
    for (const std::int32_t key : objects_.keys())
        mesh.object_names.push_back(key < 0 ? name
                                            : statements_.names[static_cast<std::size_t>(key)]);
}

ObjMesh MeshBuilder::build(const std::string& name) {
    StatementCursor cursor(statements_);
    std::size_t begin = 0;
    for (std::uint32_t face = 0; face < numbers_.face_end.size(); ++face) {
        const std::size_t end = numbers_.face_end[face];
        const ObjState& state = cursor.advance(face);
        if (end > begin) {
            const std::uint32_t material = materials_.of(state.material);
            if (material == out_.materials.size()) {
                const bool named = state.material >= 0;
                out_.materials.push_back(
                    {named ? statements_.names[static_cast<std::size_t>(state.material)] : "",
                     state.material_line});
            }
            add_face({numbers_.corners.data() + begin, end - begin}, material,
                     objects_.of(state.object >= 0 ? state.object : state.group));
        }
        begin = end;
    }
    numbers_.corners = {};
    numbers_.face_end = {};
    take_arrays();
    take_names(name);
    return std::move(out_);
}

}  // namespace

ObjMesh build_obj_mesh(ObjNumbers numbers, ObjStatements statements, const std::string& name) {
    return MeshBuilder(std::move(numbers), std::move(statements)).build(name);
}

}  // namespace tessera
