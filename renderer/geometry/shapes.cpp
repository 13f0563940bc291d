#include "renderer/geometry/shapes.h"

namespace tessera {
namespace {

template <class T>
std::size_t capacity_bytes(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

// Row sums of absolute values, the largest: the infinity norm.
double norm(const Affined& m) { return max_component(abs(m.x) + abs(m.y) + abs(m.z)); }

}  // namespace

void Placement::instance_at(const Affined& m) {
    to_world = Affinef(m);
    instanced = true;
    condition = static_cast<float>(norm(m) * norm(inverse(m)));
}

std::size_t Mesh::bytes() const noexcept {
    return capacity_bytes(positions) + capacity_bytes(normals) + capacity_bytes(uvs) +
           capacity_bytes(colors) + capacity_bytes(position_index) + capacity_bytes(normal_index) +
           capacity_bytes(uv_index) + capacity_bytes(face_material) + capacity_bytes(face_object);
}

}  // namespace tessera
