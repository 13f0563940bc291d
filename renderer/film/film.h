#pragma once
// Samples to layers. Tiles own disjoint pixels and write straight into the film: no locks, no
// merging.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/core/light_event.h"
#include "renderer/core/ray.h"
#include "renderer/core/sum.h"
#include "renderer/core/vec.h"
#include "renderer/core/zeroed.h"
#include "renderer/film/beauty.h"
#include "renderer/film/deep_pixels.h"
#include "renderer/film/film_extras.h"
#include "renderer/film/id_coverage.h"
#include "renderer/film/pass.h"

namespace tessera {

class Workers;

/// What the first surface of a path gives to the passes.
struct FirstHit {
    bool hit = false;  // else nothing below but the albedo is there
    bool has_uv = false;
    float z = 0;    // camera-space depth
    Vec3f p, pref;  // in the world, in the object's own space
    Vec3f n, ng;    // facing the camera
    Vec2f uv;
    float facing = 0;
    float ao = 1;                                       // 1: open
    std::uint32_t object = 0, material = 0, asset = 0;  // keys of names, plus 1; 0: none
    Color albedo{0.0f};
    Color shadowed{0.0f}, unshadowed{0.0f};  // light of lamps that is kept off; all of it
};

/// What a block's samples give beyond beauty. Of one worker, cleared for every block.
struct PassSamples {
    FirstHit first[kLanes];
    std::vector<Color> light;          // of the passes of light paths: [pass * kLanes + lane]
    std::vector<Color> event_albedos;  // [event * kLanes + lane]
    float seconds[kLanes]{};

    void clear();
};

class Film {
public:
    static constexpr float kEmptyDepth = 1e10f;

    Film(const PixelWindow& window, Passes passes, FilmExtras extras = {});

    const PixelWindow& window() const noexcept { return window_; }
    const Passes& passes() const noexcept { return passes_; }
    /// Whether add() takes PassSamples.
    bool takes_passes() const noexcept { return !passes_.empty() || deep_; }
    /// A worker's place for what the passes take.
    PassSamples pass_samples() const;
    /// x, y absolute in the frame, within the window. One thread at a time per pixel. passes: null
    /// for beauty alone; index: of the sample.
    void add(int x, int y, std::uint32_t index, const PathSample& s, const PassSamples* passes,
             int lane) noexcept;
    /// What tells the error by a second rendering; null if that is not wanted.
    Probes* probes() noexcept { return beauty_.probes(); }
    /// Samples that the pixel has.
    std::uint32_t samples(int x, int y) const noexcept { return counts()[pixel(x, y)].total(); }
    /// Adds a film of the same passes whose window lies within this one; the bits of the sum do not
    /// depend on the order.
    void merge(const Film& other);
    /// Means of what was added; of coverage by names there is none.
    std::vector<Layer> layers(Workers& workers) const;
    /// The same of a part of the window; other threads may add outside it.
    std::vector<Layer> layers(const PixelWindow& part) const;
    /// What a pass of names counted; null for the others.
    IdCoverage* coverage(std::size_t pass) noexcept {
        return planes_[pass].coverage ? &*planes_[pass].coverage : nullptr;
    }
    /// Empty unless they are kept.
    ReplicateView replicates() const noexcept { return beauty_.replicates(); }
    const DeepPixels* deep() const noexcept { return deep_ ? &*deep_ : nullptr; }
    /// Depths that go with what arrays() holds already; false if they do not.
    bool take_deep(const DeepPixelsState& state);
    /// Of what arrays() was filled with: whether samples can be added to it.
    bool counts_make_sense() const noexcept { return beauty_.counts_make_sense(); }
    /// Counts and samples; the rest is the caller's.
    DeepImage deep_image() const;
    /// Samples of all pixels.
    std::vector<std::uint32_t> sample_counts() const;
    std::size_t bytes() const noexcept;
    /// Of a film before it is made: edges of things and depths will add to it.
    static std::uint64_t expected_bytes(const PixelWindow& window, const Passes& passes,
                                        FilmExtras extras);

    /// All that the film holds but coverage and depths, as named arrays of plain numbers: what a
    /// checkpoint saves.
    struct Array {
        std::string name;
        std::span<std::byte> bytes;
    };
    std::vector<Array> arrays();
    /// Names and sizes of the arrays of a film that is not there yet.
    struct ArraySize {
        std::string name;
        std::uint64_t bytes = 0;
    };
    static std::vector<ArraySize> array_sizes(const PixelWindow& window, const Passes& passes,
                                              FilmExtras extras);

private:
    struct Nearest {
        float z = kInfinity;
        std::uint32_t sample = 0;  // of equally near ones the first
    };
    // One pass: sums or the nearest sample's values, channels interleaved; none where beauty's
    // counts say it all.
    struct Plane {
        PassSource source = {};
        std::uint32_t events = 0;  // of the pass
        std::uint32_t width = 0;   // numbers a pixel
        ZeroedArray<Sum> sums;
        ZeroedArray<float> nearest;
        std::optional<IdCoverage> coverage;
    };
    std::size_t pixel(int x, int y) const noexcept {
        return std::size_t(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
               static_cast<std::size_t>(x - window_.x0);
    }
    void add_passes(std::size_t i, std::uint32_t index, const PathSample& s,
                    const PassSamples& passes, int lane) noexcept;
    std::vector<Layer> outline() const;
    void put_row(const PixelWindow& part, int y, double calibration,
                 std::vector<Layer>& layers) const;
    void put_pixel(const Pass& pass, const Plane& plane, std::size_t i, float* out) const;
    std::span<const PixelCounts> counts() const noexcept { return beauty_.counts(); }

    PixelWindow window_;
    Passes passes_;
    Beauty beauty_;
    std::vector<Nearest> nearest_;
    std::vector<Plane> planes_;  // as passes_
    std::optional<DeepPixels> deep_;
    int light_passes_ = 0;
    bool event_albedos_ = false;
};

}  // namespace tessera
