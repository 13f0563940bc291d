#include "materials/lobe_block.h"

#include <doctest/doctest.h>

#include <bit>

#include "materials/surface/openpbr.h"
#include "tests/support/random.h"

namespace tessera {
namespace {

Vec3f upper(Random& n) {
    Vec3d w = n.direction();
    w.z = std::fabs(w.z) + 1e-2;
    return Vec3f(normalize(w));
}

SurfaceParams any_surface(Random& n) {
    SurfaceParams p;
    p.base_color = {n.unit(), n.unit(), n.unit()};
    const auto rarely = [&] { return n.unit() < 0.5f ? 0.0f : n.unit(); };
    p.base_metalness = rarely();
    p.transmission_weight = rarely();
    p.specular_roughness = rarely();
    p.specular_roughness_anisotropy = rarely();
    p.specular_ior = n.between(1.0f, 2.0f);
    p.thin_walled = n.unit() < 0.2f;
    return p;
}

bool same(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same(Vec3f a, Vec3f b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }

}  // namespace

TEST_CASE("lobes: a lane's sample and value do not depend on the lanes asked for with it") {
    Random n(5);
    int made = 0, none = 0;
    for (int round = 0; round < 200; ++round) {
        AllLobes lobes;
        Vec3Lanes wi;
        SamplePairs u;
        float choice[kLanes];
        lobes.clear();
        for (int i = 0; i < kLanes; ++i) {
            lobes.wo.set(i, upper(n));
            View view;
            view.front = n.unit() < 0.7f;
            openpbr_lobes(Surface(any_surface(n)), view, i, lobes);
            wi.set(i, Vec3f(n.direction()));
            u.x[i] = n.unit(), u.y[i] = n.unit();
            choice[i] = n.unit();
        }
        lobes.prepare();
        LobeSamples all;
        const LaneMask ok = lobes.sample(kAllLanes, u, choice, all);
        AllLobes values = lobes;
        values.eval(kAllLanes, wi);
        for (int i = 0; i < kLanes; ++i) {
            LobeSamples one;
            const LaneMask bit = 1u << i;
            const LaneMask got = lobes.sample(bit, u, choice, one);
            REQUIRE(got == (ok & bit));
            ++(got ? made : none);
            if (got) {
                REQUIRE(same(one.wi[i], all.wi[i]));
                REQUIRE(same(one.weight[i], all.weight[i]));
                REQUIRE(same(one.pdf[i], all.pdf[i]));
                REQUIRE(same(one.eta[i], all.eta[i]));
                REQUIRE(same(one.spread[i], all.spread[i]));
                REQUIRE(one.cls[i] == all.cls[i]);
            }
            lobes.eval(bit, wi);
            REQUIRE(same(lobes.f(i), values.f(i)));
            REQUIRE(same(lobes.pdf(i), values.pdf(i)));
        }
    }
    CHECK(made > 2500);
    CHECK(none > 10);
}

TEST_CASE("lobes: a kernel without glass gives the bits of the one that has it") {
    Random n(6);
    for (int round = 0; round < 200; ++round) {
        AllLobes all;
        OpaqueLobes opaque;
        SamplePairs u;
        float choice[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            SurfaceParams p = any_surface(n);
            p.transmission_weight = 0;
            const Vec3f wo = upper(n);
            all.wo.set(i, wo);
            opaque.wo.set(i, wo);
            openpbr_lobes(Surface(p), View{}, i, all);
            openpbr_lobes(Surface(p), View{}, i, opaque);
            u.x[i] = n.unit(), u.y[i] = n.unit();
            choice[i] = n.unit();
        }
        all.prepare();
        opaque.prepare();
        LobeSamples a, b;
        const LaneMask lanes = all.sample(kAllLanes, u, choice, a);
        REQUIRE(lanes == opaque.sample(kAllLanes, u, choice, b));
        for (int i = 0; i < kLanes; ++i) {
            if (((lanes >> i) & 1u) == 0) continue;
            REQUIRE(same(a.wi[i], b.wi[i]));
            REQUIRE(same(a.weight[i], b.weight[i]));
            REQUIRE(same(a.pdf[i], b.pdf[i]));
        }
    }
}

TEST_CASE("lobes: what was pushed before is gone after clear, and weights of nothing are none") {
    AllLobes lobes;
    lobes.wo.set(3, {0, 0, 1});
    lobes.push(3, DiffuseLobe{}, Color(0.5f));
    lobes.push(3, SmoothReflection<MetalFresnel>{}, Color(0.5f));
    CHECK(lobes.extended() == 8u);
    CHECK(lobes.smooth() == 8u);
    CHECK(lobes.albedo(3).x == doctest::Approx(1));
    CHECK(lobes.weight<DiffuseLobe>(3) == Color(0.5f));
    lobes.clear();
    lobes.push(3, DiffuseLobe{}, Color(0.0f));
    lobes.prepare();
    CHECK(lobes.extended() == 0u);
    CHECK(lobes.smooth() == 0u);
    CHECK(lobes.albedo(3) == Color(0.0f));
    LobeSamples out;
    const float choice[kLanes] = {};
    CHECK(lobes.sample(kAllLanes, SamplePairs{}, choice, out) == 0u);
}

}  // namespace tessera
