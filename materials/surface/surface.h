#pragma once
// A surface's parameters with what follows from them whatever they are seen from: what a material
// that does not vary computes once.

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "materials/energy.h"
#include "materials/ggx.h"
#include "materials/surface/params.h"
#include "materials/thin_film.h"

namespace tessera {

/// Roughness to the two GGX alphas. OpenPBR 1.1, "Microfacet model".
Ggx openpbr_ggx(float roughness, float anisotropy);

/// Energy of rough boundaries along the viewing cosine; those that are there replace the tables.
struct SurfaceCurves {
    std::optional<AlbedoCurve> boundary, metal, coat, glass_outside, glass_inside;
};

using CurveKey = std::array<float, 11>;
/// Surfaces that differ in colour only share theirs: a model may have thousands.
using CurveCache = std::map<CurveKey, std::shared_ptr<const SurfaceCurves>>;

struct Surface {
    SurfaceParams p;
    Ggx ggx;  // of the base; a rough coat blurs what lies below it
    Ggx coat_ggx;
    float ior = 1;              // specular_weight included
    float boundary_eta = 1;     // of the opaque base's boundary, always entered from outside: >= 1
    float coat_reflection = 0;  // internal diffuse reflectance of the coat: the base's darkening
    float coat_spread = 0;      // 0: the base mirrors light back into the coat, 1: scatters it
    float coat_way = 1;         // mean of 1 / cosine inside the coat of light from all around
    Color below_coat{0.0f};     // albedo of what lies below the coat at normal incidence
    float film_outside = 1;     // index of what lies on a thin film
    FilmFresnel boundary_film;  // of the opaque base, if a film is on it
    // Reflectance at the Fresnel nodes of the opaque base's rough boundary, if a film is on it.
    std::array<Color, kFresnelNodes> film_nodes;
    const SurfaceCurves* curves = nullptr;

    explicit Surface(const SurfaceParams& params);

    /// The curves that lobes of this surface can ask for.
    SurfaceCurves make_curves() const;
    /// All that they depend on.
    CurveKey curve_key() const;

    float boundary_albedo(float cos_o) const {
        if (curves && curves->boundary) return (*curves->boundary)(cos_o);
        return varied_boundary_albedo(cos_o);
    }
    /// The thin film on a boundary of relative index eta, under something of index `outside`.
    FilmFresnel film_on(float eta, float outside) const;
    /// Share of light that the opaque base's boundary sends back with its film.
    Color film_albedo(float cos_o) const;
    float metal_albedo(float cos_o) const;
    float coat_albedo(float cos_o) const;
    /// What comes out through coat and fuzz of light that the base sends by itself.
    Color covering(float cos_o, bool front) const;
    /// eta: beyond over here.
    float glass_albedo_for(float cos_o, float eta) const;

private:
    void lay_film();
    void look_below_coat();
    float varied_boundary_albedo(float cos_o) const;
};

/// A boundary is looked through undisturbed where the two indices agree; the half vector is
/// undefined there.
inline constexpr float kSameIndex = 1e-4f;

inline bool is_smooth(const Ggx& ggx) { return std::max(ggx.ax, ggx.ay) < kMinAlpha; }
inline float mean_alpha(const Ggx& ggx) { return std::sqrt(ggx.ax * ggx.ay); }
/// The energy tables are of round highlights. What a stretched one loses depends on where it is
/// seen from: none of it is given back, so that no direction gets more than it lost.
inline bool is_stretched(const Ggx& ggx) { return ggx.ax != ggx.ay; }

}  // namespace tessera
