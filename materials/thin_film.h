#pragma once
// Interference in a film of less than some micrometres on a boundary. Belcour & Barla, "A Practical
// Extension to Microfacet Theory for the Modeling of Varying Iridescence", SIGGRAPH 2017: Airy's
// sum, integrated over the eye's sensitivities in Fourier space.

#include "materials/fresnel.h"
#include "materials/lobe.h"

namespace tessera {

/// Reflectance of a boundary that a film lies on.
struct FilmFresnel {
    float eta = 1.5f;        // of what lies below over outside, if that is a dielectric
    float film_eta = 1.4f;   // of the film over outside
    float thickness = 0.5f;  // micrometres
    float weight = 1;        // 0: as if there were no film
    float metal = 0;         // 1: below lies a metal, with the colours f0 and f82
    Color f0{1.0f}, f82{1.0f};

    struct Lanes {
        float eta[kLanes], film_eta[kLanes], thickness[kLanes], weight[kLanes], metal[kLanes];
        Vec3Lanes f0, f82;
        void set(int i, const FilmFresnel& f) {
            eta[i] = f.eta, film_eta[i] = f.film_eta, thickness[i] = f.thickness;
            weight[i] = f.weight, metal[i] = f.metal;
            f0.set(i, f.f0), f82.set(i, f.f82);
        }
        FilmFresnel get(int i) const {
            return {eta[i], film_eta[i], thickness[i], weight[i], metal[i], f0[i], f82[i]};
        }
    };

    Color operator()(float cos_i) const;
    /// The boundary without its film.
    Color bare(float cos_i) const {
        return metal > 0.0f ? fresnel_f82(f0, f82, cos_i) : Color(fresnel_dielectric(cos_i, eta));
    }
};

}  // namespace tessera
