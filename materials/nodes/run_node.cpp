// Nodes that need nothing but their inputs.

#include <algorithm>
#include <cmath>

#include "materials/graph.h"
#include "materials/lobe.h"
#include "materials/nodes/blend.h"
#include "materials/nodes/color_math.h"
#include "materials/nodes/flakes.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

template <class Function>
Vec3f each(Vec3f a, Function f) {
    return {f(a.x), f(a.y), f(a.z)};
}
template <class Function>
Vec3f each(Vec3f a, Vec3f b, Function f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

float most(Vec3f a) { return max_component(abs(a)); }
Vec2f two(Vec3f v) { return {v.x, v.y}; }
NodeResult number(float x) { return {Vec3f(x), 0.0f, {}}; }

// A turn of a place; its footprint keeps its size.
NodeResult turned(const NodeResult& in, float degrees) {
    const double a = static_cast<double>(degrees) * 3.14159265358979 / 180;
    const auto c = static_cast<float>(std::cos(a)), s = static_cast<float>(std::sin(a));
    return {{c * in.v.x - s * in.v.y, s * in.v.x + c * in.v.y, 0.0f}, in.width, {}};
}

int whole(float x, int low, int high) {
    return static_cast<int>(
        std::clamp(std::isfinite(x) ? x : 0.0f, static_cast<float>(low), static_cast<float>(high)));
}

// Share of a footprint about x that lies at an edge or above.
float beyond(float x, float edge, float width) {
    return width > 0.0f ? clamp01((x - edge) / width + 0.5f) : (x < edge ? 0.0f : 1.0f);
}

NodeResult arithmetic(NodeOp op, const NodeResult* in) {
    const Vec3f a = in[0].v, b = in[1].v;
    const auto plain = [](Vec3f v) { return NodeResult{v, 0.0f, {}}; };
    switch (op) {
        case NodeOp::constant:
            return in[0];
        case NodeOp::add:
            return {a + b, std::max(in[0].width, in[1].width), {}};
        case NodeOp::subtract:
            return {a - b, std::max(in[0].width, in[1].width), {}};
        case NodeOp::multiply:
            return {a * b, std::max(in[0].width * most(b), in[1].width * most(a)), {}};
        case NodeOp::divide: {
            const Vec3f v = each(a, b, [](float x, float y) { return y != 0.0f ? x / y : 0.0f; });
            const float least = min_component(abs(b));
            return {v, least > 0.0f ? in[0].width / least : 0.0f, {}};
        }
        case NodeOp::modulo: {
            const auto f = [](float x, float y) {
                return y != 0.0f ? x - y * std::floor(x / y) : 0.0f;
            };
            return {each(a, b, f), in[0].width, {}};
        }
        case NodeOp::absval:
            return {abs(a), in[0].width, {}};
        case NodeOp::sign:
            return plain(
                each(a, [](float x) { return x > 0.0f ? 1.0f : (x < 0.0f ? -1.0f : 0.0f); }));
        case NodeOp::floor:
            return plain(each(a, [](float x) { return std::floor(x); }));
        case NodeOp::ceil:
            return plain(each(a, [](float x) { return std::ceil(x); }));
        case NodeOp::round:
            return plain(each(a, [](float x) { return std::round(x); }));
        case NodeOp::power:
            return plain(
                each(a, b, [](float x, float y) { return x < 0.0f ? 0.0f : std::pow(x, y); }));
        case NodeOp::sin:
            return plain(each(a, [](float x) { return std::sin(x); }));
        case NodeOp::cos:
            return plain(each(a, [](float x) { return std::cos(x); }));
        case NodeOp::asin:
            return plain(each(a, [](float x) { return std::asin(std::clamp(x, -1.0f, 1.0f)); }));
        case NodeOp::acos:
            return plain(each(a, [](float x) { return std::acos(std::clamp(x, -1.0f, 1.0f)); }));
        case NodeOp::atan2:
            return plain(each(a, b, [](float y, float x) { return std::atan2(y, x); }));
        case NodeOp::sqrt:
            return plain(each(a, [](float x) { return safe_sqrt(x); }));
        case NodeOp::ln:
            return plain(each(a, [](float x) { return std::log(std::max(x, 1e-30f)); }));
        case NodeOp::exp:
            return plain(each(a, [](float x) { return std::exp(x); }));
        case NodeOp::clamp:
            return plain(min(max(a, b), in[2].v));
        case NodeOp::min:
            return plain(min(a, b));
        case NodeOp::max:
            return plain(max(a, b));
        case NodeOp::invert:
            return plain(b - a);
        case NodeOp::normalize:
            return plain(length2(a) > 0.0f ? tessera::normalize(a) : Vec3f(0.0f));
        case NodeOp::magnitude:
            return number(length(a));
        case NodeOp::dotproduct:
            return number(dot(a, b));
        case NodeOp::crossproduct:
            return plain(cross(a, b));
        case NodeOp::mix:
            return plain(lerp(in[1].v, in[0].v, clamp01(in[2].v.x)));
        case NodeOp::remap: {
            const auto unit = [](float x, float y) { return y != 0.0f ? x / y : 0.0f; };
            return plain(in[3].v + each(a - b, in[2].v - b, unit) * (in[4].v - in[3].v));
        }
        case NodeOp::smoothstep: {
            const auto t = each(a - b, in[2].v - b, [](float x, float y) {
                const float u = y != 0.0f ? clamp01(x / y) : (x < 0.0f ? 0.0f : 1.0f);
                return u * u * (3.0f - 2.0f * u);
            });
            return plain(t);
        }
        case NodeOp::ramplr:
            return plain(lerp(a, b, clamp01(in[2].v.x)));
        case NodeOp::ramptb:
            return plain(lerp(b, a, clamp01(in[2].v.y)));
        case NodeOp::splitlr:
            return plain(lerp(a, b, beyond(in[3].v.x, in[2].v.x, in[3].width)));
        case NodeOp::splittb:
            return plain(lerp(b, a, beyond(in[3].v.y, in[2].v.x, in[3].width)));
        case NodeOp::combine3:
            return plain({a.x, b.x, in[2].v.x});
        case NodeOp::extract:
            return number(a[whole(b.x, 0, 2)]);
        case NodeOp::ifgreater:
            return a.x > b.x ? in[2] : in[3];
        case NodeOp::switch_:
            return in[1 + whole(a.x, 0, 9)];
        case NodeOp::rotate2d:
            return turned(in[0], b.x);
        case NodeOp::rotate3d: {
            // Rodrigues' formula, 1840.
            const float l2 = length2(in[2].v), turn = b.x * (kPi / 180.0f);
            if (!(l2 > 0.0f)) return in[0];
            const Vec3f axis = in[2].v * (1.0f / std::sqrt(l2));
            const float c = std::cos(turn), s = std::sin(turn);
            return {a * c + cross(axis, a) * s + axis * (dot(axis, a) * (1.0f - c)), 0.0f, {}};
        }
        case NodeOp::place2d: {
            NodeResult p = in[0];
            const Vec3f pivot = b, scale = in[2].v, offset = in[4].v;
            const auto over = [](float x, float s) { return s != 0.0f ? x / s : 0.0f; };
            p.v = {over(p.v.x - pivot.x, scale.x), over(p.v.y - pivot.y, scale.y), 0.0f};
            const float least = std::min(std::fabs(scale.x), std::fabs(scale.y));
            p.width = least > 0.0f ? p.width / least : 0.0f;
            p = turned(p, in[3].v.x);
            p.v = {p.v.x - offset.x + pivot.x, p.v.y - offset.y + pivot.y, 0.0f};
            return p;
        }
        default:
            return {};
    }
}

NodeResult color_node(NodeOp op, const NodeResult* in) {
    const Color c = in[0].v;
    const auto plain = [](Vec3f v) { return NodeResult{v, 0.0f, {}}; };
    switch (op) {
        case NodeOp::luminance:
            return number(luminance(c));
        case NodeOp::contrast:
            return plain((c - in[2].v) * in[1].v + in[2].v);
        case NodeOp::saturate:
            return plain(lerp(Color(luminance(c)), c, in[1].v.x));
        case NodeOp::rgbtohsv:
            return plain(rgb_to_hsv(c));
        case NodeOp::hsvtorgb:
            return plain(hsv_to_rgb(c));
        case NodeOp::hsvadjust: {
            const Vec3f h = rgb_to_hsv(c), by = in[1].v;
            return plain(hsv_to_rgb({h.x + by.x, h.y * by.y, h.z * by.z}));
        }
        case NodeOp::blackbody:
            return plain(blackbody_color(c.x));
        case NodeOp::layer:
            return plain(blended(c, in[1].v, clamp01(in[2].v.x), whole(in[3].v.x, 0, 8)));
        default:
            return arithmetic(op, in);
    }
}

FractalParams fractal_of(const NodeResult* in) {
    return {whole(in[1].v.x, 0, 24), in[2].v.x, in[3].v.x};
}

NodeResult noise_node(NodeOp op, const NodeResult* in) {
    const auto scattered = [](const Worley& w) {
        return NodeResult{Vec3f(w.f1), 0.0f, {w.f2, w.value, 0.0f}};
    };
    switch (op) {
        case NodeOp::noise2d:
            return number(in[0].v.x * noise2d(two(in[2].v), in[2].width) + in[1].v.x);
        case NodeOp::noise3d:
            return number(in[0].v.x * noise3d(in[2].v, in[2].width) + in[1].v.x);
        case NodeOp::fractal2d:
            return number(in[0].v.x * fractal2d(two(in[4].v), fractal_of(in), in[4].width));
        case NodeOp::fractal3d:
            return number(in[0].v.x * fractal3d(in[4].v, fractal_of(in), in[4].width));
        case NodeOp::cellnoise2d:
            return number(cellnoise2d(two(in[0].v), in[0].width));
        case NodeOp::cellnoise3d:
            return number(cellnoise3d(in[0].v, in[0].width));
        case NodeOp::worleynoise2d:
            return scattered(worleynoise2d(two(in[0].v), in[1].v.x, in[0].width));
        case NodeOp::worleynoise3d:
            return scattered(worleynoise3d(in[0].v, in[1].v.x, in[0].width));
        default:
            return color_node(op, in);
    }
}

Cloth cloth_of(const NodeResult* in) {
    const auto n = [&](int i) { return in[i].v.x; };
    ClothParams p;
    p.threads = two(in[1].v), p.over = whole(n(2), 1, 8), p.under = whole(n(3), 1, 8);
    p.step = whole(n(4), -64, 64), p.thread_width = n(5), p.relief = n(6);
    p.variation = n(7), p.fibres = n(8), p.warp = in[9].v, p.weft = in[10].v;
    return cloth(two(in[0].v), p, in[0].width);
}

}  // namespace

Vec3f run_vector_output(NodeOp op, int output, const NodeResult* in) noexcept {
    const float amplitude = in[0].v.x;
    switch (op) {
        case NodeOp::noise2d:
            return noise2d_vec3(two(in[2].v), in[2].width) * amplitude + in[1].v;
        case NodeOp::noise3d:
            return noise3d_vec3(in[2].v, in[2].width) * amplitude + in[1].v;
        case NodeOp::fractal2d:
            return fractal2d_vec3(two(in[4].v), fractal_of(in), in[4].width) * amplitude;
        case NodeOp::fractal3d:
            return fractal3d_vec3(in[4].v, fractal_of(in), in[4].width) * amplitude;
        case NodeOp::worleynoise2d:
            return worleynoise2d_vec3(two(in[0].v), in[1].v.x, in[0].width);
        case NodeOp::worleynoise3d:
            return worleynoise3d_vec3(in[0].v, in[1].v.x, in[0].width);
        case NodeOp::cloth: {
            constexpr int kNormal = 4;
            const Cloth c = cloth_of(in);
            return output == kNormal ? c.normal : Vec3f{c.direction.x, c.direction.y, 0.0f};
        }
        default:
            return {};
    }
}

NodeResult run_node(NodeOp op, const NodeResult* in) noexcept {
    const auto n = [&](int i) { return in[i].v.x; };
    const auto c = [&](int i) { return in[i].v; };
    switch (op) {
        case NodeOp::checkerboard:
            return {checkerboard(two(in[4].v), {c(0), c(1), two(c(2)), two(c(3))}, in[4].width),
                    0.0f,
                    {}};
        case NodeOp::brick: {
            BrickParams p;
            p.size = two(c(1)), p.mortar_width = n(2), p.row_offset = n(3), p.variation = n(4);
            p.irregularity = n(5), p.grain = n(6), p.color1 = c(7), p.color2 = c(8);
            p.mortar = c(9);
            const Brick b = brick(two(c(0)), p, in[0].width);
            return {b.color, 0.0f, {b.height, b.mortar, 0.0f}};
        }
        case NodeOp::wood: {
            WoodParams p;
            p.ring_width = n(1), p.latewood = n(2), p.distortion = n(3), p.ring_variation = n(4);
            p.grain = n(5), p.rays = n(6), p.earlywood = c(7), p.latewood_color = c(8);
            const Wood w = wood(c(0), p, in[0].width);
            return {w.color, 0.0f, {w.height, w.roughness, w.ring}};
        }
        case NodeOp::marble: {
            MarbleParams p;
            p.frequency = n(1), p.turbulence = n(2), p.sharpness = n(3), p.veins = n(4);
            p.base = c(5), p.cloud = c(6), p.vein = c(7);
            const Marble m = marble(c(0), p, in[0].width);
            return {m.color, 0.0f, {m.vein, 0.0f, 0.0f}};
        }
        case NodeOp::cloth: {
            const Cloth w = cloth_of(in);
            return {w.color, 0.0f, {w.height, w.coverage, w.warp_share}};
        }
        case NodeOp::rust: {
            RustParams p;
            p.spread = n(1), p.frequency = n(2), p.detail = n(3), p.softness = n(4);
            p.dark = c(5), p.bright = c(6);
            const Rust r = rust(c(0), p, in[0].width);
            return {r.color, 0.0f, {r.mask, r.height, r.roughness}};
        }
        case NodeOp::flakes: {
            const Flakes f = flakes(c(0), c(1), {n(2), n(3), n(4), n(5)}, in[0].width);
            return {f.normal, 0.0f, {f.mask, f.random, f.roughness}};
        }
        default:
            return noise_node(op, in);
    }
}

}  // namespace tessera
