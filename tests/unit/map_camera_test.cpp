// Cameras that show all directions: what they write, the environment reads.
#include <doctest/doctest.h>

#include <cmath>

#include "renderer/lights/map_projection.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"
#include "tests/support/map_files.h"
#include "tests/support/random.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

Camera map_camera(Projection projection, int width, int height) {
    CameraDesc desc;
    desc.automatic = false;
    desc.projection = projection;
    desc.position = {1, 2, 3};
    return Camera(desc, width, height, {}, {-1, -1, -1}, {1, 1, 1});
}

// Directions of the rays through points of the film, all in the block at column x.
RayPacket rays_of(const Camera& camera, int x, const SamplePairs& film) {
    RayPacket rays;
    int columns[kLanes];
    for (int i = 0; i < kLanes; ++i) columns[i] = x + i % 4;
    camera.rays(film, {}, columns, rays);
    return rays;
}

double angle(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

Vec3d direction(const RayPacket& rays, int i) { return Vec3d(rays.get(i).d); }

using Pictures = std::vector<std::vector<float>>;

const std::string kSky = "[environment]\nfile = 'there.exr'\nrotate_deg = 50\n";

constexpr Double3 kGazes[] = {{0, 0, -1},   {1, 0, 0},     {-1, 0, 0.1},   {0, 0, 1},
                              {0, 1, 0.01}, {0.01, -1, 0}, {0.6, 0.5, 0.6}};

// What a common camera sees that looks along each of kGazes.
Pictures seen(const SceneFolder& folder, const std::string& text) {
    Pictures pictures;
    for (const Double3& gaze : kGazes) {
        SceneDesc scene = folder.load(text);
        look(scene, {0, 0, 0}, gaze, 60);
        set_film(scene, 16, 16, 16);
        pictures.push_back(beauty_of(std::move(scene)));
    }
    return pictures;
}

// The whole way: rendered as a map, written, read as the environment, seen by a common camera.
void check_round_trip(const SceneFolder& folder, const Pictures& there, Projection projection,
                      int width, int height, double tolerance) {
    SceneDesc map = folder.load(kSky);
    map.camera.automatic = false;
    map.camera.projection = projection;
    set_film(map, width, height, 4);
    const RenderResult result = render(*build_scene(std::move(map)), {});
    write_exr(result.image, folder.path("back.exr"), {.all_float = true});

    const auto back = seen(folder, "[environment]\nfile = 'back.exr'\n");
    for (std::size_t g = 0; g < there.size(); ++g) {
        double worst = 0;
        for (std::size_t i = 0; i < there[g].size(); ++i)
            worst = std::max(worst, std::fabs(double(there[g][i]) - double(back[g][i])));
        CAPTURE(g);
        CHECK(worst < tolerance);
    }
}

}  // namespace

TEST_CASE("map camera: every point of the film looks where the map has it") {
    Random random(11);
    const Camera latlong = map_camera(Projection::latlong, 64, 32),
                 cube = map_camera(Projection::cube, 60, 10);
    for (int n = 0; n < 2000; ++n) {
        SamplePairs film;
        for (float* x : {&film.x[0], &film.x[1]}) *x = random.between(0, 4);
        const int block = 4 * static_cast<int>(random.between(0, 15));
        film.x[0] = static_cast<float>(block) + random.unit();
        film.y[0] = random.between(0, 10);
        const MapPoint on_strip{double{film.x[0]} / 60, double{film.y[0]} / 10},
            on_map{double{film.x[0]} / 64, double{film.y[0]} / 32};
        // Float: 24 bits of u turned into up to 2 pi.
        REQUIRE(angle(direction(rays_of(latlong, block, film), 0),
                      *map_direction(MapProjection::latlong, on_map)) < 3e-6);
        REQUIRE(angle(direction(rays_of(cube, block, film), 0),
                      *map_direction(MapProjection::cube_strip, on_strip)) < 3e-6);
        REQUIRE(length(rays_of(cube, block, film).get(0).o - Vec3f{1, 2, 3}) == 0.0f);
    }
}

TEST_CASE("map camera: samples beyond an edge go on across it") {
    const Camera latlong = map_camera(Projection::latlong, 64, 32),
                 cube = map_camera(Projection::cube, 60, 10);
    SamplePairs film{};
    // Over the pole one comes down on the other side.
    film.x[0] = 10, film.y[0] = -1;
    film.x[1] = 42, film.y[1] = 1;
    const RayPacket over = rays_of(latlong, 0, film);
    CHECK(angle(direction(over, 0), direction(over, 1)) < 1e-6);
    // The last pixel of the first face, +x, a pixel beyond its right edge: that is toward -z, not
    // the -x of the strip's next face.
    film.x[1] = 11, film.y[1] = 5;
    const Vec3d beyond = direction(rays_of(cube, 8, film), 1);
    CHECK(angle(beyond, Vec3d{1, 0, -1.2}) < 1e-6);
    // The same point from a pixel of the second face lies on that face.
    film.x[2] = 11, film.y[2] = 5;
    CHECK(direction(rays_of(cube, 8, film), 2).x < -0.5);
}

TEST_CASE("map camera: an environment rendered as a map is that environment") {
    // Half a texel of the coarser one, at the steepest place some 6 per radian.
    const SceneFolder folder;
    write_map(folder.path("there.exr"), MapProjection::latlong, 512, 256,
              [](Vec3d d) { return min(lively(d), Color(4.0f)); });
    const auto there = seen(folder, kSky);
    check_round_trip(folder, there, Projection::latlong, 512, 256, 0.08);
    check_round_trip(folder, there, Projection::cube, 768, 128, 0.08);
}

TEST_CASE("map camera: depth is the distance, in every direction") {
    for (const Projection projection : {Projection::latlong, Projection::cube}) {
        SceneDesc scene;
        scene.camera.automatic = false;
        scene.camera.position = {5, 1, -2};
        scene.camera.projection = projection;
        add_sphere(scene, {5, 1, -2}, 2, add(scene, matte(0.5f)));
        set_film(scene, 48, 8, 1);
        const RenderResult result = render(*build_scene(std::move(scene)), {});
        for (const Layer& layer : result.image.layers) {
            if (layer.channels[0] == "Z") {
                for (const float z : layer.pixels) REQUIRE(z == doctest::Approx(2).epsilon(1e-5));
            }
            if (layer.name != "N") continue;
            for (std::size_t i = 0; i < layer.pixels.size(); i += 3) {
                const MapPoint p{(double(i / 3 % 48) + 0.5) / 48, (double(i / 3 / 48) + 0.5) / 8};
                const auto map = projection == Projection::cube ? MapProjection::cube_strip
                                                                : MapProjection::latlong;
                const Vec3d n{layer.pixels[i], layer.pixels[i + 1], layer.pixels[i + 2]};
                // The box filter's pixel is up to 0.4 wide.
                REQUIRE(angle(-n, *map_direction(map, p)) < 0.4);
            }
        }
    }
}

TEST_CASE("map camera: without a place it stands in the middle, and maps have sizes of their own") {
    const SceneFolder folder;
    const std::string ball = "[[sphere]]\ncenter = [4, 1, 1]\nradius = 3\n";
    const auto stands = [&](const std::string& text, Vec3f at) {
        const ScenePtr scene = build_scene(folder.load("[camera]\n" + text + "\n" + ball));
        return length(rays_of(scene->camera(), 0, {}).get(0).o - at) < 1e-6f;
    };
    CHECK(stands("projection = 'latlong'", {4, 1, 1}));
    CHECK(stands("projection = 'cube'\nposition = [0, 0, 0]", {0, 0, 0}));
    CHECK(stands("projection = 'cube'\nmatrix = [[1, 0, 0, 7], [0, 1, 0, 8], [0, 0, 1, 9]]",
                 {7, 8, 9}));
    SceneDesc scene = folder.load("[camera]\nprojection = 'latlong'\nfov_deg = 30\n" + ball);
    CHECK(scene.film.width == 1024);
    CHECK(scene.film.height == 512);
    CHECK(contains(scene.notes, "fov_deg has no effect on a latlong camera"));
    scene = folder.load("[camera]\nprojection = 'cube'\n[film]\nfilter = 'box'\n" + ball);
    CHECK(scene.film.width == 1536);
    CHECK(scene.film.height == 256);
    scene = folder.load("[camera]\nprojection = 'cube'\n[film]\nresolution = [12, 2]\n" + ball);
    CHECK(scene.film.width == 12);
}

TEST_CASE(
    "map camera: a cube that is not 6:1 is an error, an odd latlong a note, a lens a warning") {
    const SceneFolder folder;
    const auto built = [&](const std::string& text) {
        return build_scene(folder.load(text + "\n[[sphere]]\n"));
    };
    try {
        built("[camera]\nprojection = 'cube'\n[film]\nresolution = [960, 540]");
        FAIL("no error");
    } catch (const Error& e) {
        CHECK(e.code() == ExitCode::scene);
        CHECK(std::string(e.what()).find(
                  "s.toml:2:1: camera: a cube is six squares side by side, the resolution is "
                  "960x540, must be 6:1") != std::string::npos);
    }
    const ScenePtr odd =
        built("[camera]\nprojection = 'latlong'\naperture_radius = 1\n[film]\nresolution = [9, 9]");
    CHECK(contains(describe(*odd).notes, "not 2:1"));
    CHECK(contains(describe(*odd).warnings, "only a perspective camera has a lens"));
}
