#include "renderer/compare/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "renderer/compare/eye_colour.h"
#include "renderer/compare/row_filter.h"
#include "renderer/compare/tone_curve.h"

namespace tessera {
namespace {

constexpr int kBand = 64;
// HPG 2020, section 4: exponents and the knee of colour differences, exponent and size of features.
constexpr float kColourPower = 0.7f, kKnee = 0.4f, kKneeValue = 0.95f;
constexpr double kFeatureDegrees = 0.082;

/// What the eye filters with at a distance. Contrast sensitivity: table 1, sums of Gaussians
/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct EyeFilters {
    Kernel achromatic, red_green, blue_yellow[2];
    float blue_yellow_weight[2];
    Kernel blur, slope, bend;  // of features
    int halo = 0;

    explicit EyeFilters(double pixels_per_degree) {
        const double pi = std::numbers::pi;
        const auto sigma = [&](double b) { return std::sqrt(b / 2) / pi * pixels_per_degree; };
        const int reach = static_cast<int>(std::ceil(3 * sigma(0.04)));
        const auto bell = [&](double b) {
            // Beyond six sigma there is nothing left of the narrow ones.
            return gaussian(sigma(b), std::min(reach, static_cast<int>(std::ceil(6 * sigma(b)))));
        };
        achromatic = bell(0.0047), red_green = bell(0.0053);
        blue_yellow[0] = bell(0.04), blue_yellow[1] = bell(0.025);
        // Volumes of the two before each was given the sum 1.
        const double wide = 34.1 * std::sqrt(pi / 0.04) * volume(sigma(0.04), reach);
        const double narrow = 13.5 * std::sqrt(pi / 0.025) * volume(sigma(0.025), reach);
        blue_yellow_weight[0] = static_cast<float>(wide / (wide + narrow));
        blue_yellow_weight[1] = static_cast<float>(narrow / (wide + narrow));
        const double feature_sigma = 0.5 * kFeatureDegrees * pixels_per_degree;
        const int feature_reach = static_cast<int>(std::ceil(3 * feature_sigma));
        blur = gaussian(feature_sigma, feature_reach);
        slope = gaussian_slope(feature_sigma, feature_reach);
        bend = gaussian_bend(feature_sigma, feature_reach);
        halo = std::max(reach, feature_reach);
    }

    static double volume(double sigma, int reach) {
        double sum = 0;
        for (int i = -reach; i <= reach; ++i) sum += std::exp(-i * i / (2 * sigma * sigma));
        return sum * sum;
    }
};

// Greatest difference that there can be: of the primaries green and blue.
float greatest_difference() {
    return power_of(hyab(to_hunt_lab(0, 1, 0), to_hunt_lab(0, 0, 1)), kColourPower);
}

/// What is seen of one picture in a band of rows.
struct Seen {
    Rows opponent[3], light;   // with the halo
    Rows filtered[3], lab[3];  // without
    Rows edges, points;
};

/// Buffers of a worker.
struct Scratch {
    Seen a, reference;
    Rows along, across;
};

void filter_both(const Rows& in, const Kernel& x, const Kernel& y, int halo, Rows& out,
                 Scratch& s) {
    filter_along_rows(in, x, s.along);
    filter_across_rows(s.along, y, halo, out);
}

void add_square(const Rows& in, Rows& sum) {
    for (std::size_t i = 0; i < in.values.size(); ++i) sum.values[i] += in.values[i] * in.values[i];
}

// Length of (d/dx, d/dy) of the blurred light, for first or second derivatives.
void feature_length(const Rows& light, const Kernel& derivative, const EyeFilters& eye, Rows& out,
                    Scratch& s) {
    filter_both(light, derivative, eye.blur, eye.halo, s.across, s);
    out.resize(s.across.width, s.across.count);
    std::fill(out.values.begin(), out.values.end(), 0.0f);
    add_square(s.across, out);
    filter_both(light, eye.blur, derivative, eye.halo, s.across, s);
    add_square(s.across, out);
    for (float& v : out.values) v = std::sqrt(v);
}

// Compilers give up on loops over so many arrays that could overlap, unless they are told that
// none does.
using In = const float* __restrict;
using Out = float* __restrict;

void to_lab(In achromatic, In red_green, In blue_yellow, std::size_t count, Out l, Out a, Out b) {
    for (std::size_t i = 0; i < count; ++i) {
        const Colour3 rgb = from_opponent(achromatic[i], red_green[i], blue_yellow[i]);
        const Colour3 lab = to_hunt_lab(rgb[0], rgb[1], rgb[2]);
        l[i] = lab[0], a[i] = lab[1], b[i] = lab[2];
    }
}

void to_lab(Seen& seen) {
    for (Rows& rows : seen.lab) rows.resize(seen.filtered[0].width, seen.filtered[0].count);
    to_lab(seen.filtered[0].row(0), seen.filtered[1].row(0), seen.filtered[2].row(0),
           seen.lab[0].values.size(), seen.lab[0].row(0), seen.lab[1].row(0), seen.lab[2].row(0));
}

// Sections 4.1 and 4.2: what remains at a distance, its colours, its edges and points.
void look(const EyeFilters& eye, Seen& seen, Scratch& s) {
    filter_both(seen.opponent[0], eye.achromatic, eye.achromatic, eye.halo, seen.filtered[0], s);
    filter_both(seen.opponent[1], eye.red_green, eye.red_green, eye.halo, seen.filtered[1], s);
    Rows& sum = seen.filtered[2];
    filter_both(seen.opponent[2], eye.blue_yellow[0], eye.blue_yellow[0], eye.halo, sum, s);
    filter_both(seen.opponent[2], eye.blue_yellow[1], eye.blue_yellow[1], eye.halo, s.across, s);
    for (std::size_t i = 0; i < sum.values.size(); ++i)
        sum.values[i] = eye.blue_yellow_weight[0] * sum.values[i] +
                        eye.blue_yellow_weight[1] * s.across.values[i];
    to_lab(seen);
    feature_length(seen.light, eye.slope, eye, seen.edges, s);
    feature_length(seen.light, eye.bend, eye, seen.points, s);
}

// Section 4.1, redistribution: most differences into the lower 95 %.
float spread(float difference, float greatest) {
    const float d = power_of(difference, kColourPower), knee = kKnee * greatest;
    const float below = d * (kKneeValue / knee);
    const float above = kKneeValue + (d - knee) / (greatest - knee) * (1 - kKneeValue);
    return d < knee ? below : above;
}

// Section 4.3: colour differences, amplified by those of features.
void combine(const Seen& a, const Seen& r, float greatest, float* out) {
    const float half_root = std::numbers::sqrt2_v<float> / 2;
    for (std::size_t i = 0; i < a.edges.values.size(); ++i) {
        const Colour3 p{a.lab[0].values[i], a.lab[1].values[i], a.lab[2].values[i]};
        const Colour3 q{r.lab[0].values[i], r.lab[1].values[i], r.lab[2].values[i]};
        const float colour = spread(hyab(p, q), greatest);
        const float feature = std::max(std::fabs(a.edges.values[i] - r.edges.values[i]),
                                       std::fabs(a.points.values[i] - r.points.values[i]));
        const float error = power_of(colour, 1 - std::sqrt(half_root * feature));
        out[i] = std::max(out[i], std::min(error, 1.0f));
    }
}

class Flip {
public:
    /// Without exposures the pictures are shown as they are.
    Flip(const PictureView& a, const PictureView& reference, double pixels_per_degree,
         std::vector<double> exposures)
        : a_(a),
          reference_(reference),
          eye_(pixels_per_degree),
          exposures_(std::move(exposures)),
          greatest_(greatest_difference()) {}

    std::vector<float> run(Workers& workers) const {
        std::vector<float> out(a_.pixels());
        const int bands = (a_.height + kBand - 1) / kBand;
        workers.for_each(bands, [&](int band) {
            const int y0 = band * kBand, y1 = std::min(y0 + kBand, a_.height);
            if (same(y0, y1)) return;
            compare(y0, y1,
                    out.data() + static_cast<std::size_t>(y0) * static_cast<std::size_t>(a_.width));
        });
        return out;
    }

private:
    bool same(int y0, int y1) const {
        const int from = std::max(y0 - eye_.halo, 0), to = std::min(y1 + eye_.halo, a_.height);
        const std::size_t row = static_cast<std::size_t>(a_.width) * 3;
        const std::size_t begin = row * static_cast<std::size_t>(from);
        return std::memcmp(a_.values.data() + begin, reference_.values.data() + begin,
                           row * static_cast<std::size_t>(to - from) * sizeof(float)) == 0;
    }

    void compare(int y0, int y1, float* out) const {
        Scratch s;
        const std::size_t times = std::max<std::size_t>(exposures_.size(), 1);
        for (std::size_t i = 0; i < times; ++i) {
            load(a_, y0, y1, i, s.a);
            load(reference_, y0, y1, i, s.reference);
            look(eye_, s.a, s);
            look(eye_, s.reference, s);
            combine(s.a, s.reference, greatest_, out);
        }
    }

    // The rows with their halo; those beyond the picture repeat its first or last.
    void load(const PictureView& picture, int y0, int y1, std::size_t exposure, Seen& seen) const {
        constexpr double kMost = 1e30;  // times 0 it is 0
        const float gain =
            exposures_.empty()
                ? 1
                : static_cast<float>(std::min(std::exp2(exposures_[exposure]), kMost));
        const auto show = [&](float v) {
            const float shown = exposures_.empty() ? v : tone_curve(std::max(v * gain, 0.0f));
            return std::min(std::max(shown, 0.0f), 1.0f);
        };
        const int count = y1 - y0 + 2 * eye_.halo;
        for (Rows& rows : seen.opponent) rows.resize(picture.width, count);
        seen.light.resize(picture.width, count);
        for (int y = 0; y < count; ++y) {
            const int from = std::clamp(y0 - eye_.halo + y, 0, picture.height - 1);
            const float* const in =
                picture.values.data() +
                static_cast<std::size_t>(from) * static_cast<std::size_t>(picture.width) * 3;
            float* const o0 = seen.opponent[0].row(y);
            float* const o1 = seen.opponent[1].row(y);
            float* const o2 = seen.opponent[2].row(y);
            float* const light = seen.light.row(y);
            for (int x = 0; x < picture.width; ++x) {
                const Colour3 o =
                    to_opponent(show(in[3 * x]), show(in[3 * x + 1]), show(in[3 * x + 2]));
                o0[x] = o[0], o1[x] = o[1], o2[x] = o[2];
                light[x] = (o[0] + 16) * (1 / 116.0f);
            }
        }
    }

    const PictureView &a_, &reference_;
    EyeFilters eye_;
    std::vector<double> exposures_;
    float greatest_;
};

}  // namespace

std::vector<float> ldr_flip(const PictureView& a, const PictureView& reference,
                            double pixels_per_degree, Workers& workers) {
    return Flip(a, reference, pixels_per_degree, {}).run(workers);
}

std::vector<float> hdr_flip(const PictureView& a, const PictureView& reference,
                            double pixels_per_degree, Workers& workers) {
    return Flip(a, reference, pixels_per_degree, flip_exposures(reference)).run(workers);
}

}  // namespace tessera
