#pragma once
// Which event of a light path each kind of lobe is, for the passes.

#include <type_traits>

#include "materials/lobes/diffuse.h"
#include "materials/lobes/eon.h"
#include "materials/lobes/framed.h"
#include "materials/lobes/fuzz.h"
#include "materials/lobes/glass.h"
#include "materials/lobes/reflection.h"
#include "materials/lobes/subsurface.h"
#include "materials/thin_film.h"
#include "renderer/core/light_event.h"

namespace tessera {

/// Lobes that scatter light from everywhere to everywhere; the others mirror and refract.
template <class Model>
inline constexpr bool kMatte =
    std::is_same_v<Model, DiffuseLobe> || std::is_same_v<Model, EonLobe> ||
    std::is_same_v<Model, FuzzLobe> || std::is_same_v<Model, DiffuseTransmission> ||
    std::is_same_v<Model, SubsurfaceEntry>;

namespace lobe_events {

template <class Model>
inline constexpr bool kCoat = std::is_same_v<Model, Framed<RoughReflection<DielectricFresnel>>> ||
                              std::is_same_v<Model, Framed<SmoothReflection<DielectricFresnel>>>;
template <class Model>
inline constexpr bool kClear = std::is_same_v<Model, SmoothGlass<DielectricFresnel>> ||
                               std::is_same_v<Model, SmoothSheet<DielectricFresnel>> ||
                               std::is_same_v<Model, SmoothGlass<FilmFresnel>> ||
                               std::is_same_v<Model, SmoothSheet<FilmFresnel>>;
template <class Model>
inline constexpr bool kRoughClear = std::is_same_v<Model, RoughGlass<DielectricFresnel>> ||
                                    std::is_same_v<Model, RoughSheet<DielectricFresnel>> ||
                                    std::is_same_v<Model, RoughGlass<FilmFresnel>> ||
                                    std::is_same_v<Model, RoughSheet<FilmFresnel>>;
template <class Model>
inline constexpr bool kThrough = kClear<Model> || kRoughClear<Model>;

}  // namespace lobe_events

/// The event of light that a lobe of some kind sends back, or through the surface.
template <class Model>
constexpr LobeEvent event_of(bool through) {
    using namespace lobe_events;
    if constexpr (std::is_same_v<Model, FuzzLobe>) {
        return LobeEvent::sheen;
    } else if constexpr (std::is_same_v<Model, DiffuseTransmission> ||
                         std::is_same_v<Model, SubsurfaceEntry>) {
        return LobeEvent::sss;
    } else if constexpr (kMatte<Model>) {
        return LobeEvent::diffuse;
    } else if constexpr (kCoat<Model>) {
        return Model::kDelta ? LobeEvent::coat_mirror : LobeEvent::coat;
    } else if constexpr (kThrough<Model>) {
        if (through) return kClear<Model> ? LobeEvent::clear_transmission : LobeEvent::transmission;
        return kClear<Model> ? LobeEvent::mirror : LobeEvent::specular;
    } else {
        return Model::kDelta ? LobeEvent::mirror : LobeEvent::specular;
    }
}

/// A colour for every event.
struct EventColors {
    Color of[kLobeEvents]{};

    Color& operator[](LobeEvent e) { return of[static_cast<int>(e)]; }
    Color operator[](LobeEvent e) const { return of[static_cast<int>(e)]; }
};

/// Which of a point's lobes are meant.
enum class LobePart : std::uint8_t { all, specular, matte };

}  // namespace tessera
