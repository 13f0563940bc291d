#pragma once
// A picture of all directions as texels on the sphere: which of them a direction falls between, and
// how much of the sphere each one stands for.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/lights/map_projection.h"

namespace tessera {

class MapSource {
public:
    struct Tap {
        std::size_t texel;
        double weight;
    };
    /// Four texels, weights summing to 1; some weights may be 0.
    using Taps = std::array<Tap, 4>;

    /// Rows from the top. Texels that are not finite become black. The picture must fit.
    MapSource(MapProjection projection, int width, int height, std::span<const Color> picture);
    /// Six square faces of this size, +x -x +y -y +z -z.
    MapSource(CubeFaces faces, int size, const std::array<std::span<const Color>, 6>& pictures);

    /// Bilinear, across edges into the adjoining face, over the poles of a lat-long map, and never
    /// off a disc. d is a unit vector.
    Taps taps(Vec3d d) const;
    /// Of texel i's middle.
    Vec3d direction(std::size_t i) const;
    /// All of them sum to 4 pi. A disc's texel counts whole if its middle lies within, else not.
    double solid_angle(std::size_t i) const { return solid_angles_[i]; }
    const std::vector<Color>& texels() const { return texels_; }
    /// Radiance times solid angle, summed over the sphere.
    Vec3d total() const;
    /// How many texels there are along a side of a square that covers the sphere.
    double resolution() const;

private:
    Taps cube_taps(Vec3d d) const;
    Taps latlong_taps(Vec3d d) const;
    Taps disc_taps(Vec3d d) const;
    std::size_t face_texel(int face, int x, int y) const;
    void weigh_cube();
    void weigh_flat();

    MapProjection projection_;
    bool cube_ = false;  // texels are face by face, however the picture held them
    CubeFaces faces_ = CubeFaces::observer;
    int width_ = 0, height_ = 0;  // of a face for a cube
    std::vector<Color> texels_;
    std::vector<double> solid_angles_;
};

}  // namespace tessera
