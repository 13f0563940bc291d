#pragma once
// The key by which lights, the surroundings and glowing materials join a light group.

#include "renderer/io/params.h"

namespace tessera {

/// Whether a word can be part of a layer's name: letters, digits and _, a letter first, at most 26.
bool is_group_name(const std::string& name);

template <class T>
Key light_group_key(std::string T::*member) {
    Key row = key("light_group", member,
                  "Lights of a group have their own passes and a label in light path expressions.");
    row.store = [inner = row.store, member](void* object, const Value& value, const Key& self,
                                            const ReadContext& at) {
        inner(object, value, self, at);
        std::string& group = static_cast<T*>(object)->*member;
        if (group.empty() || is_group_name(group)) return;
        report_misfit(value, "light_group",
                      "letters, digits and _, a letter first, at most 26 of them, not 'left' or "
                      "'right', nor 'default', which are the lights without a group",
                      at);
        group.clear();
    };
    return row;
}

}  // namespace tessera
