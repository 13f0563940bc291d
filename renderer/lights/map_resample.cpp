#include "renderer/lights/map_resample.h"

#include <cmath>
#include <limits>

#include "renderer/lights/map_source.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr double kLampOverMean = 4;

Vec3d ratio(Vec3d a, Vec3d b) {
    const auto one = [](double x, double y) {
        const double r = x / y;
        return r > 0.5 && r < 2 ? r : 1.0;
    };
    return {one(a.x, b.x), one(a.y, b.y), one(a.z, b.z)};
}

// A map split into what may be looked up, at most a few times the mean, and lamps: what is above
// that. A look-up at points leaves a lamp's share to chance; a lamp is divided by the share that
// the points gave it.
class Resampler {
public:
    Resampler(const MapSource& source, int height)
        : source_(source),
          width_(2 * height),
          height_(height),
          out_(std::size_t(width_) * height),
          lit_(out_.size(), false),
          received_(source.texels().size(), 0.0) {
        const double ratio =
            source.resolution() / std::sqrt(2.0 / kPiD * static_cast<double>(out_.size()));
        strata_ = std::clamp(static_cast<int>(std::ceil(2 * ratio)), 2, 16);
        limit_ = max(source.total() * (kLampOverMean / (4 * kPiD)), Vec3d(0.0));
    }

    std::vector<Color> run() {
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) gather(x, y);
        }
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) add_lamps(x, y);
        }
        add_missed_lamps();
        return balanced();
    }

private:
    Vec3d lamp(std::size_t texel) const {
        return max(Vec3d(source_.texels()[texel]) - limit_, Vec3d(0.0));
    }
    bool well_met(std::size_t texel) const {
        return received_[texel] > 0.25 * source_.solid_angle(texel);
    }
    std::size_t index(int x, int y) const { return std::size_t(y) * width_ + x; }
    double solid_angle(int y) const {
        return 4 * kPiD / width_ * std::sin(kPiD * (y + 0.5) / height_) *
               std::sin(0.5 * kPiD / height_);
    }

    // Calls f(direction, solid angle) for every stratum of a texel.
    template <class F>
    void each_stratum(int x, int y, F f) const {
        const double rows = height_ * strata_, columns = width_ * strata_;
        const double part = 4 * kPiD / columns * std::sin(0.5 * kPiD / rows);
        for (int j = 0; j < strata_; ++j) {
            const double theta = kPiD * (y * strata_ + j + 0.5) / rows;
            const double sin = std::sin(theta), cos = std::cos(theta);
            for (int i = 0; i < strata_; ++i) {
                const double phi = 2 * kPiD * ((x * strata_ + i + 0.5) / columns - 0.5);
                f(Vec3d{sin * std::sin(phi), cos, -sin * std::cos(phi)}, part * sin);
            }
        }
    }

    void gather(int x, int y) {
        const std::size_t at = index(x, y);
        Vec3d sum;
        each_stratum(x, y, [&](Vec3d d, double weight) {
            for (const MapSource::Tap& tap : source_.taps(d)) {
                const Vec3d c(source_.texels()[tap.texel]);
                const Vec3d low = min(c, limit_);
                sum += low * (tap.weight * weight);
                if (low == c) continue;
                received_[tap.texel] += tap.weight * weight;
                lit_[at] = true;
            }
        });
        out_[at] = sum;
    }

    void add_lamps(int x, int y) {
        const std::size_t at = index(x, y);
        if (!lit_[at]) return;
        each_stratum(x, y, [&](Vec3d d, double weight) {
            for (const MapSource::Tap& tap : source_.taps(d)) {
                if (!well_met(tap.texel)) continue;
                const double share = source_.solid_angle(tap.texel) / received_[tap.texel];
                out_[at] += lamp(tap.texel) * (tap.weight * weight * share);
            }
        });
    }

    // Those that fell between the points go whole to where their middle is.
    void add_missed_lamps() {
        for (std::size_t i = 0; i < received_.size(); ++i) {
            const Vec3d l = lamp(i);
            if (well_met(i) || max_component(l) == 0) continue;
            const MapPoint p = map_point(MapProjection::latlong, source_.direction(i));
            const int x = std::min(static_cast<int>(p.x * width_), width_ - 1),
                      y = std::min(static_cast<int>(p.y * height_), height_ - 1);
            out_[index(x, y)] += l * source_.solid_angle(i);
        }
    }

    // What is left of rounding and of look-ups in the even parts is made up by one factor.
    std::vector<Color> balanced() const {
        Vec3d sum;
        for (const Vec3d& c : out_) sum += c;
        const Vec3d factor = ratio(source_.total(), sum);
        constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
        std::vector<Color> map;
        map.reserve(out_.size());
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const Vec3d c = out_[index(x, y)] * factor / solid_angle(y);
                map.emplace_back(max(min(c, Vec3d(kMost)), Vec3d(-kMost)));
            }
        }
        return map;
    }

    const MapSource& source_;
    int width_, height_, strata_ = 2;
    Vec3d limit_;
    std::vector<Vec3d> out_;  // radiance times solid angle
    std::vector<bool> lit_;   // texels that met a lamp
    std::vector<double> received_;
};

}  // namespace

std::vector<Color> resample_to_latlong(MapProjection projection, int width, int height,
                                       std::span<const Color> picture, int latlong_height) {
    if (!projection_fits(projection, width, height) || latlong_height <= 0) return {};
    const std::size_t count = std::size_t(width) * height;
    if (picture.size() < count) return {};
    const MapSource source(projection, width, height, picture.first(count));
    return Resampler(source, latlong_height).run();
}

std::vector<Color> resample_to_latlong(CubeFaces faces, int size,
                                       const std::array<std::span<const Color>, 6>& pictures,
                                       int latlong_height) {
    if (size <= 0 || latlong_height <= 0) return {};
    const std::size_t count = std::size_t(size) * size;
    for (const auto& face : pictures) {
        if (face.size() != count) return {};
    }
    const MapSource source(faces, size, pictures);
    return Resampler(source, latlong_height).run();
}

}  // namespace tessera
