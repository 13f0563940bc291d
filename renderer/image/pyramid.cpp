#include "renderer/image/pyramid.h"

#include <half.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/colour_names.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/pixel_reader.h"

namespace tessera {
namespace {

constexpr float kHalfMax = 65504.0f;
constexpr float kAlphaFloor = 1.0f / 1024;  // weight of a texel that is quite transparent

bool is_data_name(const std::string& space) { return own_name(space) == kRaw; }

/// Nearest sRGB code of a linear value: where it falls between the midpoints of the codes.
class SrgbEncoder {
public:
    SrgbEncoder() {
        for (std::size_t i = 0; i < mid_.size(); ++i)
            mid_[i] = srgb_to_linear((static_cast<float>(i) + 0.5f) / 255);
    }
    std::uint8_t operator()(float linear) const {
        return static_cast<std::uint8_t>(std::upper_bound(mid_.begin(), mid_.end(), linear) -
                                         mid_.begin());
    }

private:
    std::array<float, 255> mid_;
};

float clamp_unit(float v) { return std::clamp(v, 0.0f, 1.0f); }

std::vector<Pyramid::Level> pyramid_levels(int width, int height) {
    std::vector<Pyramid::Level> levels;
    std::size_t texels = 0;
    for (;;) {
        levels.push_back({texels, width, height});
        texels += levels.back().texels();
        if (width == 1 && height == 1) return levels;
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
}

/// Fills a pyramid: level 0 from rows of a file, the rest from what was stored.
class Builder {
public:
    Builder(Pyramid& out, bool srgb, bool weighted)
        : p_(out), srgb_(srgb), weighted_(weighted && out.has_alpha()) {
        n_ = static_cast<std::size_t>(p_.channels);
    }

    /// Room for a picture of this size and all levels below it.
    void allocate(int width, int height) {
        p_.levels = pyramid_levels(width, height);
        const std::size_t texels = p_.levels.back().first + p_.levels.back().texels();
        if (p_.type == TexelType::byte)
            p_.bytes.resize(texels * n_);
        else
            p_.words.resize(texels * n_);
    }

    /// Where channel 0 of a texel is stored.
    std::size_t at(std::size_t k, int x, int y) const {
        const Pyramid::Level& l = p_.levels[k];
        return (l.first + l.row(y) + l.column(x)) * n_;
    }

    void put(std::size_t at, float value, bool is_alpha) {
        switch (p_.type) {
            case TexelType::byte:
                p_.bytes[at] = srgb_ && !is_alpha
                                   ? encode_(value)
                                   : static_cast<std::uint8_t>(clamp_unit(value) * 255 + 0.5f);
                break;
            case TexelType::unorm16:
                p_.words[at] = static_cast<std::uint16_t>(clamp_unit(value) * 65535 + 0.5f);
                break;
            case TexelType::half:
                p_.words[at] = half(checked(value)).bits();
                break;
        }
    }

    bool is_alpha(std::size_t channel) const { return p_.has_alpha() && channel + 1 == n_; }

    /// Mean and constant channels of level 0, then the other levels.
    void finish() {
        survey();
        std::vector<float> above, below;
        for (std::size_t k = 0; k + 1 < p_.levels.size(); ++k) {
            shrink(k, above, below);
            store(k + 1, below);
            above.swap(below);
        }
    }

private:
    float checked(float value) {
        if (!std::isfinite(value)) {
            ++p_.non_finite;
            return 0;
        }
        if (std::abs(value) > kHalfMax) {
            ++p_.clamped;
            return std::copysign(kHalfMax, value);
        }
        return value;
    }

    float value_at(std::size_t at, std::size_t channel) const {
        if (p_.type == TexelType::byte)
            return (is_alpha(channel) ? p_.alpha_table : p_.color_table)[p_.bytes[at]];
        if (p_.type == TexelType::unorm16) return static_cast<float>(p_.words[at]) / 65535.0f;
        return imath_half_to_float(p_.words[at]);
    }

    void survey() {
        const Pyramid::Level& l = p_.levels[0];
        const double texels = static_cast<double>(l.width) * l.height;
        std::array<double, 4> sum{};
        std::array<bool, 4> one{true, true, true, true};
        for (int y = 0; y < l.height; ++y)
            for (int x = 0; x < l.width; ++x)
                for (std::size_t c = 0; c < n_; ++c) {
                    const float v = value_at(at(0, x, y) + c, c);
                    sum[c] += static_cast<double>(v);
                    one[c] = one[c] && v == 1.0f;
                }
        const bool grey = n_ < 3;
        for (std::size_t c = 0; c < 3; ++c) {
            p_.mean[c] = static_cast<float>(sum[grey ? 0 : c] / texels);
            p_.is_one[c] = one[grey ? 0 : c];
        }
        if (!p_.has_alpha()) return;
        p_.mean[3] = static_cast<float>(sum[n_ - 1] / texels);
        p_.is_one[3] = one[n_ - 1];
        weighted_ = weighted_ && !p_.is_one[3];
    }

    /// A row of level k, colours times their weight. Level 0 is decoded, the others are at hand in
    /// floats.
    void row(std::size_t k, const std::vector<float>& level, int y, float* out) const {
        const auto width = static_cast<std::size_t>(p_.levels[k].width);
        if (k > 0) {
            std::copy_n(level.data() + static_cast<std::size_t>(y) * width * n_, width * n_, out);
            return;
        }
        for (int x = 0; x < p_.levels[0].width; ++x) {
            float* texel = out + static_cast<std::size_t>(x) * n_;
            for (std::size_t c = 0; c < n_; ++c) texel[c] = value_at(at(0, x, y) + c, c);
            if (!weighted_) continue;
            for (std::size_t c = 0; c + 1 < n_; ++c) texel[c] *= texel[n_ - 1] + kAlphaFloor;
        }
    }

    /// Up to three texels of n that cover texel i of m, with the share each has in it.
    struct Cover {
        int first = 0;
        int count = 0;
        float share[3] = {0, 0, 0};
    };
    static Cover cover(int i, int n, int m) {
        const std::int64_t from = std::int64_t(i) * n, to = std::int64_t(i + 1) * n;  // in 1/m
        Cover c;
        c.first = static_cast<int>(from / m);
        for (std::int64_t t = c.first; t * m < to && c.count < 3; ++t) {
            const std::int64_t overlap = std::min(to, (t + 1) * m) - std::max(from, t * m);
            c.share[c.count++] = static_cast<float>(overlap) / static_cast<float>(n);
        }
        return c;
    }

    void shrink(std::size_t k, const std::vector<float>& above, std::vector<float>& below) const {
        const Pyramid::Level& a = p_.levels[k];
        const Pyramid::Level& b = p_.levels[k + 1];
        const std::size_t wide = static_cast<std::size_t>(a.width) * n_;
        std::vector<float> source(wide), blend(wide);
        std::vector<Cover> columns;
        for (int i = 0; i < b.width; ++i) columns.push_back(cover(i, a.width, b.width));
        below.assign(static_cast<std::size_t>(b.width) * static_cast<std::size_t>(b.height) * n_,
                     0.0f);
        float* out = below.data();
        for (int j = 0; j < b.height; ++j) {
            const Cover rows = cover(j, a.height, b.height);
            std::fill(blend.begin(), blend.end(), 0.0f);
            for (int r = 0; r < rows.count; ++r) {
                row(k, above, rows.first + r, source.data());
                for (std::size_t x = 0; x < wide; ++x) blend[x] += rows.share[r] * source[x];
            }
            for (const Cover& column : columns) {
                for (int t = 0; t < column.count; ++t) {
                    const float* from =
                        blend.data() + static_cast<std::size_t>(column.first + t) * n_;
                    for (std::size_t c = 0; c < n_; ++c) out[c] += column.share[t] * from[c];
                }
                out += n_;
            }
        }
    }

    void store(std::size_t k, const std::vector<float>& level) {
        const float* from = level.data();
        for (int y = 0; y < p_.levels[k].height; ++y)
            for (int x = 0; x < p_.levels[k].width; ++x, from += n_) {
                const float scale = weighted_ ? 1 / (from[n_ - 1] + kAlphaFloor) : 1.0f;
                for (std::size_t c = 0; c < n_; ++c)
                    put(at(k, x, y) + c, is_alpha(c) ? from[c] : from[c] * scale, is_alpha(c));
            }
    }

    Pyramid& p_;
    std::size_t n_ = 0;
    bool srgb_;
    bool weighted_;
    SrgbEncoder encode_;
};

/// A conversion may colour grey (a config's white point); then one channel is not enough.
bool grey_stays_grey(const std::string& space, const ColorSpaces& colors) {
    std::array<float, 12> ramp{0.1f, 0.1f, 0.1f, 0.4f, 0.4f, 0.4f, 0.7f, 0.7f, 0.7f, 1, 1, 1};
    colors.to_working(ramp, space);
    for (std::size_t i = 0; i < ramp.size(); i += 3) {
        const auto [low, high] = std::minmax({ramp[i], ramp[i + 1], ramp[i + 2]});
        if (!(high - low <= 1e-3f * high)) return false;  // half the precision of an 8-bit code
    }
    return true;
}

/// How the rows of a file become level 0.
struct Intake {
    int width = 0;
    std::size_t stride = 0;  // channels of the file
    ChannelPick pick;

    std::size_t texels(std::size_t values) const { return values / stride; }
    int x(std::size_t i) const { return static_cast<int>(i % static_cast<std::size_t>(width)); }
    int y(int y0, std::size_t i) const {
        return y0 + static_cast<int>(i / static_cast<std::size_t>(width));
    }
};

void take_bytes(const Intake& in, int y0, std::span<const std::uint8_t> rows, Builder& builder,
                Pyramid& p) {
    for (std::size_t i = 0; i < in.texels(rows.size()); ++i) {
        const std::size_t at = builder.at(0, in.x(i), in.y(y0, i));
        for (std::size_t c = 0; c < static_cast<std::size_t>(p.channels); ++c) {
            const int from = in.pick.from[c];
            p.bytes[at + c] =
                from < 0 ? std::uint8_t(0) : rows[i * in.stride + static_cast<std::size_t>(from)];
        }
    }
}

/// Floats are converted to the working space on the way; grey is spread for that.
void take_floats(const Intake& in, int y0, std::span<const float> rows, const std::string& space,
                 const ColorSpaces& colors, Builder& builder, Pyramid& p) {
    const std::size_t texels = in.texels(rows.size());
    const auto last = static_cast<std::size_t>(in.pick.count) - 1;
    const bool grey = last - (p.has_alpha() ? 1 : 0) == 0;
    std::vector<float> rgb(texels * 3);
    for (std::size_t i = 0; i < texels; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const int from = in.pick.from[grey ? 0 : c];
            const float v = from < 0 ? 0.0f : rows[i * in.stride + static_cast<std::size_t>(from)];
            if (!std::isfinite(v) && (c == 0 || !grey)) ++p.non_finite;
            rgb[i * 3 + c] = std::isfinite(v) ? v : 0.0f;
        }
    colors.to_working(rgb, space);
    const auto alpha = static_cast<std::size_t>(std::max(0, in.pick.from[last]));
    for (std::size_t i = 0; i < texels; ++i) {
        const std::size_t at = builder.at(0, in.x(i), in.y(y0, i));
        for (std::size_t c = 0; c < static_cast<std::size_t>(p.channels); ++c) {
            const bool is_alpha = builder.is_alpha(c);
            builder.put(at + c, is_alpha ? rows[i * in.stride + alpha] : rgb[i * 3 + c], is_alpha);
        }
    }
}

}  // namespace

ByteTables::ByteTables() {
    for (std::size_t i = 0; i < 256; ++i) {
        linear[i] = static_cast<float>(i) / 255;
        srgb[i] = srgb_to_linear(linear[i]);
    }
}

std::int64_t Pyramid::memory_bytes() const noexcept {
    return static_cast<std::int64_t>(bytes.capacity() + words.capacity() * sizeof(std::uint16_t) +
                                     levels.capacity() * sizeof(Level) + sizeof(Pyramid));
}

ChannelPick pick_channels(int file_channels, int alpha_channel) noexcept {
    if (file_channels == 1) return {{0, -1, -1, -1}, 1};
    if (file_channels == 2 && alpha_channel == 1) return {{0, 1, -1, -1}, 2};
    if (file_channels == 2) return {{0, 1, -1, -1}, 3};
    if (alpha_channel >= 3) return {{0, 1, 2, alpha_channel}, 4};
    return {{0, 1, 2, -1}, 3};
}

TexelType texel_type(PixelReader& reader, const std::string& color_space,
                     const ColorSpaces& colors) {
    const ImageInfo& info = reader.info();
    const bool data = is_data_name(color_space);
    if (info.is_float) return TexelType::half;
    if (info.bits == 8 && (data || colors.is_plain_srgb(color_space))) return TexelType::byte;
    return data ? TexelType::unorm16 : TexelType::half;
}

int stored_channels(PixelReader& reader, const std::string& color_space,
                    const ColorSpaces& colors) {
    const int picked = pick_channels(reader.info().channels, reader.alpha_channel()).count;
    const bool converted = texel_type(reader, color_space, colors) == TexelType::half;
    return picked < 3 && converted && !grey_stays_grey(color_space, colors) ? picked + 2 : picked;
}

std::int64_t pyramid_bytes(int width, int height, int channels, TexelType type) {
    std::int64_t texels = 0;
    for (const Pyramid::Level& l : pyramid_levels(width, height))
        texels += static_cast<std::int64_t>(l.texels());
    return texels * channels * (type == TexelType::byte ? 1 : 2);
}

Pyramid build_pyramid(PixelReader& reader, const std::string& color_space,
                      const ColorSpaces& colors, const ByteTables& tables) {
    const ImageInfo& info = reader.info();
    const ChannelPick pick = pick_channels(info.channels, reader.alpha_channel());
    Pyramid p;
    p.type = texel_type(reader, color_space, colors);
    p.channels = stored_channels(reader, color_space, colors);
    const bool srgb = p.type == TexelType::byte && !is_data_name(color_space);
    p.color_table = (srgb ? tables.srgb : tables.linear).data();
    p.alpha_table = tables.linear.data();

    Builder builder(p, srgb, !reader.premultiplied());
    builder.allocate(info.width, info.height);
    const Intake in{info.width, static_cast<std::size_t>(info.channels), pick};
    if (p.type == TexelType::byte)
        reader.read_bytes([&](int y, std::span<const std::uint8_t> rows) {
            take_bytes(in, y, rows, builder, p);
        });
    else
        reader.read_floats([&](int y, std::span<const float> rows) {
            take_floats(in, y, rows, color_space, colors, builder, p);
        });
    builder.finish();
    return p;
}

Pyramid constant_pyramid(const std::array<std::uint8_t, 3>& rgb, const ByteTables& tables) {
    Pyramid p;
    p.color_table = p.alpha_table = tables.linear.data();
    Builder builder(p, false, false);
    builder.allocate(1, 1);
    std::copy(rgb.begin(), rgb.end(), p.bytes.begin());
    builder.finish();
    return p;
}

}  // namespace tessera
