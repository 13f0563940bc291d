#include "renderer/image/pyramid.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include "renderer/image/colour_names.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/pixel_reader.h"
#include "renderer/image/row_reducer.h"

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

/// Mean and constant channels of rows as they come.
class Survey {
public:
    explicit Survey(std::size_t channels) : n_(channels) {}

    void add(std::span<const float> row) {
        texels_ += row.size() / n_;
        for (std::size_t i = 0; i < row.size(); i += n_)
            for (std::size_t c = 0; c < n_; ++c) {
                sum_[c] += static_cast<double>(row[i + c]);
                one_[c] = one_[c] && row[i + c] == 1.0f;
            }
    }

    void tell(Pyramid& p) const {
        const auto mean = [&](std::size_t c) {
            return static_cast<float>(sum_[c] / static_cast<double>(texels_));
        };
        const bool grey = n_ < 3;
        for (std::size_t c = 0; c < 3; ++c) {
            p.mean[c] = mean(grey ? 0 : c);
            p.is_one[c] = one_[grey ? 0 : c];
        }
        if (!p.has_alpha()) return;
        p.mean[3] = mean(n_ - 1);
        p.is_one[3] = one_[n_ - 1];
    }

private:
    std::size_t n_, texels_ = 0;
    std::array<double, 4> sum_{};
    std::array<bool, 4> one_{true, true, true, true};
};

/// Fills a pyramid: level 0 from rows of a file, the rest from what was stored.
class Builder {
public:
    Builder(Pyramid& out, bool srgb, bool weighted)
        : p_(out), srgb_(srgb), weighted_(weighted && out.has_alpha()) {
        n_ = static_cast<std::size_t>(p_.channels);
    }

    /// Room for a picture of this size and all levels below it, or for no more than the picture.
    void allocate(int width, int height, bool levels = true) {
        p_.levels = pyramid_levels(width, height);
        if (!levels) p_.levels.resize(1);
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

    /// Row y of level 0, decoded; n floats a texel.
    std::span<float> decoded_row(int y) {
        row_.resize(static_cast<std::size_t>(p_.levels[0].width) * n_);
        float* texel = row_.data();
        for (int x = 0; x < p_.levels[0].width; ++x, texel += n_)
            for (std::size_t c = 0; c < n_; ++c) texel[c] = value_at(at(0, x, y) + c, c);
        return row_;
    }

    /// Colours times their weight, as the rows of coarser levels are.
    void weigh(std::span<float> row) const {
        if (!weighted_) return;
        for (float* texel = row.data(); texel != row.data() + row.size(); texel += n_)
            for (std::size_t c = 0; c + 1 < n_; ++c) texel[c] *= texel[n_ - 1] + kAlphaFloor;
    }

    void store_row(std::size_t k, int y, std::span<const float> row) {
        const float* from = row.data();
        for (int x = 0; x < p_.levels[k].width; ++x, from += n_) {
            const float scale = weighted_ ? 1 / (from[n_ - 1] + kAlphaFloor) : 1.0f;
            for (std::size_t c = 0; c < n_; ++c)
                put(at(k, x, y) + c, is_alpha(c) ? from[c] : from[c] * scale, is_alpha(c));
        }
    }

    /// Mean and constant channels of level 0, then the other levels.
    void finish() {
        Survey survey(n_);
        for (int y = 0; y < p_.levels[0].height; ++y) survey.add(decoded_row(y));
        survey.tell(p_);
        weighted_ = weighted_ && !p_.is_one[3];
        RowReducer reducer(p_.levels, n_, [&](std::size_t k, int y, std::span<const float> row) {
            store_row(k, y, row);
        });
        for (int y = 0; y < p_.levels[0].height; ++y) {
            const std::span<float> row = decoded_row(y);
            weigh(row);
            reducer.push(row);
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

    Pyramid& p_;
    std::size_t n_ = 0;
    bool srgb_;
    bool weighted_;
    SrgbEncoder encode_;
    std::vector<float> row_;
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

std::int64_t pyramid_bytes(int width, int height, int channels, TexelType type, int skip) {
    const std::vector<Pyramid::Level> levels = pyramid_levels(width, height);
    std::int64_t texels = 0;
    for (std::size_t k = static_cast<std::size_t>(skip); k < levels.size(); ++k)
        texels += static_cast<std::int64_t>(levels[k].texels());
    return texels * channels * (type == TexelType::byte ? 1 : 2);
}

Pyramid build_pyramid(PixelReader& reader, const std::string& color_space,
                      const ColorSpaces& colors, const ByteTables& tables, int skip) {
    const ImageInfo& info = reader.info();
    Pyramid p;
    p.type = texel_type(reader, color_space, colors);
    p.channels = stored_channels(reader, color_space, colors);
    const bool srgb = p.type == TexelType::byte && !is_data_name(color_space);
    p.color_table = (srgb ? tables.srgb : tables.linear).data();
    p.alpha_table = tables.linear.data();
    const Intake in{info.width, static_cast<std::size_t>(info.channels),
                    pick_channels(info.channels, reader.alpha_channel())};
    const auto read = [&](const auto& to) {
        if (p.type == TexelType::byte)
            reader.read_bytes(to);
        else
            reader.read_floats(to);
    };
    const auto take = [&](int y, const auto& rows, Builder& builder, Pyramid& into) {
        if constexpr (std::is_same_v<decltype(rows[0]), const std::uint8_t&>)
            take_bytes(in, y, rows, builder, into);
        else
            take_floats(in, y, rows, color_space, colors, builder, into);
    };

    Pyramid strip = p;
    Builder builder(p, srgb, !reader.premultiplied());
    const std::vector<Pyramid::Level> levels = pyramid_levels(info.width, info.height);
    const auto finest = static_cast<std::size_t>(skip);
    builder.allocate(levels[finest].width, levels[finest].height);
    if (skip == 0) {
        read([&](int y, auto rows) { take(y, rows, builder, p); });
        builder.finish();
        return p;
    }
    // A strip at a time, stored and decoded as level 0 would have been.
    Builder taken(strip, srgb, !reader.premultiplied());
    Survey survey(static_cast<std::size_t>(p.channels));
    RowReducer reducer(levels, static_cast<std::size_t>(p.channels),
                       [&](std::size_t k, int y, std::span<const float> row) {
                           if (k >= finest) builder.store_row(k - finest, y, row);
                       });
    read([&](int, auto rows) {
        const auto count = static_cast<int>(in.texels(rows.size())) / info.width;
        taken.allocate(info.width, count, false);
        take(0, rows, taken, strip);
        for (int y = 0; y < count; ++y) {
            const std::span<float> row = taken.decoded_row(y);
            survey.add(row);
            taken.weigh(row);
            reducer.push(row);
        }
    });
    survey.tell(p);
    p.non_finite = strip.non_finite;
    p.clamped = strip.clamped;
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
