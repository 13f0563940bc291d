#pragma once
// Texture stores over small files, for tests.

#include <memory>
#include <string>
#include <vector>

#include "renderer/image/colour_space.h"
#include "renderer/image/texture.h"
#include "tests/support/tiff.h"

namespace tessera {

/// A store with one texture per description, all for the same use.
struct TestStore {
    ColorSpaces colors{"lin_rec709"};
    Problems problems;
    std::unique_ptr<TextureStore> store;

    void load(const std::vector<TextureDesc>& descs, TextureUse use = TextureUse::data,
              const TextureOptions& options = {}, Workers* workers = nullptr) {
        std::vector<TextureRequest> requests;
        for (const TextureDesc& desc : descs) requests.push_back({&desc, use});
        store = std::make_unique<TextureStore>(requests, colors, problems, workers, options);
    }
    const TextureStore* operator->() const { return store.get(); }
};

inline TextureDesc texture_of(const std::string& file,
                              TextureFilter filter = TextureFilter::trilinear,
                              Wrap wrap = Wrap::repeat) {
    TextureDesc desc;
    desc.file = file;
    desc.filter = filter;
    desc.wrap_u = desc.wrap_v = wrap;
    return desc;
}

/// Bytes without a pattern.
inline std::vector<std::uint8_t> noise_bytes(std::size_t count, std::uint32_t seed = 0) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t h = (static_cast<std::uint32_t>(i) + seed * 7919u) * 2654435761u;
        h ^= h >> 15;
        bytes.push_back(static_cast<std::uint8_t>(h * 2246822519u >> 24));
    }
    return bytes;
}

inline constexpr TextureFilter kTextureFilters[] = {
    TextureFilter::trilinear, TextureFilter::closest, TextureFilter::bilinear,
    TextureFilter::bicubic, TextureFilter::stochastic};
inline constexpr Wrap kWraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::black};

}  // namespace tessera
