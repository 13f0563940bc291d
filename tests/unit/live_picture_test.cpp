#include "renderer/image/live_picture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <thread>
#include <tuple>

#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

using Piece = LivePicture::Piece;

/// Beauty and depth of a part; every value names its pixel, channel and `state`.
std::vector<Layer> layers_of(const PixelWindow& part, int state) {
    std::vector<Layer> layers{{"", {"R", "G"}, LayerKind::color, {}},
                              {"N", {"X"}, LayerKind::data, {}}};
    int channel = 0;
    for (Layer& layer : layers) {
        for (int y = part.y0; y < part.y1; ++y) {
            for (int x = part.x0; x < part.x1; ++x) {
                for (std::size_t c = 0; c < layer.channels.size(); ++c)
                    layer.pixels.push_back(static_cast<float>(
                        state * 3000000 + (channel + static_cast<int>(c)) * 1000000 + y * 1000 +
                        x));
            }
        }
        channel += static_cast<int>(layer.channels.size());
    }
    return layers;
}

/// What a viewer holds after the pieces, by channel, x and y.
class Viewer {
public:
    void put(const Piece& piece, std::size_t channels) {
        const PixelWindow& w = piece.window;
        REQUIRE(piece.pixels.size() == channels * std::size_t(w.width() * w.height()));
        std::size_t i = 0;
        for (std::size_t c = 0; c < channels; ++c) {
            for (int y = w.y0; y < w.y1; ++y) {
                for (int x = w.x0; x < w.x1; ++x) pixels_[{c, y, x}] = piece.pixels[i++];
            }
        }
    }
    int take_all(LivePicture& from) {
        int pieces = 0;
        for (Piece piece; from.take(piece); ++pieces) put(piece, from.channels().size());
        return pieces;
    }
    /// How many values of these layers it does not have.
    int lacks(const PixelWindow& part, const std::vector<Layer>& layers) const {
        int missing = 0;
        std::size_t first = 0;
        for (const Layer& layer : layers) {
            std::size_t i = 0;
            for (int y = part.y0; y < part.y1; ++y) {
                for (int x = part.x0; x < part.x1; ++x) {
                    for (std::size_t c = 0; c < layer.channels.size(); ++c, ++i) {
                        const auto found = pixels_.find({first + c, y, x});
                        // What never came is black.
                        missing +=
                            (found == pixels_.end() ? 0.0f : found->second) != layer.pixels[i];
                    }
                }
            }
            first += layer.channels.size();
        }
        return missing;
    }

private:
    std::map<std::tuple<std::size_t, int, int>, float> pixels_;
};

}  // namespace

TEST_CASE("live picture: what is taken is what was put in, at its place") {
    const PixelWindow window{-5, 7, 190, 140}, part{30, 20, 101, 90};
    LivePicture picture(window);
    CHECK_FALSE(picture.ready());
    CHECK(picture.update(part, layers_of(part, 1)));
    REQUIRE(picture.ready());
    CHECK(picture.channels() == std::vector<std::string>{"R", "G", "N.X"});
    Viewer viewer;
    CHECK(viewer.take_all(picture) > 1);
    CHECK(viewer.lacks(part, layers_of(part, 1)) == 0);
}

TEST_CASE("live picture: a part that sticks out is cut to the window") {
    const PixelWindow window{10, 10, 20, 20}, part{0, 0, 15, 40}, inside{10, 10, 15, 20};
    LivePicture picture(window);
    CHECK(picture.update(part, layers_of(part, 1)));
    Piece piece;
    REQUIRE(picture.take(piece));
    CHECK(piece.window == inside);
    CHECK_FALSE(picture.update({30, 30, 40, 40}, layers_of({30, 30, 40, 40}, 1)));
    CHECK_FALSE(picture.take(piece));
}

TEST_CASE("live picture: what changes before it is taken is taken once, in its newest state") {
    const PixelWindow window{0, 0, 64, 64}, left{0, 0, 8, 8}, right{40, 8, 48, 16};
    LivePicture picture(window);
    for (int state = 1; state <= 3; ++state) {
        picture.update(left, layers_of(left, state));
        picture.update(right, layers_of(right, state));
    }
    Viewer viewer;
    CHECK(viewer.take_all(picture) == 1);
    CHECK(viewer.lacks(left, layers_of(left, 3)) == 0);
    CHECK(viewer.lacks(right, layers_of(right, 3)) == 0);
}

TEST_CASE("live picture: what is as before does not wait") {
    const PixelWindow window{0, 0, 64, 64};
    LivePicture picture(window);
    picture.update(window, layers_of(window, 1));
    Viewer viewer;
    viewer.take_all(picture);
    CHECK_FALSE(picture.update(window, layers_of(window, 1)));
    CHECK(viewer.take_all(picture) == 0);
}

TEST_CASE("live picture: another viewer gets all of it again") {
    const PixelWindow window{0, 0, 150, 70}, part{8, 8, 140, 60};
    LivePicture picture(window);
    picture.update(part, layers_of(part, 1));
    Viewer first, second;
    first.take_all(picture);
    picture.take_all_again();
    second.take_all(picture);
    CHECK(second.lacks(part, layers_of(part, 1)) == 0);
}

TEST_CASE("live picture: threads put in while one takes, and the last state arrives") {
    const PixelWindow window{0, 0, 128, 128};
    constexpr int kStates = 40;
    LivePicture picture(window);
    std::atomic<int> running{2};
    const auto put = [&](int x0) {
        // Both halves cross the cells' border.
        for (int state = 1; state <= kStates; ++state) {
            const PixelWindow part{x0, 20, x0 + 20, 100};
            picture.update(part, layers_of(part, state));
        }
        --running;
    };
    std::thread left(put, 50), right(put, 70);
    Viewer viewer;
    while (running > 0) viewer.take_all(picture);
    left.join(), right.join();
    viewer.take_all(picture);
    const PixelWindow all{50, 20, 90, 100};
    CHECK(viewer.lacks(all, layers_of(all, kStates)) == 0);
}

TEST_CASE("render: the last tiles together are the picture") {
    SceneDesc scene;
    add_mesh(scene, box_mesh({0, 0, 0}, 1, add(scene, glowing(1))));
    look(scene, {3, 2, 5}, {0, 0, 0});
    set_film(scene, 90, 50, 6);
    scene.film.crop = PixelWindow{3, 5, 81, 47};
    const ScenePtr built = build_scene(std::move(scene));
    LivePicture picture({3, 5, 81, 47});
    RenderSettings settings;
    std::atomic<int> tiles{0};
    settings.on_tile = [&](const PixelWindow& tile, const std::vector<Layer>& layers) {
        picture.update(tile, layers);
        ++tiles;
    };
    const RenderResult result = render(*built, settings);
    CHECK(tiles > 3 * 2);  // several passes
    Viewer viewer;
    viewer.take_all(picture);
    CHECK(viewer.lacks(result.image.window, result.image.layers) == 0);
    const std::vector<float>& beauty = result.image.layers[0].pixels;
    CHECK_MESSAGE(*std::max_element(beauty.begin(), beauty.end()) > 0.5f, "there is a picture");
}

TEST_CASE("live picture: layers that only the last picture has are left out") {
    const PixelWindow window{0, 0, 70, 9};
    LivePicture picture(window);
    picture.update(window, layers_of(window, 1));
    std::vector<Layer> last = layers_of(window, 1);
    last.push_back({"CryptoObject00",
                    {"R", "G", "B", "A"},
                    LayerKind::data,
                    std::vector<float>(70 * 9 * 4, 5.0f)});
    CHECK_FALSE(picture.update(window, last));
    CHECK(picture.channels().size() == 3);
    Piece piece;
    while (picture.take(piece)) CHECK(std::ranges::count(piece.pixels, 5.0f) == 0);
}
