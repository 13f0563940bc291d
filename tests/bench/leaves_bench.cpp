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

// A glossy plastic at sixteen points: two lobes made, evaluated and sampled.
void plastic_sample(benchmark::State& state) {
    const Surface plastic{SurfaceParams()};
    OpaqueLobes lobes;
    std::uint32_t seeds[kLanes] = {7}, index = 0;
    for (auto _ : state) {
        lobes.clear();
        for (int i = 0; i < kLanes; ++i) {
            lobes.wo.set(i, normalize(Vec3f{0.3f, 0.1f, 0.8f}));
            openpbr_lobes(plastic, View{}, i, lobes);
        }
        lobes.prepare();
        SamplePairs u, c;
        sample_pairs(seeds, index, 0, u);
        sample_pairs(seeds, index++, 1, c);
        LobeSamples out;
        benchmark::DoNotOptimize(lobes.sample(kAllLanes, u, c.x, out));
        benchmark::DoNotOptimize(out);
    }
    state.SetItemsProcessed(state.iterations() * kLanes);
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
