// A render in pieces has the bits of one in one piece.
#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <optional>

#include "renderer/film/film_file.h"
#include "renderer/integrator/checkpoints.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr int kSpp = 48;

ScenePtr scene(int spp = kSpp, std::uint64_t seed = 0) {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.7f))));
    add_sphere(s, {0, 0.5, 0}, 0.5, add(s, glass(0.1f)));
    add_sky(s, {0.3f, 0.4f, 0.5f});
    look(s, {0, 1.6, 5}, {0, 0.6, 0}, 45);
    set_film(s, 37, 22, spp);
    s.film.aovs = {"compositing", "lookdev", "cryptomatte", "P", "uv", "variance", "sample_count"};
    s.render.seed = seed;
    return build_scene(std::move(s));
}

std::vector<Layer> layers_of(const Scene& s, const RenderSettings& settings) {
    return render(s, settings).image.layers;
}

bool same(const std::vector<Layer>& a, const std::vector<Layer>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].name != b[i].name || a[i].pixels != b[i].pixels) return false;
    return true;
}

bool same(const DeepImage& a, const DeepImage& b) {
    return a.counts == b.counts && a.samples == b.samples;
}

}  // namespace

TEST_CASE(
    "resume: stopped in the middle of passes again and again, the bits are those of one run") {
    const TempFolder folder;
    const ScenePtr s = scene();
    RenderSettings settings;
    settings.deep = true;
    const RenderResult straight = render(*s, settings);
    const std::string file = folder / "c.tsf";
    settings.checkpoint = file;
    settings.tile = 8;
    RenderResult result;
    int runs = 0;
    do {
        std::atomic<bool> cancel{false};
        std::atomic<int> tiles{0};
        settings.cancel = &cancel;
        settings.threads = 1 + runs % 3;
        settings.on_tile = [&](const PixelWindow&, const std::vector<Layer>&) {
            if (++tiles == 17) cancel = true;
        };
        result = render(*s, settings);
        settings.resume = file;
        ++runs;
    } while (!result.complete && runs < 100);
    CHECK(runs > 3);
    CHECK(result.complete);
    CHECK(same(result.image.layers, straight.image.layers));
    CHECK(same(*result.deep, *straight.deep));
}

TEST_CASE("resume: a film file of fewer samples goes on to more, alone or from a later sample") {
    const TempFolder folder;
    RenderSettings first;
    first.film_file = folder / "a.tsf";
    render(*scene(5), first);
    RenderSettings more;
    more.resume = first.film_file;
    const RenderResult result = render(*scene(), more);
    CHECK(same(result.image.layers, layers_of(*scene(), {})));
    CHECK(result.stats.resumed_spp == 5);
    CHECK(result.stats.resumed_s > 0);
    CHECK(result.stats.spp == kSpp);
    CHECK(result.stats.samples == 37u * 22 * (kSpp - 5));

    first.first_sample = 7;
    render(*scene(3), first);
    CHECK(read_film_header(first.film_file).first_sample == 7);
    CHECK_THROWS_AS(render(*scene(), more), Error);  // from 0
    more.first_sample = 7;
    RenderSettings later;
    later.first_sample = 7;
    CHECK(same(layers_of(*scene(9), more), layers_of(*scene(9), later)));
    CHECK(!same(layers_of(*scene(9), {}), layers_of(*scene(9), later)));
}

TEST_CASE("resume: ranges of samples merge into the bits of the whole, in any order") {
    const TempFolder folder;
    const ScenePtr whole = scene();
    RenderSettings s;
    s.film_file = folder / "0.tsf";
    s.first_sample = 20;
    render(*scene(kSpp - 20), s);
    s.first_sample = 0;
    s.film_file = folder / "1.tsf";
    render(*scene(20), s);
    const FilmFile late = read_film_file(folder / "0.tsf");
    const FilmFile early = read_film_file(folder / "1.tsf");
    Film sum({0, 0, 37, 22}, late.header.passes, late.header.extras);
    sum.merge(late.film), sum.merge(early.film);
    RenderSettings all;
    all.film_file = folder / "2.tsf";
    render(*whole, all);
    FilmFile straight = read_film_file(all.film_file);
    const std::vector<Layer> a = sum.layers(sum.window()), b = straight.film.layers(sum.window());
    CHECK(same(a, b));
    CHECK(states_of(sum).coverage == states_of(straight.film).coverage);
}

TEST_CASE(
    "resume: what is wanted while the render goes on is saved, and only warned of if it fails") {
    const TempFolder folder;
    const ScenePtr s = scene(800);
    RenderSettings settings;
    settings.checkpoint = folder / "c.tsf";
    settings.checkpoint_s = 0.01;
    RenderResult result = render(*s, settings);
    CHECK(result.stats.checkpoints > 1);  // the last one is not all
    CHECK(result.stats.checkpoints_failed == 0);
    CHECK(result.stats.checkpoint_s > 0);
    const std::vector<Layer> whole = layers_of(*s, {});
    CHECK(same(result.image.layers, whole));
    CHECK(read_film_header(settings.checkpoint).least == 800);

    std::vector<std::string> warnings;
    settings.checkpoint = folder / "none/c.tsf";
    settings.warn = [&](const std::string& text) { warnings.push_back(text); };
    result = render(*s, settings);
    CHECK(result.stats.checkpoints == 0);
    CHECK(result.stats.checkpoints_failed > 1);
    CHECK(warnings.size() == 1);  // the same again is not told again
    CHECK(same(result.image.layers, whole));
}

TEST_CASE(
    "resume: checkpoints are as rare as keeps their cost below 1 %, but a minute apart at least") {
    CHECK(checkpoint_interval(0.1, 0.2, 2) == 60);
    CHECK(checkpoint_interval(1, 4, 2) == 300);  // 1 s of all, 4 s of one of two
    RenderSettings settings;
    const TempFolder folder;
    settings.checkpoint = folder / "c.tsf";
    CHECK(render(*scene(1), settings).stats.checkpoint_every_s == 60);
    settings.checkpoint_s = 0.5;
    CHECK(render(*scene(1), settings).stats.checkpoint_every_s == 0.5);
}

TEST_CASE("resume: the picture so far of a part is a part, and the render goes on") {
    const TempFolder folder;
    const ScenePtr s = scene();
    for (const char* checkpoint : {"", "a.tsf", "none/c.tsf"}) {
        INFO(checkpoint);
        RenderSettings settings;
        settings.film_file = folder / "a.tsf";
        if (*checkpoint != 0) settings.checkpoint = folder / checkpoint;
        settings.tile = 8;
        std::atomic<bool> wanted{false};
        std::atomic<int> tiles{0};
        settings.snapshot = &wanted;
        settings.on_tile = [&](const PixelWindow&, const std::vector<Layer>&) {
            if (++tiles == 40) wanted = true;
        };
        std::optional<FilmHeader> there;
        settings.on_snapshot = [&](RenderResult&&) {
            if (settings.checkpoint != settings.film_file)
                there = read_film_header(settings.film_file);
        };
        render(*s, settings);
        if (settings.checkpoint != settings.film_file) {
            REQUIRE(there);
            CHECK(there->most > 0);
            CHECK(there->least < kSpp);
        }
        CHECK(read_film_header(settings.film_file).least == kSpp);
        std::filesystem::remove(settings.film_file);
    }
}

TEST_CASE("resume: a film of another render is refused before anything is traced") {
    const TempFolder folder;
    RenderSettings settings;
    settings.film_file = folder / "a.tsf";
    render(*scene(4), settings);
    settings.resume = settings.film_file;
    settings.film_file.clear();
    const auto code = [&](const ScenePtr& s) {
        try {
            render(*s, settings);
        } catch (const Error& e) {
            return e.code();
        }
        return ExitCode::done;
    };
    CHECK(code(scene(4)) == ExitCode::done);
    CHECK(code(scene(4, 1)) == ExitCode::scene);
    CHECK(code(scene(3)) == ExitCode::usage);
    settings.deep = true;
    CHECK(code(scene(4)) == ExitCode::scene);  // its depths were not kept
    settings.deep = false;
    settings.resume = folder / "none.tsf";
    CHECK(code(scene(4)) == ExitCode::scene);
    settings.resume.clear();
    settings.film_file = folder / "none/a.tsf";
    CHECK(code(scene(4)) == ExitCode::output);
}
