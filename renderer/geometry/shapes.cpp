#include "renderer/geometry/shapes.h"

namespace tessera {
namespace {

template <class Vector>
std::size_t capacity_bytes(const Vector& v) {
    return v.capacity() * sizeof(typename Vector::value_type);
}

// Row sums of absolute values, the largest: the infinity norm.
double norm(const Affined& m) { return max_component(abs(m.x) + abs(m.y) + abs(m.z)); }

}  // namespace

void Placement::objects_are_at(const Affined& to_scene) {
    const Affined m = inverse(to_scene);
    to_object = Affinef(m);
    object_scale =
        static_cast<float>(std::sqrt(std::max({length2(m.x), length2(m.y), length2(m.z)})));
}

void Placement::instance_at(const Affined& m) {
    to_world = Affinef(m);
    instanced = true;
    condition = static_cast<float>(norm(m) * norm(inverse(m)));
}

void Mesh::lay_out(bool normals, bool uvs, bool colors) {
    stride = 3;
    const auto place = [&](bool wanted, std::uint32_t floats) {
        if (!wanted) return 0u;
        stride += floats;
        return stride - floats;
    };
    normal_at = place(normals, 3);
    uv_at = place(uvs, 2);
    color_at = place(colors, 3);
}

float* Mesh::add_vertex(Vec3f position) {
    vertices.resize(vertices.size() + stride);
    float* record = &vertices[vertices.size() - stride];
    record[0] = position.x, record[1] = position.y, record[2] = position.z;
    return record;
}

std::size_t Mesh::bytes() const noexcept {
    return capacity_bytes(vertices) + capacity_bytes(index) + capacity_bytes(face_material) +
           capacity_bytes(face_object);
}

}  // namespace tessera
