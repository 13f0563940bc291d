#include "renderer/scene/name_ids.h"

#include <algorithm>

#include "renderer/api/node_table.h"

namespace tessera {

bool wants_name_ids(const Passes& passes) {
    return std::any_of(passes.begin(), passes.end(), [](const Pass& pass) {
        switch (pass.source) {
            case PassSource::object_id:
            case PassSource::material_id:
            case PassSource::crypto_object:
            case PassSource::crypto_material:
            case PassSource::crypto_asset:
                return true;
            default:
                return false;
        }
    });
}

bool wants_name_ids(const MaterialDesc& material) {
    return std::any_of(material.nodes.begin(), material.nodes.end(), [](const NodeDesc& node) {
        const NodeOp op = kNodes[static_cast<std::size_t>(node.type)].op;
        return op == NodeOp::random || op == NodeOp::named;
    });
}

std::size_t NameIds::bytes() const noexcept {
    std::size_t sum = placements_.capacity() * sizeof(Placed) +
                      (objects_.capacity() + materials_.capacity()) * sizeof(std::uint32_t);
    for (const NameList& list : lists_) {
        sum += list.ids.capacity() * sizeof(std::uint32_t);
        for (const std::string& name : list.names) sum += sizeof(std::string) + name.capacity();
    }
    return sum;
}

}  // namespace tessera
