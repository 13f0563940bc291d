// The loop's leaves, one at a time: sampling points, lobes, light sampling.

#include <benchmark/benchmark.h>

#include "materials/surface/openpbr.h"
#include "renderer/core/sampler.h"
#include "renderer/lights/light.h"

using namespace tessera;

namespace {

void sobol_pairs(benchmark::State& state) {
    std::uint32_t seeds[kLanes];
    for (int i = 0; i < kLanes; ++i) seeds[i] = pixel_seed(i & 3, i >> 2, 1);
    SamplePairs out;
    std::uint32_t index = 0;
    for (auto _ : state) {
        sample_pairs(seeds, index++, 3, out);
        benchmark::DoNotOptimize(out);
    }
    state.SetItemsProcessed(state.iterations() * kLanes);
}
BENCHMARK(sobol_pairs);

// A glossy plastic: two lobes made, evaluated and sampled.
void plastic_sample(benchmark::State& state) {
    SurfaceParams p;
    const Vec3f wo = normalize(Vec3f{0.3f, 0.1f, 0.8f});
    std::uint32_t index = 0;
    for (auto _ : state) {
        const LobeList lobes = openpbr_lobes(p, wo, true);
        const Vec2f u = sample_pair(7, index, 0), c = sample_pair(7, index++, 1);
        LobeSample s;
        benchmark::DoNotOptimize(lobes.sample(wo, u, c.x, s));
        benchmark::DoNotOptimize(s);
    }
}
BENCHMARK(plastic_sample);

void quad_light_sample(benchmark::State& state) {
    const Light light = make_quad_light({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, Color(1.0f), false);
    std::uint32_t index = 0;
    for (auto _ : state) {
        LightSample s;
        benchmark::DoNotOptimize(
            sample_light(light, {{0.2f, 1.0f, 0.1f}}, sample_pair(3, index++, 0), s));
        benchmark::DoNotOptimize(s);
    }
}
BENCHMARK(quad_light_sample);

}  // namespace
