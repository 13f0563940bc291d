#pragma once
// Samples to layers. Tiles own disjoint pixels and write straight into the film: no locks, no
// merging.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/core/vec.h"

namespace tessera {

/// What one camera path gives to its pixel.
struct PathSample {
    Color radiance{0.0f};
    float alpha = 0;   // 1 where the camera ray hit something
    bool hit = false;  // the fields below are there; only with alpha 1
    float z = 0;       // camera-space depth
    Vec3f p;           // world position
    Vec3f n{};         // shading normal facing the camera
    Color albedo{0.0f};
};

/// Passes beyond beauty.
struct FilmLayers {
    bool z = false, n = false, p = false, albedo = false;
    bool any() const { return z || n || p || albedo; }
};

/// The names that --aov and film.aovs take. False for an unknown one.
bool enable_layer(const std::string& name, FilmLayers& layers);
std::vector<std::string> layer_names();

class Film {
public:
    static constexpr float kEmptyDepth = 1e10f;

    Film(const PixelWindow& window, const FilmLayers& layers);

    const PixelWindow& window() const noexcept { return window_; }
    /// x, y absolute in the frame, within the window. One thread at a time per pixel; samples in
    /// index order.
    void add(int x, int y, const PathSample& s) noexcept;
    /// Means of what was added.
    std::vector<Layer> layers() const { return layers(window_); }
    /// The same of a part of the window; other threads may add outside it.
    std::vector<Layer> layers(const PixelWindow& part) const;
    std::size_t bytes() const noexcept;

private:
    // Sums in double: a million samples lose nothing.
    struct Beauty {
        double r = 0, g = 0, b = 0, a = 0;
        std::uint32_t samples = 0;
    };
    struct Triple {
        double x = 0, y = 0, z = 0;
        void add(Vec3f v) {
            x += static_cast<double>(v.x), y += static_cast<double>(v.y),
                z += static_cast<double>(v.z);
        }
    };
    PixelWindow window_;
    FilmLayers enabled_;
    std::vector<Beauty> beauty_;
    std::vector<Triple> albedo_, normal_;
    std::vector<float> depth_;     // of the nearest sample: depth does not average
    std::vector<Vec3f> position_;  // of the same sample
};

}  // namespace tessera
