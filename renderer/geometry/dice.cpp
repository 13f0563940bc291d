#include "renderer/geometry/dice.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
using Chain = std::vector<std::uint32_t>;

// A point on the side of a face, x of the way from corner k to the next.
DiceSite on_side(std::uint32_t face, std::uint32_t corners, std::uint32_t k, float x) {
    if (corners == 3) {
        if (x <= 0.5f) return {face, k, 2.0f * x, 0.0f};
        return {face, (k + 1) % 3, 0.0f, 2.0f * (1.0f - x)};
    }
    switch (k) {
        case 0:
            return {face, 0, x, 0.0f};
        case 1:
            return {face, 0, 1.0f, x};
        case 2:
            return {face, 0, 1.0f - x, 1.0f};
        default:
            return {face, 0, 0.0f, 1.0f - x};
    }
}

// The rates of a patch's four sides, counter-clockwise from the bottom.
struct Sides {
    int bottom, right, top, left;
    int across() const { return std::max(bottom, top); }
    int up() const { return std::max(right, left); }
};

int spoke_rate(const Cage& cage, const Cage::Face& f, std::span<const int> rates) {
    int most = 0;
    for (std::uint32_t k = 0; k < 3; ++k) most = std::max(most, rates[cage.edge[f.first + k]] / 2);
    return most;
}

Sides sides_of(const Cage& cage, const Cage::Face& f, std::uint32_t patch,
               std::span<const int> rates) {
    const auto rate = [&](std::uint32_t k) { return rates[cage.edge[f.first + k]]; };
    if (f.corners == 4) return {rate(0), rate(1), rate(2), rate(3)};
    const int spoke = spoke_rate(cage, f, rates);
    return {rate(patch) / 2, spoke, spoke, rate((patch + 2) % 3) / 2};
}

std::uint64_t patch_triangles(const Sides& s) {
    const auto nu = static_cast<std::uint64_t>(s.across()), nv = static_cast<std::uint64_t>(s.up());
    const std::uint64_t along_u = static_cast<std::uint64_t>(s.bottom) + s.top;
    const std::uint64_t along_v = static_cast<std::uint64_t>(s.right) + s.left;
    if (nu == 1) return along_v;
    if (nv == 1) return along_u;
    return 2 * (nu - 2) * (nv - 2) + along_u + along_v + 2 * (nu - 2) + 2 * (nv - 2);
}

class Dicer {
public:
    Dicer(const Cage& cage, std::span<const int> rates) : cage_(cage), rates_(rates) {}

    Diced run() {
        add_corners();
        add_edges();
        for (face_ = 0; face_ < cage_.faces.size(); ++face_) {
            if (cage_.faces[face_].corners == 4)
                fill_quad();
            else
                fill_triangle();
        }
        return std::move(out_);
    }

private:
    // What a face sees of an edge: faces on both sides of a texture seam see vertices of their own.
    struct EdgeSide {
        std::uint32_t wedge_a, wedge_b, first, next;
    };

    std::uint32_t add(const DiceSite& site, std::uint32_t place) {
        out_.sites.push_back(site);
        out_.place.push_back(place);
        return static_cast<std::uint32_t>(out_.sites.size()) - 1;
    }
    std::uint32_t add_inside(std::uint32_t patch, float s, float t) {
        return add({face_, patch, s, t}, out_.places++);
    }

    void add_corners() {
        out_.sites.resize(cage_.wedges);
        out_.place.assign(cage_.wedges, kNone);
        out_.places = static_cast<std::uint32_t>(cage_.places.size());
        for (std::uint32_t f = 0; f < cage_.faces.size(); ++f) {
            const Cage::Face& face = cage_.faces[f];
            for (std::uint32_t k = 0; k < face.corners; ++k) {
                const std::uint32_t w = cage_.wedge[face.first + k];
                if (out_.place[w] != kNone) continue;
                out_.sites[w] = on_side(f, face.corners, k, 0.0f);
                out_.place[w] = cage_.place[face.first + k];
            }
        }
    }

    void add_edges() {
        std::vector<std::uint32_t> first_place(cage_.edges.size()),
            first_side(cage_.edges.size(), kNone);
        for (std::size_t e = 0; e < cage_.edges.size(); ++e) {
            first_place[e] = out_.places;
            out_.places += static_cast<std::uint32_t>(rates_[e]) - 1;
        }
        side_.resize(cage_.place.size());
        for (std::uint32_t f = 0; f < cage_.faces.size(); ++f) {
            const Cage::Face& face = cage_.faces[f];
            for (std::uint32_t k = 0; k < face.corners; ++k) {
                const std::uint32_t c = face.first + k, e = cage_.edge[c];
                const bool along = cage_.place[c] == cage_.edges[e].a;
                std::uint32_t a = cage_.wedge[c], b = cage_.wedge[face.first + cage_.next(face, k)];
                if (!along) std::swap(a, b);
                std::uint32_t side = first_side[e];
                while (side != kNone && (sides_[side].wedge_a != a || sides_[side].wedge_b != b))
                    side = sides_[side].next;
                if (side == kNone) {
                    side = static_cast<std::uint32_t>(sides_.size());
                    sides_.push_back(
                        {a, b, static_cast<std::uint32_t>(out_.sites.size()), first_side[e]});
                    first_side[e] = side;
                    const int n = rates_[e];
                    for (int i = 1; i < n; ++i) {
                        const float x =
                            static_cast<float>(along ? i : n - i) / static_cast<float>(n);
                        add(on_side(f, face.corners, k, x),
                            first_place[e] + static_cast<std::uint32_t>(i) - 1);
                    }
                }
                side_[c] = side;
            }
        }
    }

    // The vertices of a face's side from corner k to the next, both ends included.
    Chain side(const Cage::Face& f, std::uint32_t k) const {
        const std::uint32_t c = f.first + k, e = cage_.edge[c];
        const EdgeSide& s = sides_[side_[c]];
        Chain chain{s.wedge_a};
        for (int i = 1; i < rates_[e]; ++i)
            chain.push_back(s.first + static_cast<std::uint32_t>(i) - 1);
        chain.push_back(s.wedge_b);
        if (cage_.place[c] != cage_.edges[e].a) std::reverse(chain.begin(), chain.end());
        return chain;
    }

    void fill_quad() {
        const Cage::Face& f = cage_.faces[face_];
        const Chain ring[4] = {side(f, 0), side(f, 1), side(f, 2), side(f, 3)};
        fill(0, ring);
    }

    void fill_triangle() {
        const Cage::Face& f = cage_.faces[face_];
        const Chain sides[3] = {side(f, 0), side(f, 1), side(f, 2)};
        const std::uint32_t middle = add_inside(0, 1.0f, 1.0f);
        const int n = spoke_rate(cage_, f, rates_);
        Chain spokes[3];  // from the edge's middle to the face's
        for (std::uint32_t k = 0; k < 3; ++k) {
            spokes[k].push_back(sides[k][sides[k].size() / 2]);
            for (int i = 1; i < n; ++i)
                spokes[k].push_back(
                    add_inside(k, 1.0f, static_cast<float>(i) / static_cast<float>(n)));
            spokes[k].push_back(middle);
        }
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t before = (k + 2) % 3;
            const auto half = [](const Chain& c) {
                return c.begin() + static_cast<std::ptrdiff_t>(c.size() / 2);
            };
            const Chain ring[4] = {{sides[k].begin(), half(sides[k]) + 1},
                                   spokes[k],
                                   {spokes[before].rbegin(), spokes[before].rend()},
                                   {half(sides[before]), sides[before].end()}};
            fill(k, ring);
        }
    }

    // ring: the four sides counter-clockwise, each with both its corners.
    void fill(std::uint32_t patch, const Chain (&ring)[4]) {
        const auto pieces = [&](int side) { return static_cast<int>(ring[side].size()) - 1; };
        const int nu = std::max(pieces(0), pieces(2)), nv = std::max(pieces(1), pieces(3));
        if (nu == 1) return strip(ring[1], {ring[3].rbegin(), ring[3].rend()}, false);
        if (nv == 1) return strip(ring[0], {ring[2].rbegin(), ring[2].rend()}, false);
        const std::uint32_t first = static_cast<std::uint32_t>(out_.sites.size());
        const auto inside = [&](int i, int j) {
            return first + static_cast<std::uint32_t>((j - 1) * (nu - 1) + i - 1);
        };
        for (int j = 1; j < nv; ++j)
            for (int i = 1; i < nu; ++i)
                add_inside(patch, static_cast<float>(i) / static_cast<float>(nu),
                           static_cast<float>(j) / static_cast<float>(nv));
        // Where opposite sides are cut alike, the whole is one grid.
        const bool even = pieces(0) == pieces(2) && pieces(1) == pieces(3);
        const auto at = [&](int i, int j) {
            if (j == 0) return ring[0][static_cast<std::size_t>(i)];
            if (i == nu) return ring[1][static_cast<std::size_t>(j)];
            if (j == nv) return ring[2][static_cast<std::size_t>(nu - i)];
            if (i == 0) return ring[3][static_cast<std::size_t>(nv - j)];
            return inside(i, j);
        };
        const int rim = even ? 0 : 1;
        for (int j = rim; j + rim < nv; ++j)
            for (int i = rim; i + rim < nu; ++i)
                quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if (even) return;
        Chain inner[4];
        for (int i = 1; i < nu; ++i) {
            inner[0].push_back(inside(i, 1));
            inner[2].push_back(inside(nu - i, nv - 1));
        }
        for (int j = 1; j < nv; ++j) {
            inner[1].push_back(inside(nu - 1, j));
            inner[3].push_back(inside(1, nv - j));
        }
        for (int side = 0; side < 4; ++side) strip(ring[side], inner[side], true);
    }

    // Between two chains that run the same way, `upper` to the left of `lower`. inset: upper begins
    // and ends one piece further in.
    void strip(const Chain& lower, const Chain& upper, bool inset) {
        const std::size_t n = lower.size() - 1, m = upper.size() - 1;
        const std::size_t shift = inset ? 1 : 0, pieces = m + 2 * shift;
        std::size_t i = 0, j = 0;
        while (i < n || j < m) {
            // Whose next vertex comes first: (i + 1) / n or (j + 1 + shift) / pieces.
            const std::size_t next_lower = (i + 1) * pieces, next_upper = (j + 1 + shift) * n;
            if (i < n && j < m && next_lower == next_upper && i * pieces == (j + shift) * n) {
                quad(lower[i], lower[i + 1], upper[j + 1], upper[j]);
                ++i, ++j;
            } else if (j == m || (i < n && next_lower <= next_upper)) {
                triangle(lower[i], lower[i + 1], upper[j]);
                ++i;
            } else {
                triangle(lower[i], upper[j + 1], upper[j]);
                ++j;
            }
        }
    }

    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        out_.triangles.insert(out_.triangles.end(), {a, b, c});
        out_.triangle_face.push_back(face_);
    }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        out_.quads.insert(out_.quads.end(), {a, b, c, d});
        out_.quad_face.push_back(face_);
    }

    const Cage& cage_;
    std::span<const int> rates_;
    std::vector<EdgeSide> sides_;
    std::vector<std::uint32_t> side_;  // per corner
    std::uint32_t face_ = 0;
    Diced out_;
};

}  // namespace

void make_even(const Cage& cage, std::vector<int>& rates) {
    for (std::size_t e = 0; e < cage.edges.size(); ++e)
        if (cage.edges[e].triangle) rates[e] += rates[e] % 2;
}

std::uint64_t diced_triangles(const Cage& cage, std::span<const int> rates) {
    std::uint64_t sum = 0;
    for (const Cage::Face& f : cage.faces)
        for (std::uint32_t patch = 0; patch < (f.corners == 3 ? 3u : 1u); ++patch)
            sum += patch_triangles(sides_of(cage, f, patch, rates));
    return sum;
}

Diced dice(const Cage& cage, std::span<const int> rates) { return Dicer(cage, rates).run(); }

PatchRates patch_rates(const Cage& cage, std::span<const int> rates, const DiceSite& site) {
    const Sides s = sides_of(cage, cage.faces[site.face], site.patch, rates);
    return {s.across(), s.up()};
}

CornerWeights corner_weights(std::uint32_t corners, std::uint32_t patch, float s, float t) {
    const float p[4] = {(1.0f - s) * (1.0f - t), s * (1.0f - t), s * t, (1.0f - s) * t};
    if (corners == 4) return {{p[0], p[1], p[2], p[3]}};
    // Corner, middle of its edge, middle of the face, middle of the edge before.
    const float third = p[2] / 3.0f;
    CornerWeights out;
    out.w[patch] = p[0] + 0.5f * (p[1] + p[3]) + third;
    out.w[(patch + 1) % 3] = 0.5f * p[1] + third;
    out.w[(patch + 2) % 3] = 0.5f * p[3] + third;
    return out;
}

std::size_t Diced::bytes() const noexcept {
    return sites.capacity() * sizeof(DiceSite) +
           (place.capacity() + triangles.capacity() + quads.capacity() + triangle_face.capacity() +
            quad_face.capacity()) *
               sizeof(std::uint32_t);
}

}  // namespace tessera
