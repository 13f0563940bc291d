#include "materials/nodes/box_filter.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

// Position and footprint in threads, and the weave.
struct Weave {
    float x, y, wx, wy;
    float thread;  // width
    int over, period, step;

    int phase(std::int32_t i, std::int32_t j) const {
        const std::int64_t k = i + static_cast<std::int64_t>(j) * step;
        const auto m = static_cast<int>(k % period);
        return m < 0 ? m + period : m;
    }
    bool warp_on_top(std::int32_t i, std::int32_t j) const { return phase(i, j) < over; }
};

struct Shares {
    float warp, weft;
};

// Shares of the footprint in which warp and weft are seen. At a crossing the upper thread hides the
// lower one; beside it the lower one shows. Threads of one phase are one pulse of the weave's
// period, so that the sum over all crossings is one over pairs of phases.
Shares shares(const Weave& v) {
    const float n = static_cast<float>(v.period), lo = 0.5f - 0.5f * v.thread, hi = 1.0f - lo;
    const auto on = [&](float x, float w, int k) {
        const float f = static_cast<float>(k);
        return pulse_mean(x / n, w / n, (f + lo) / n, (f + hi) / n);
    };
    float warps[16], wefts[16], warp = 0.0f, weft = 0.0f;
    for (int k = 0; k < v.period; ++k) {
        warp += warps[k] = on(v.x, v.wx, k);
        weft += wefts[k] = on(v.y, v.wy, k);
    }
    float on_top = 0.0f;
    for (int j = 0; j < v.period; ++j)
        for (int i = 0; i < v.period; ++i)
            if (v.warp_on_top(i, j)) on_top += warps[i] * wefts[j];
    return {on_top + warp * (1.0f - weft), weft - on_top};
}

// Height of a thread's axis between two crossings: -1 below, 1 on top; and its slope.
struct Wave {
    float z, slope;
};
Wave wave(bool here, bool there, float t) {
    const float a = here ? 1.0f : -1.0f, b = there ? 1.0f : -1.0f;
    return {a + (b - a) * t * t * (3.0f - 2.0f * t), (b - a) * 6.0f * t * (1.0f - t)};
}

// One thread where it passes under or over the point, or beside it.
struct Strand {
    float across;  // in [-1, 1] on the thread
    Wave axis;
    bool on_top;

    bool hit() const { return std::fabs(across) <= 1.0f; }
    float edge() const { return std::clamp(across, -1.0f, 1.0f); }
    float height() const { return (axis.z + 2.0f - sqr(edge())) / 3.0f; }
    // Slopes across and along the thread, for a thickness of `relief` times its width.
    float slope_across(float relief) const { return -2.0f * relief * edge(); }
    float slope_along(float relief, float thread) const {
        return 0.5f * relief * thread * axis.slope;
    }
};

// top(k): whether this thread is on top at crossing k along it.
template <class Top>
Strand strand(float across, float along, float thread, Top top) {
    const LatticeCell c = lattice_cell(along);
    const bool before = c.f < 0.5f;
    const float t = before ? c.f + 0.5f : c.f - 0.5f;
    const std::int32_t first = before ? c.i - 1 : c.i;
    return {(across - 0.5f) * 2.0f / thread, wave(top(first), top(first + 1), t), top(c.i)};
}

struct Crossing {
    Strand warp, weft;
    bool shows_warp() const {
        return warp.hit() && weft.hit() ? warp.on_top : warp.hit() || !weft.hit();
    }
};

Crossing crossing(const Weave& v) {
    const LatticeCell x = lattice_cell(v.x), y = lattice_cell(v.y);
    return {strand(x.f, v.y, v.thread, [&](std::int32_t j) { return v.warp_on_top(x.i, j); }),
            strand(y.f, v.x, v.thread, [&](std::int32_t i) { return !v.warp_on_top(i, y.i); })};
}

// Mean height of what is seen. A thread's round back lies at 2/3 of its thickness; at the ends of
// its floats the upper one bows down; beside crossings both threads' axes cancel; a gap counts 0.
float mean_height(const Weave& v) {
    int ends = 0;  // in a period of one warp and one weft thread
    for (int k = 0; k < v.period; ++k) {
        const bool here = v.warp_on_top(k, 0);
        ends += here != v.warp_on_top(k, 1);
        ends += here != v.warp_on_top(k + 1, 0);
    }
    const float t = v.thread, half = 0.5f * t, back = 5.0f / 3.0f;
    const float bow =
        sqr(half) * (2.0f - half) * 0.5f * static_cast<float>(ends) / static_cast<float>(v.period);
    return (t * t * (back + 1.0f - bow) + 2.0f * t * (1.0f - t) * back) / 3.0f;
}

// Brightness of a thread, and of the fibres twisted into it; `across` and `along` in threads.
float shade(const ClothParams& c, float across, float along, float w, float row) {
    const float of_thread = cellnoise2d({across, row}, w) - 0.5f;
    const FractalParams two{.octaves = 2, .diminish = 0.7f};
    const float twist =
        fractal2d({across * 6.0f + along * 3.5f, along * 0.5f + row}, two, w * 7.0f);
    const float sum = 1.0f + within(c.variation, 0.0f, 1.0f) * of_thread +
                      0.9f * within(c.fibres, 0.0f, 1.0f) * twist;
    return std::max(sum, 0.0f);
}

// Slopes of what is seen, each thread by its share.
Vec2f slopes(const Crossing& at, const Shares& s, float relief, float thread) {
    const Vec2f warp{at.warp.slope_across(relief), at.warp.slope_along(relief, thread)};
    const Vec2f weft{at.weft.slope_along(relief, thread), at.weft.slope_across(relief)};
    return warp * s.warp + weft * s.weft;
}

}  // namespace

Cloth cloth(Vec2f p, const ClothParams& c, float width) noexcept {
    const Vec2f at = coordinate(p);
    const float tx = within(c.threads.x, 1e-6f, 1e6f), ty = within(c.threads.y, 1e-6f, 1e6f);
    const float w = footprint(width);
    const int over = std::clamp(c.over, 1, 8), under = std::clamp(c.under, 1, 8);
    const Weave v{coordinate(at.x * tx),
                  coordinate(at.y * ty),
                  w * tx,
                  w * ty,
                  within(c.thread_width, 0.05f, 1.0f),
                  over,
                  over + under,
                  c.step};
    const Crossing at_point = crossing(v);
    const Shares s = shares(v);

    Cloth out;
    out.is_warp = at_point.shows_warp();
    out.direction = out.is_warp ? Vec2f{0.0f, 1.0f} : Vec2f{1.0f, 0.0f};
    out.coverage = clamp01(s.warp + s.weft);
    out.warp_share =
        out.coverage > 0.0f ? clamp01(s.warp / out.coverage) : (out.is_warp ? 1.0f : 0.0f);

    const float wide = std::max(v.wx, v.wy), kept = fade_out(wide, 1.2f);
    const Color warp = c.warp * shade(c, v.x, v.y, wide, 0.5f);
    const Color weft = c.weft * shade(c, v.y, v.x, wide, 64.5f);
    out.color = lerp(weft, warp, out.warp_share);

    const float mean = mean_height(v);
    const float height = s.warp * at_point.warp.height() + s.weft * at_point.weft.height();
    out.height = clamp01(mean + (height - mean) * kept);
    const Vec2f slope = slopes(at_point, s, within(c.relief, 0.0f, 2.0f), v.thread) * kept;
    out.normal = normalize(Vec3f{-slope.x, -slope.y, 1.0f});
    return out;
}

}  // namespace tessera
