#pragma once
// What a scene needs of the path kernel, as bits; and the few kernels that are compiled.

#include <array>
#include <string_view>

namespace tessera {

/// A structural type: a value of it is a template argument of the kernels.
struct Features {
    bool specular = false;      // lobes other than Lambert's
    bool layers = false;        // fuzz, coat, film, rough or translucent bodies
    bool transmission = false;  // light passes through surfaces
    bool textures = false;      // images are read while shading, normal maps included
    bool vertex_colors = false;
    bool quadrics = false;  // spheres or discs
    bool instances = false;
    bool lens = false;
    bool apart = false;  // specular lobes may see surroundings of their own

    constexpr bool operator==(const Features&) const = default;
    /// True if a kernel with these features can render a scene that needs `other`.
    constexpr bool covers(const Features& other) const {
        return (specular || !other.specular) && (layers || !other.layers) &&
               (transmission || !other.transmission) && (textures || !other.textures) &&
               (vertex_colors || !other.vertex_colors) && (quadrics || !other.quadrics) &&
               (instances || !other.instances) && (lens || !other.lens) && (apart || !other.apart);
    }
};

struct KernelRow {
    std::string_view name;
    Features features;
};

/// From the smallest up; the last covers everything.
inline constexpr Features kBasic{};
inline constexpr Features kSurface{
    .specular = true, .textures = true, .vertex_colors = true, .quadrics = true, .instances = true};
inline constexpr Features kFull{.specular = true,
                                .layers = true,
                                .transmission = true,
                                .textures = true,
                                .vertex_colors = true,
                                .quadrics = true,
                                .instances = true,
                                .lens = true,
                                .apart = true};
inline constexpr std::array<KernelRow, 3> kKernels{
    {{"basic", kBasic}, {"surface", kSurface}, {"full", kFull}}};

}  // namespace tessera
