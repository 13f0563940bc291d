#include "renderer/geometry/shapes.h"

namespace tessera {
namespace {

template <class T>
std::size_t capacity_bytes(const std::vector<T>& v) { return v.capacity() * sizeof(T); }

}  // namespace

std::size_t Mesh::bytes() const noexcept {
    return capacity_bytes(positions) + capacity_bytes(normals) + capacity_bytes(uvs) + capacity_bytes(colors) +
           capacity_bytes(position_index) + capacity_bytes(normal_index) + capacity_bytes(uv_index) +
           capacity_bytes(face_material) + capacity_bytes(face_object);
}

}  // namespace tessera
