#include "renderer/image/tile_cache.h"

#include <OpenImageIO/texture.h>

#include <cmath>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/image_format.h"
#include "renderer/image/pyramid.h"

namespace tessera {
namespace {

constexpr float kCacheMib = 512;
constexpr float kMagenta[4] = {1, 0, 1, 1};

OIIO::TextureOpt::Wrap wrap_of(Wrap wrap) noexcept {
    switch (wrap) {
        case Wrap::repeat:
            return OIIO::TextureOpt::WrapPeriodic;
        case Wrap::clamp:
            return OIIO::TextureOpt::WrapClamp;
        case Wrap::mirror:
            return OIIO::TextureOpt::WrapMirror;
        case Wrap::black:
            return OIIO::TextureOpt::WrapBlack;
    }
    return OIIO::TextureOpt::WrapPeriodic;
}

Texel spread(const float (&value)[4], int channels) noexcept {
    switch (channels) {
        case 1:
            return {value[0], value[0], value[0], 1};
        case 2:
            return {value[0], value[0], value[0], value[1]};
        case 3:
            return {value[0], value[1], value[2], 1};
        default:
            return {value[0], value[1], value[2], value[3]};
    }
}

}  // namespace

struct TileCache::Impl {
    struct Entry {
        OIIO::TextureSystem::TextureHandle* handle = nullptr;
        int channels = 3;
        bool srgb = false;
    };
    struct Destroy {
        void operator()(OIIO::TextureSystem* owned) const {
            OIIO::TextureSystem::destroy(owned, true);
        }
    };
    std::unique_ptr<OIIO::TextureSystem, Destroy> system{OIIO::TextureSystem::create(false)};
    std::vector<Entry> entries;
};

TileCache::TileCache() : impl_(std::make_unique<Impl>()) {
    OIIO::TextureSystem& system = *impl_->system;
    system.attribute("max_memory_MB", kCacheMib);
    system.attribute("autotile", 64);
    system.attribute("automip", 1);
    system.attribute("accept_untiled", 1);
    system.attribute("accept_unmipped", 1);
    system.attribute("unassociatedalpha", 1);  // values as stored
}

TileCache::~TileCache() = default;

int TileCache::add(const std::string& path, int channels, bool srgb) {
    auto* handle = impl_->system->get_texture_handle(OIIO::ustring(path));
    if (!handle || !impl_->system->good(handle))
        fail_image(path, "the texture system refused it: " + impl_->system->geterror());
    impl_->entries.push_back({handle, channels, srgb});
    return static_cast<int>(impl_->entries.size()) - 1;
}

Texel TileCache::sample(int handle, float u, float v, float width_u, float width_v, Wrap wrap_u,
                        Wrap wrap_v) const noexcept {
    const Impl::Entry& entry = impl_->entries[static_cast<std::size_t>(handle)];
    float value[4] = {0, 0, 0, 0};
    try {
        OIIO::TextureOpt options;
        options.swrap = wrap_of(wrap_u);
        options.twrap = wrap_of(wrap_v);
        options.mipmode = OIIO::TextureOpt::MipModeTrilinear;
        options.interpmode = OIIO::TextureOpt::InterpBilinear;
        options.missingcolor = kMagenta;
        if (!impl_->system->texture(entry.handle, nullptr, options, fold(u, wrap_u),
                                    1 - fold(v, wrap_v), width_u, 0, 0, width_v, entry.channels,
                                    value)) {
            static_cast<void>(impl_->system->geterror());  // else it grows with every look-up
            return {1, 0, 1, 1};
        }
    } catch (...) {
        return {1, 0, 1, 1};
    }
    Texel texel = spread(value, entry.channels);
    for (std::size_t c = 0; c < 4; ++c) {
        if (!std::isfinite(texel[c])) texel[c] = 0;
        if (entry.srgb && c < 3) texel[c] = srgb_to_linear(texel[c]);
    }
    return texel;
}

Texel TileCache::mean(int handle) const noexcept {
    constexpr int kGrid = 16;
    constexpr float kStep = 1.0f / kGrid;
    Texel sum{0, 0, 0, 0};
    for (int j = 0; j < kGrid; ++j)
        for (int i = 0; i < kGrid; ++i) {
            const Texel t = sample(handle, (static_cast<float>(i) + 0.5f) * kStep,
                                   (static_cast<float>(j) + 0.5f) * kStep, kStep, kStep,
                                   Wrap::clamp, Wrap::clamp);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += t[c] * kStep * kStep;
        }
    return sum;
}

std::int64_t TileCache::memory_bytes() const noexcept {
    long long bytes = 0;
    impl_->system->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &bytes);
    return bytes;
}

}  // namespace tessera
