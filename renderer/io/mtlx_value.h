#pragma once
// Types and written values of MaterialX.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/io/mtlx_document.h"

namespace tessera {

enum class MtlxType : std::uint8_t {
    boolean,
    integer,
    scalar,
    color3,
    color4,
    vector2,
    vector3,
    vector4,
    string,
    filename,
    other,  // shaders, matrices, several outputs
};

MtlxType mtlx_type(std::string_view name);
std::string_view name_of(MtlxType type);
inline bool is_number(MtlxType t) { return t <= MtlxType::scalar; }
inline bool is_color(MtlxType t) { return t == MtlxType::color3 || t == MtlxType::color4; }
inline bool is_vector(MtlxType t) { return t >= MtlxType::vector2 && t <= MtlxType::vector4; }
inline bool has_fourth(MtlxType t) { return t == MtlxType::color4 || t == MtlxType::vector4; }
/// Components; 0 for what is none.
int width_of(MtlxType type);

/// What an input is given: something a node takes, or a text.
struct MtlxValue {
    enum class Kind : std::uint8_t { plain, surface_normal, surface_tangent };  // its own
    MtlxType type = MtlxType::scalar;
    NodeValue rgb = {};           // a number stands in all three places
    NodeValue fourth{{1, 1, 1}};  // of color4 and vector4
    Kind kind = Kind::plain;
    std::string text = {};                // of string and filename
    const MtlxElement* source = nullptr;  // the element that says so

    bool is_constant() const { return rgb.node < 0; }
};

/// The numbers of a text, "0.2, 0.5"; nothing when it holds anything else, or what is not finite.
std::optional<std::vector<float>> mtlx_numbers(std::string_view text);

/// The name that we know a colour space of MaterialX's by; "" for none.
std::string mtlx_color_space(const MtlxElement& element);

}  // namespace tessera
