#pragma once
// From a scene to the header of its film, and from a film file back to a film that goes on.

#include "renderer/film/film.h"
#include "renderer/film/film_header.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// What the film keeps beside its passes.
FilmExtras film_extras(const Scene& scene, const RenderSettings& settings);

/// Without samples and seconds.
FilmHeader film_header(const Scene& scene, const PixelWindow& window,
                       const RenderSettings& settings);

/// Reads settings.resume; seconds: that it took so far. Throws Error(scene) if it is no good or of
/// another picture, Error(usage) if it has other samples than are asked for.
Film resumed_film(const Scene& scene, const PixelWindow& window, const RenderSettings& settings,
                  double& seconds);

}  // namespace tessera
