#include "renderer/scene/name_ids.h"

#include <algorithm>

namespace tessera {

bool wants_name_ids(const FilmDesc& film) {
    return std::any_of(film.aovs.begin(), film.aovs.end(),
                       [](const std::string& pass) { return pass.starts_with("Crypto"); });
}

std::size_t NameIds::bytes() const noexcept {
    std::size_t sum = placements_.capacity() * sizeof(Placed) +
                      (objects_.capacity() + materials_.capacity()) * sizeof(std::uint32_t);
    for (const NameList& list : lists_) {
        sum += list.ids.capacity() * sizeof(std::uint32_t);
        for (const std::string& name : list.names) sum += sizeof name + name.capacity();
    }
    return sum;
}

}  // namespace tessera
