#include "renderer/film/mattes.h"

#include <doctest/doctest.h>

#include <bit>
#include <set>

#include "renderer/core/murmur3.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

Passes crypto_passes() { return choose_passes({"cryptomatte", "Z"}, {"default"}, {}); }

void add_samples(Film& film, std::uint32_t first, std::uint32_t last) {
    PassSamples passes = film.pass_samples();
    for (std::uint32_t index = first; index < last; ++index) {
        for (int x = 0; x < 4; ++x) {
            passes.clear();
            const std::uint32_t drawn = (index * 2654435761u + static_cast<std::uint32_t>(x)) >> 20;
            passes.first[0].hit = drawn % 5 != 0;
            if (passes.first[0].hit) {
                passes.first[0].object = 1 + drawn % 7;
                passes.first[0].material = 1 + drawn % 3;
                passes.first[0].asset = 1 + drawn % 400;
            }
            film.add(x, 0, index, {Color(1.0f), passes.first[0].hit ? 1.0f : 0.0f}, &passes, 0);
        }
    }
}

// Nine spheres in a pixel.
SceneDesc crowd() {
    SceneDesc scene;
    const int material = add(scene, matte(0.5f));
    for (int i = 0; i < 9; ++i) {
        add_sphere(scene, {i % 3 - 1.0, i / 3 - 1.0, 0}, 0.4, material);
        scene.spheres.back().name = "ball " + std::to_string(i);
    }
    set_film(scene, 1, 1, 256);
    look(scene, {0, 0, 10}, {0, 0, 0}, 20);
    return scene;
}

}  // namespace

TEST_CASE("mattes: films of ranges merged in any order count what one film counts") {
    const PixelWindow window{0, 0, 4, 1};
    Film whole(window, crypto_passes()), a(window, crypto_passes()), b(window, crypto_passes());
    add_samples(whole, 0, 3000);
    add_samples(a, 0, 1100);
    add_samples(b, 1100, 3000);
    Film ab(window, crypto_passes()), ba(window, crypto_passes());
    ab.merge(a), ab.merge(b);
    ba.merge(b), ba.merge(a);
    for (std::size_t p = 0; p < 3; ++p) {
        CHECK(ab.coverage(p)->state() == whole.coverage(p)->state());
        CHECK(ba.coverage(p)->state() == whole.coverage(p)->state());
    }
    CHECK(whole.coverage(2)->dropped(0) > 0);  // of 400 assets not all are counted
    CHECK(whole.coverage(3) == nullptr);       // Z
    CHECK(whole.sample_counts() == std::vector<std::uint32_t>(4, 3000));
}

TEST_CASE("mattes: a crowded pixel holds its six largest names and a note of the rest") {
    SceneDesc desc = crowd();
    desc.film.aovs = {"CryptoObject"};
    const ScenePtr scene = build_scene(std::move(desc));
    const RenderResult result = render(*scene);
    REQUIRE(result.image.layers.size() == 4);
    std::set<std::uint32_t> known, found;
    for (int i = 0; i < 9; ++i) known.insert(cryptomatte_id("ball " + std::to_string(i)));
    for (std::size_t l = 1; l < 4; ++l) {
        const std::vector<float>& p = result.image.layers[l].pixels;
        found.insert({std::bit_cast<std::uint32_t>(p[0]), std::bit_cast<std::uint32_t>(p[2])});
    }
    CHECK(found.size() == 6);
    for (const std::uint32_t id : found) CHECK(known.contains(id));
    REQUIRE(result.stats.notes.size() >= 1);
    CHECK(result.stats.notes.back().starts_with("CryptoObject: 1 pixels see more than 6 names, "));
}

TEST_CASE("mattes: numbers of objects and materials are those of their names, from 1") {
    SceneDesc desc = crowd();
    desc.spheres[4].radius = 0.5;  // the largest, in the middle
    desc.film.aovs = {"object_id", "material_id"};
    look_at_point(desc, {0, 0, 10}, {0, 0, 0});
    const ScenePtr scene = build_scene(std::move(desc));
    const RenderResult result = render(*scene);
    REQUIRE(result.image.layers.size() == 3);
    CHECK(result.image.layers[1].pixels[0] == 1.0f);
    CHECK(result.image.layers[2].pixels[0] == 1.0f);
    CHECK(result.image.metadata.empty());
}
