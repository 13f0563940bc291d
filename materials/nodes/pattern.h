#pragma once
// Ready patterns: a point and its footprint in, colour and relief out.
//
// `width` is the side of the footprint in the units of p; 0 takes the point alone. NaN in p counts
// as 0, coordinates beyond +-2^30 as +-2^30; numbers outside a stated range are clamped to it, NaN
// to its lower end. Colours pass through as given. Heights are in [0, 1].

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

/// MaterialX checkerboard: color2 where the cell's indices have an even sum.
struct CheckerParams {
    Color color1{1.0f}, color2{0.0f};
    Vec2f uvtiling{8.0f, 8.0f};  // cells per unit
    Vec2f uvoffset{0.0f, 0.0f};  // in cells
};
Color checkerboard(Vec2f uv, const CheckerParams& c, float width) noexcept;

/// Running bond, in the units of p (metres by default).
struct BrickParams {
    Vec2f size{0.215f, 0.065f};  // of a brick without mortar, 1e-6 to 1e6
    float mortar_width = 0.01f;  // 0 to 1e6
    float row_offset = 0.5f;     // shift of every other row, in bricks
    float rounding = 0.012f;     // width of the bevel, 0 to 1e6
    float variation = 0.7f;      // between bricks: 0 all alike, 1 from color1 to color2
    float irregularity = 0.3f;   // waviness of the edges, as a share of the mortar, 0 to 1
    float grain = 0.4f;          // speckles and pits, 0 to 1
    Color color1{0.30f, 0.085f, 0.05f}, color2{0.52f, 0.21f, 0.115f};
    Color mortar{0.46f, 0.43f, 0.39f};
};
struct Brick {
    Color color;
    float height = 0.0f;   // 0 in the mortar, 1 on a brick
    float mortar = 0.0f;   // share of mortar
    std::uint32_t id = 0;  // of the brick at the point; not filtered
};
Brick brick(Vec2f p, const BrickParams& b, float width) noexcept;

/// Growth rings about the z axis. Everything scales with ring_width.
struct WoodParams {
    float ring_width = 0.02f;     // 1e-6 to 1e6
    float latewood = 0.45f;       // dark share of a ring, 0.05 to 0.9
    float distortion = 1.0f;      // how far rings stray from circles, 0 to 8
    float ring_variation = 0.6f;  // of the rings' widths, 0 to 1
    float grain = 0.5f;           // fibres and pores along the axis, 0 to 1
    float rays = 0.3f;            // flecks of the rays that run outward, 0 to 1
    Color earlywood{0.50f, 0.29f, 0.135f}, latewood_color{0.235f, 0.105f, 0.04f};
};
struct Wood {
    Color color;
    float height = 0.5f;
    float roughness = 0.0f;  // to be added to the surface's own, within +-0.15
    float ring = 0.0f;       // 0 earlywood, 1 latewood
};
Wood wood(Vec3f p, const WoodParams& w, float width) noexcept;

struct MarbleParams {
    float frequency = 2.0f;   // veins per unit, about; 1e-6 to 1e6
    float turbulence = 1.0f;  // how much veins meander, 0 to 8
    float sharpness = 0.5f;   // 0 soft clouds, 1 hair lines
    float veins = 0.8f;       // how strongly veins colour the stone, 0 to 1
    Color base{0.83f, 0.81f, 0.78f}, cloud{0.60f, 0.60f, 0.60f}, vein{0.13f, 0.14f, 0.16f};
};
struct Marble {
    Color color;
    float vein = 0.0f;  // 0 stone, 1 vein
};
Marble marble(Vec3f p, const MarbleParams& m, float width) noexcept;

/// A weave: the warp runs along v, the weft along u. In row j the warp lies on top at thread i
/// where (i + j step) mod (over + under) < over. Plain 1, 1, 1; twill 2, 2, 1; satin 4, 1, 2.
struct ClothParams {
    Vec2f threads{40.0f, 40.0f};  // warp threads per unit of u, weft threads per unit of v
    int over = 1, under = 1;      // 1 to 8
    int step = 1;
    float thread_width = 0.85f;  // share of the pitch, 0.05 to 1; the rest is gap
    float relief = 0.5f;         // thickness of the threads over their width, 0 to 2
    float variation = 0.15f;     // of brightness from thread to thread, 0 to 1
    float fibres = 0.3f;         // visible twist of the yarn, 0 to 1
    Color warp{0.11f, 0.16f, 0.32f}, weft{0.55f, 0.55f, 0.53f};
};
struct Cloth {
    Color color;              // of the thread, not darkened by gaps
    float coverage = 0.0f;    // share that is thread, not gap
    float warp_share = 0.0f;  // of the threads seen, how much is warp
    float height = 0.0f;
    Vec3f normal{0.0f, 0.0f, 1.0f};  // unit, in the tangent frame of u and v
    Vec2f direction{0.0f, 1.0f};     // unit, along the thread at the point; not filtered
    bool is_warp = true;             // that thread
};
Cloth cloth(Vec2f p, const ClothParams& c, float width) noexcept;

struct RustParams {
    float spread = 0.4f;     // share of the surface that is rusted, 0 none to 1 all
    float frequency = 3.0f;  // patches per unit, about; 1e-6 to 1e6
    float detail = 0.6f;     // how ragged: diminish of the octaves, 0 to 0.9
    float softness = 0.15f;  // of the patches' edges, 0 to 1
    Color dark{0.055f, 0.018f, 0.009f}, bright{0.42f, 0.13f, 0.025f};
};
struct Rust {
    float mask = 0.0f;  // 0 clean, 1 rust
    Color color;        // of the rust alone
    float height = 0.0f;
    float roughness = 0.9f;
    float metalness = 0.0f;  // rust is a dielectric
};
Rust rust(Vec3f p, const RustParams& r, float width) noexcept;

}  // namespace tessera
