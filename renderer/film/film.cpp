#include "renderer/film/film.h"

#include <algorithm>

namespace tessera {
namespace {

template <class T>
std::size_t capacity_bytes(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

}  // namespace

bool enable_layer(const std::string& name, FilmLayers& layers) {
    if (name == "beauty") return true;
    if (name == "Z") return layers.z = true;
    if (name == "N") return layers.n = true;
    if (name == "P") return layers.p = true;
    if (name == "albedo") return layers.albedo = true;
    return false;
}

std::vector<std::string> layer_names() { return {"beauty", "Z", "N", "P", "albedo"}; }

Film::Film(const PixelWindow& window, const FilmLayers& layers)
    : window_(window), enabled_(layers) {
    const std::size_t n = std::size_t(window.width()) * window.height();
    beauty_.resize(n);
    if (layers.albedo) albedo_.resize(n);
    if (layers.n) normal_.resize(n);
    if (layers.z || layers.p) depth_.resize(n, kEmptyDepth);
    if (layers.p) position_.resize(n);
}

void Film::add(int x, int y, const PathSample& s) noexcept {
    const std::size_t i = std::size_t(y - window_.y0) * window_.width() + (x - window_.x0);
    Beauty& b = beauty_[i];
    b.r += static_cast<double>(s.radiance.x);
    b.g += static_cast<double>(s.radiance.y);
    b.b += static_cast<double>(s.radiance.z);
    b.a += static_cast<double>(s.alpha);
    ++b.samples;
    if (!s.hit) return;
    if (enabled_.albedo) albedo_[i].add(s.albedo);
    if (enabled_.n) normal_[i].add(s.n);
    if (!depth_.empty() && s.z < depth_[i]) {
        depth_[i] = s.z;
        if (enabled_.p) position_[i] = s.p;
    }
}

std::vector<Layer> Film::layers(const PixelWindow& part) const {
    const std::size_t n = std::size_t(part.width()) * part.height();
    const auto each_pixel = [&](const auto& body) {
        std::size_t to = 0;
        for (int y = part.y0; y < part.y1; ++y) {
            std::size_t from =
                std::size_t(y - window_.y0) * window_.width() + (part.x0 - window_.x0);
            for (int x = part.x0; x < part.x1; ++x) body(to++, from++);
        }
    };
    std::vector<Layer> out;
    Layer beauty{"", {"R", "G", "B", "A"}, LayerKind::color, std::vector<float>(n * 4)};
    each_pixel([&](std::size_t to, std::size_t from) {
        const Beauty& b = beauty_[from];
        const double w = b.samples > 0 ? 1.0 / b.samples : 0.0;
        float* p = &beauty.pixels[to * 4];
        p[0] = static_cast<float>(b.r * w), p[1] = static_cast<float>(b.g * w);
        p[2] = static_cast<float>(b.b * w), p[3] = static_cast<float>(b.a * w);
    });
    out.push_back(std::move(beauty));
    if (enabled_.z) {
        Layer layer{"", {"Z"}, LayerKind::data, std::vector<float>(n)};
        each_pixel([&](std::size_t to, std::size_t from) { layer.pixels[to] = depth_[from]; });
        out.push_back(std::move(layer));
    }
    const auto mean = [&](const char* name, std::vector<std::string> channels, LayerKind kind,
                          const std::vector<Triple>& sums) {
        Layer layer{name, std::move(channels), kind, std::vector<float>(n * 3)};
        each_pixel([&](std::size_t to, std::size_t from) {
            // Colour is premultiplied by coverage as beauty is; data is the mean over what was hit.
            const double count = kind == LayerKind::color ? beauty_[from].samples : beauty_[from].a;
            const double w = count > 0 ? 1.0 / count : 0.0;
            layer.pixels[to * 3] = static_cast<float>(sums[from].x * w);
            layer.pixels[to * 3 + 1] = static_cast<float>(sums[from].y * w);
            layer.pixels[to * 3 + 2] = static_cast<float>(sums[from].z * w);
            // Albedo is a colour of at most 1; single samples of it may be more.
            for (std::size_t c = 0; kind == LayerKind::color && c < 3; ++c) {
                layer.pixels[to * 3 + c] = std::min(layer.pixels[to * 3 + c], 1.0f);
            }
        });
        out.push_back(std::move(layer));
    };
    if (enabled_.n) mean("N", {"X", "Y", "Z"}, LayerKind::data, normal_);
    if (enabled_.p) {
        Layer layer{"P", {"X", "Y", "Z"}, LayerKind::data, std::vector<float>(n * 3)};
        each_pixel([&](std::size_t to, std::size_t from) {
            float* p = &layer.pixels[to * 3];
            p[0] = position_[from].x, p[1] = position_[from].y, p[2] = position_[from].z;
        });
        out.push_back(std::move(layer));
    }
    if (enabled_.albedo) mean("albedo", {"R", "G", "B"}, LayerKind::color, albedo_);
    return out;
}

std::size_t Film::bytes() const noexcept {
    return capacity_bytes(beauty_) + capacity_bytes(albedo_) + capacity_bytes(normal_) +
           capacity_bytes(depth_) + capacity_bytes(position_);
}

}  // namespace tessera
