#pragma once
// Which paths make the error: the variance of pixels that are chosen in proportion to their error,
// split by kind of path, light and materials.

#include <array>
#include <string_view>
#include <vector>

#include "renderer/api/picture_error.h"
#include "renderer/api/render.h"
#include "renderer/film/film.h"
#include "renderer/scene/scene.h"

namespace tessera {

class Workers;

/// Kinds of paths: every path is of one.
struct PathKind {
    std::string_view name, expression, remedy;
};
inline constexpr std::array<PathKind, 7> kPathKinds{{
    {"light seen directly", "C[LOB]", "more samples a pixel; it is the edge of something bright"},
    {"light seen in mirrors or through clear glass", "CS+[LOB]",
     "more samples a pixel; it is the edge of something bright"},
    {"gloss", "C[GS]*G[GS]*[LOB]", "more samples; a larger light or a rougher surface"},
    {"direct light", "C[GS]*D[LOB]", "more samples; fewer or larger lights"},
    {"indirect light", "C[GSD]*D[GS]*D[LOB]", "more samples; a lower max_depth leaves some out"},
    {"caustic", "C[GSD]*D[GS]+[LOB]",
     "path tracing finds caustics by chance: a larger light or a rougher surface is found sooner"},
    {"light scattered in volumes", "C.*V.*[LOB]", "more samples; a thinner medium"},
}};

/// film: with replicates, of whole passes. At most about 3 % of the samples that it has are traced
/// again. Empty if nothing is wrong, or for another integrator than "path".
std::vector<ErrorCause> find_causes(const Scene& scene, const Film& film, int first_sample,
                                    Workers& workers);

}  // namespace tessera
