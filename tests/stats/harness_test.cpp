// The instruments themselves: known tail probabilities, and a chi-square test that says no when it
// must.
#include <doctest/doctest.h>

#include "renderer/core/warp.h"
#include "tests/support/sphere_chi_square.h"

using namespace tessera;

namespace {

Vec3d cosine_direction(Random& numbers) { return normalize(Vec3d(warp_cosine(numbers.pair()))); }

double p_of(double exponent, double scale) {
    SphereTest test;
    test.charts = {{{0, 0, 1}, true}, {{0, 0, -1}, true}};
    test.seed = 5;
    return sphere_chi_square(
               test, [](Random& n) { return std::optional(cosine_direction(n)); },
               [&](Vec3d w) {
                   return w.z > 0 ? scale * (exponent + 1) / (2 * 3.14159265358979) *
                                        std::pow(w.z, exponent)
                                  : 0.0;
               })
        .p;
}

}  // namespace

TEST_CASE("statistics: tail probabilities have their tabulated values") {
    CHECK(chi_square_p(3.841458821, 1) == doctest::Approx(0.05).epsilon(1e-7));
    CHECK(chi_square_p(18.30703805, 10) == doctest::Approx(0.05).epsilon(1e-7));
    CHECK(chi_square_p(2.155856481, 10) == doctest::Approx(0.995).epsilon(1e-7));
    CHECK(chi_square_p(553.1268089, 500) == doctest::Approx(0.05).epsilon(1e-6));
    CHECK(normal_p(1.959963985) == doctest::Approx(0.05).epsilon(1e-7));
    // Wallace's approximation is good to some thousandths of the tail.
    CHECK(student_p(2.131449546, 15) == doctest::Approx(0.05).epsilon(0.005));
    CHECK(student_p(4.072765, 15) == doctest::Approx(0.001).epsilon(0.02));
    CHECK(log_gamma(0.5) == doctest::Approx(0.5 * std::log(3.14159265358979)).epsilon(1e-12));
    CHECK(sidak_level(0.01, 1) == doctest::Approx(0.01));
    CHECK(1 - std::pow(1 - sidak_level(0.01, 300), 300) == doctest::Approx(0.01));
}

TEST_CASE("chi-square: accepts the right density and refuses one that is a little wrong") {
    CHECK(p_of(1, 1) > 0.01);
    CHECK(p_of(1.05, 1) < 1e-4);  // a slightly wrong shape
    CHECK(p_of(1, 0.97) < 1e-4);  // a factor: what is lacking counts as failed samples
    CHECK(p_of(1, 1.03) < 1e-4);
    CHECK(p_of(0, 1) < 1e-12);  // no cosine at all
}

TEST_CASE("chi-square: p-values of a right density are spread evenly") {
    // Forty seeds; the least and the greatest of forty even numbers lie in these bounds with chance
    // 0.999.
    double least = 1, most = 0;
    Mean mean;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SphereTest test;
        test.charts = {{{0.3, 0, 0.95}, false}};
        test.seed = seed * 977;
        test.samples = 1 << 13;
        test.rings = test.sectors = 6;
        const double p = sphere_chi_square(
                             test, [](Random& n) { return std::optional(cosine_direction(n)); },
                             [](Vec3d w) { return std::max(0.0, w.z / 3.14159265358979); })
                             .p;
        least = std::min(least, p), most = std::max(most, p);
        mean.add(p);
    }
    CHECK(least > 1e-5);
    CHECK(least < 0.17);
    CHECK(most > 0.83);
    CHECK(mean.mean() == doctest::Approx(0.5).epsilon(0.35));  // 4 sigma
}
