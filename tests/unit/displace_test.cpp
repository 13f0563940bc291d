// Displaced meshes against what they should be in closed form, and the bounds they are held to.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "renderer/api/node_table.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/subdivision.h"
#include "tests/support/cages.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846;

MaterialDesc moved_by(float height) {
    MaterialDesc m = matte(0.5f);
    m.name = "moved";
    m.displacement.value = height;
    return m;
}

// A node fed by constants, texcoord or other nodes.
int add_node(MaterialDesc& m, NodeOp op, std::vector<NodeValue> inputs) {
    NodeDesc node;
    node.type = static_cast<int>(op);
    const std::size_t count = kNodes[static_cast<std::size_t>(op)].inputs().size();
    node.inputs.resize(count);
    node.given.assign(count, false);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        node.inputs[i] = inputs[i], node.given[i] = true;
    m.nodes.push_back(node);
    return static_cast<int>(m.nodes.size()) - 1;
}

NodeValue constant(float v) { return {{v, v, v}}; }
NodeValue from(int node) { return {{}, node}; }

// Noise over the texture chart, which differs on the two sides of a seam.
MaterialDesc noisy(float height) {
    MaterialDesc m = moved_by(1);
    const int place =
        add_node(m, NodeOp::multiply, {from(add_node(m, NodeOp::texcoord, {})), constant(7)});
    m.displacement.node =
        add_node(m, NodeOp::noise2d, {constant(height), constant(0), from(place)});
    return m;
}

MeshDesc subdivided(MeshDesc mesh, int material, Subdivision scheme, int rate) {
    mesh.name = "cage";
    mesh.materials = {material};
    mesh.subdivision.scheme = scheme;
    mesh.subdivision.rate = rate;
    return mesh;
}

// What the builder makes of the meshes of a description.
struct Made {
    SceneDesc desc;
    std::vector<SubdivisionStatistics> statistics;
    std::vector<FlatInstance> instances;
    Problems problems;
    const MeshDesc& mesh(std::size_t i = 0) const { return desc.meshes[i]; }
};

Made made(SceneDesc desc, int threads = 2) {
    Made out{std::move(desc), {}, {}, Problems()};
    out.instances = flatten(out.desc, out.problems);
    const std::vector<bool> moved = displaced_materials(out.desc, out.instances, out.problems);
    std::vector<Displacement> displacements;
    for (std::size_t m = 0; m < moved.size(); ++m)
        displacements.push_back(moved[m] ? Displacement(out.desc.materials[m]) : Displacement());
    const ViewScale view{{0, 0, 10}, 1000, false};
    out.statistics = subdivide_meshes(
        {out.desc, out.instances, displacements, nullptr, view, threads, "", out.problems});
    return out;
}

SceneDesc scene_of(const MeshDesc& mesh, const MaterialDesc& material) {
    SceneDesc s;
    add(s, material);
    add_mesh(s, mesh);
    return s;
}

Vec3d position(const MeshDesc& m, std::size_t v) {
    return {m.positions[3 * v], m.positions[3 * v + 1], m.positions[3 * v + 2]};
}
Vec3d normal(const MeshDesc& m, std::size_t v) {
    return Vec3d(Vec3f{m.normals[3 * v], m.normals[3 * v + 1], m.normals[3 * v + 2]});
}

// The cage whose limit goes through the unit sphere at its corners.
MeshDesc fitted_sphere(int n) {
    MeshDesc mesh = sphere_cage(n);
    mesh.subdivision.scheme = Subdivision::catmull_clark;
    for (int round = 0; round < 8; ++round) {
        const Cage cage = make_cage(mesh, false);
        const LimitSurface surface(mesh, cage, 1, "");
        std::vector<double> stretch(mesh.positions.size() / 3, 1);
        for (std::uint32_t f = 0; f < cage.faces.size(); ++f) {
            for (std::uint32_t k = 0; k < 4; ++k) {
                const LimitPoint at =
                    surface.at({f, 0, k == 1 || k == 2 ? 1.0f : 0.0f, k >= 2 ? 1.0f : 0.0f});
                stretch[mesh.position_index[cage.source[cage.faces[f].first + k]]] =
                    1 / length(Vec3d(at.p) + cage.origin);
            }
        }
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i] *= stretch[i / 3];
    }
    return mesh;
}

struct Ball {
    double least = 1e300, most = 0, normal = 1;  // radii; the least cosine to the radius
};

Ball ball_of(const MeshDesc& m) {
    Ball b;
    for (std::size_t v = 0; v < m.positions.size() / 3; ++v) {
        const double r = length(position(m, v));
        b.least = std::min(b.least, r);
        b.most = std::max(b.most, r);
        b.normal = std::min(b.normal, dot(position(m, v) / r, normal(m, v)));
    }
    return b;
}

// Edges with a triangle on one side only, by the bits of their ends.
std::size_t open_edges(const MeshDesc& m) {
    using Point = std::array<double, 3>;
    std::vector<std::pair<Point, Point>> there, back;
    const auto point = [&](std::uint32_t v) {
        const double* p = &m.positions[3 * std::size_t(v)];
        return Point{p[0], p[1], p[2]};
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Point p[3] = {point(a), point(b), point(c)};
        for (int k = 0; k < 3; ++k) {
            there.emplace_back(p[k], p[(k + 1) % 3]);
            back.emplace_back(p[(k + 1) % 3], p[k]);
        }
    };
    const std::uint32_t* i = m.position_index.data();
    for (std::uint32_t t = 0; t < m.triangles; ++t, i += 3) triangle(i[0], i[1], i[2]);
    for (std::uint32_t q = 0; q < m.quads; ++q, i += 4)
        triangle(i[0], i[1], i[3]), triangle(i[2], i[3], i[1]);
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    std::vector<std::pair<Point, Point>> open;
    std::set_symmetric_difference(there.begin(), there.end(), back.begin(), back.end(),
                                  std::back_inserter(open));
    return open.size();
}

std::string refusal(SceneDesc desc) {
    try {
        build_scene(std::move(desc));
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        return error.what();
    }
    return {};
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("displace: a sphere moved by a constant is the larger sphere, normals and all") {
    const MeshDesc cage = fitted_sphere(16);
    const auto ball = [&](float height) {
        return ball_of(
            made(scene_of(subdivided(cage, 0, Subdivision::catmull_clark, 5), moved_by(height)))
                .mesh());
    };
    const Ball still = ball(0), moved = ball(0.25f);
    // The fitted surface is off the sphere by this much, and its normals by some 1e-3.
    constexpr double kFit = 1e-4;
    CHECK(still.least > 1 - kFit);
    CHECK(still.most < 1 + kFit);
    CHECK(still.normal > 1 - 3e-6);
    // Along a normal that is off by d the radius loses less than 0.25 d^2.
    CHECK(moved.least > 1.25 - kFit - 1e-6);
    CHECK(moved.most < 1.25 + kFit);
    // From the faces alone: good to a hundredth of their size of a fiftieth.
    CHECK(moved.normal > 1 - 1e-5);
}

TEST_CASE("displace: the rendered depth of a displaced sphere is that of the larger sphere") {
    SceneDesc s =
        scene_of(subdivided(fitted_sphere(16), 0, Subdivision::catmull_clark, 0), moved_by(0.25f));
    s.meshes[0].subdivision.edge_length_px = 1;
    add_sky(s, {1, 1, 1});
    look(s, {0.4, 0.7, 5}, {0, 0, 0}, 40);
    set_film(s, 96, 96, 1);
    s.film.aovs = {"P"};
    const ScenePtr scene = build_scene(std::move(s));
    const RenderResult result = render(*scene);
    const std::vector<float>& p = result.image.layers.back().pixels;
    const std::vector<float>& beauty = result.image.layers.front().pixels;
    double worst = 0;
    int inside = 0;
    for (std::size_t i = 0; i < beauty.size() / 4; ++i) {
        if (length(Vec3f{p[3 * i], p[3 * i + 1], p[3 * i + 2]}) == 0.0f) continue;
        const double r = length(Vec3d(Vec3f{p[3 * i], p[3 * i + 1], p[3 * i + 2]}));
        worst = std::max(worst, std::abs(r - 1.25));
        ++inside;
    }
    // A flat piece of one pixel, a 26th of a unit, lies h^2 / 4r below the sphere in its middle;
    // the fit as above.
    CHECK(worst < 1e-4 + 0.038 * 0.038 / 4);
    // Of the silhouette: an area to the pixels of its rim that sampling may put on either side.
    const double eye = std::sqrt(0.4 * 0.4 + 0.7 * 0.7 + 25);
    const double radius =
        1.25 / std::sqrt(eye * eye - 1.25 * 1.25) / std::tan(20 * kPiD / 180) * 48;
    CHECK(std::abs(inside - kPiD * radius * radius) < 2.5 * std::sqrt(2 * kPiD * radius));
}

TEST_CASE("displace: seams, unequal rates and charts that disagree leave no crack") {
    SceneDesc s =
        scene_of(subdivided(sphere_cage(3), 0, Subdivision::catmull_clark, 0), noisy(0.4f));
    s.meshes[0].subdivision.edge_length_px = 9;  // from near by: the rates differ
    s.instances[0].transforms = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 8.6}};
    const Made m = made(s);
    CHECK(m.mesh().triangles > 0);
    CHECK(m.mesh().quads > 0);
    CHECK(open_edges(m.mesh()) == 0);
    CHECK(m.statistics[0].triangles == m.mesh().triangles + 2 * m.mesh().quads);
    // The charts do disagree: a vertex is moved by the mean, not by either.
    s.meshes[0].subdivision.scheme = Subdivision::linear;
    CHECK(open_edges(made(s).mesh()) == 0);
    SceneDesc triangles =
        scene_of(subdivided(pyramid_cage(), 0, Subdivision::linear, 7), moved_by(0.2f));
    CHECK(open_edges(made(triangles).mesh()) == 0);
}

TEST_CASE("displace: a lamp inside of a closed displaced body is not seen through it") {
    SceneDesc s =
        scene_of(subdivided(sphere_cage(4), 0, Subdivision::catmull_clark, 0), moved_by(0));
    s.meshes[0].subdivision.edge_length_px = 3;
    // Faces by turns of two materials, of which one stands out: where they meet, each asks for
    // another height.
    add(s, moved_by(0.3f));
    s.meshes[0].materials = {0, 1};
    for (std::uint32_t f = 0; f < s.meshes[0].quads; ++f)
        s.meshes[0].face_material.push_back(f % 2);
    for (MaterialDesc& m : s.materials) m.base_color.value = {0, 0, 0};
    SphereLightDesc lamp;
    lamp.radius = 0.8;
    lamp.radiance = {1000, 1000, 1000};
    add_light(s, lamp);
    look(s, {0.3, 0.4, 3}, {0, 0, 0});
    set_film(s, 128, 128, 64);
    const std::vector<float> picture = beauty_of(s);
    int seen = 0;
    float out = 0;
    for (std::size_t i = 0; i < picture.size(); i += 4) {
        out = std::max(out, picture[i]);
        seen += picture[i + 3] == 1.0f;
    }
    CHECK(seen > 4000);
    CHECK(out == 0.0f);
}

TEST_CASE("displace: the same bits for any number of threads") {
    const SceneDesc s =
        scene_of(subdivided(sphere_cage(4), 0, Subdivision::catmull_clark, 24), noisy(0.3f));
    const Made one = made(s, 1);
    for (const int threads : {2, 5}) {
        const Made more = made(s, threads);
        CHECK(one.mesh().position_index == more.mesh().position_index);
        CHECK(std::equal(one.mesh().positions.begin(), one.mesh().positions.end(),
                         more.mesh().positions.begin(), [](double a, double b) {
                             return std::bit_cast<std::uint64_t>(a) ==
                                    std::bit_cast<std::uint64_t>(b);
                         }));
        CHECK(one.mesh().normals == more.mesh().normals);
    }
}

TEST_CASE("displace: a crop and other tiles show the same bits of a mesh cut by pixels") {
    SceneDesc s =
        scene_of(subdivided(sphere_cage(3), 0, Subdivision::catmull_clark, 0), noisy(0.3f));
    add_sky(s, {1, 1, 1});
    look(s, {0, 0, 4}, {0, 0, 0});
    set_film(s, 48, 48, 2);
    const std::vector<float> full = beauty_of(s);
    RenderSettings settings;
    settings.threads = 1;
    settings.tile = 16;
    CHECK(beauty_of(s, {}, settings) == full);
    s.film.crop = PixelWindow{8, 12, 40, 30};
    const std::vector<float> part = beauty_of(s);
    std::size_t differ = 0;
    for (int y = 12; y < 30; ++y)
        for (int x = 8; x < 40; ++x)
            for (int c = 0; c < 4; ++c)
                differ += part[static_cast<std::size_t>(((y - 12) * 32 + x - 8) * 4 + c)] !=
                          full[static_cast<std::size_t>((y * 48 + x) * 4 + c)];
    CHECK(differ == 0);
}

TEST_CASE("displace: the silhouette of a sheet follows its profile, and its ridges shade it") {
    // Two waves along u, height 0.1.
    MaterialDesc m = moved_by(0.1f);
    const int u =
        add_node(m, NodeOp::extract, {from(add_node(m, NodeOp::texcoord, {})), constant(0)});
    const auto waves = static_cast<float>(4 * kPiD);
    m.displacement.node =
        add_node(m, NodeOp::sin, {from(add_node(m, NodeOp::multiply, {from(u), constant(waves)}))});
    SceneDesc s = scene_of(subdivided(grid_cage(2), 0, Subdivision::linear, 64), m);
    const auto height = [](double x) { return 0.1 * std::sin(4 * kPiD * x); };
    // From the side and a little above, in parallel: each column shows the sheet from its near edge
    // to its far one, both as high as the profile is there.
    SceneDesc side = s;
    add_sky(side, {1, 1, 1});
    side.environment->visible = false;
    const double tilt = std::atan2(0.25, 5);
    look(side, {0.5, 0.25, 5}, {0.5, 0, 0});
    side.camera.projection = Projection::orthographic;
    side.camera.ortho_height = 0.4;
    set_film(side, 200, 80, 64);
    const std::vector<float> picture = beauty_of(side);
    double worst = 0;
    for (int x = 0; x < 200; ++x) {
        double covered = 0, moment = 0;
        for (int y = 0; y < 80; ++y) {
            const auto alpha =
                static_cast<double>(picture[static_cast<std::size_t>((y * 200 + x) * 4 + 3)]);
            covered += alpha;
            moment += alpha * (0.2 - (y + 0.5) * 0.005);
        }
        const double seen = moment / covered;
        const double expected = height((x + 0.5) / 200) * std::cos(tilt) + 0.5 * std::sin(tilt);
        worst = std::max(worst, std::abs(seen - expected));
    }
    CHECK(worst < 0.001);  // a fifth of a pixel: 64 samples each
    const Made flat = made(s);
    CHECK(flat.statistics[0].after[1][1] == doctest::Approx(0.1).epsilon(1e-3));
    CHECK(flat.statistics[0].after[0][1] == doctest::Approx(-0.1).epsilon(1e-3));
    CHECK(flat.statistics[0].before[1][1] == doctest::Approx(0));
    double off = 0;
    for (std::size_t v = 0; v < flat.mesh().positions.size() / 3; ++v) {
        const Vec3d p = position(flat.mesh(), v);
        off = std::max(off, std::abs(p.y - height(p.x)));
    }
    CHECK(off < 1e-6);

    DistantLightDesc sun;
    sun.direction = {1, -0.2, 0};
    const auto lit = [&](const SceneDesc& scene, double x) {
        SceneDesc d = scene;
        add_light(d, sun);
        look_at_point(d, {x, 2, -0.5}, {x, 0, -0.5});
        set_film(d, 4, 4, 4);
        d.render.max_depth = 0;
        return beauty_of(d)[0];
    };
    SceneDesc even = s;
    even.materials[0] = moved_by(0);
    // The ridge at u = 1/8 falls off behind itself at up to 1.26: the trough at 0.35 lies in its
    // shadow (0.19 lower at a distance of 0.22; the sun sinks 0.2 a unit), the flank at 0.55 not.
    CHECK(lit(s, 0.35) == 0.0f);
    CHECK(lit(s, 0.55) > 0.1f);
    CHECK(lit(even, 0.35) > 0.01f);
}

TEST_CASE(
    "displace: vectors move along u, across it and along the normal, or by the object's axes") {
    MaterialDesc m = moved_by(0);
    m.vector_displacement.value = {0.1f, 0.2f, 0.3f};
    m.displacement_scale = 2;
    const auto moved = [&](DisplacementSpace space, bool mirrored) {
        m.displacement_space = space;
        MeshDesc grid = subdivided(grid_cage(1), 0, Subdivision::catmull_clark, 3);
        if (mirrored)
            for (std::size_t i = 0; i < grid.uvs.size(); i += 2) grid.uvs[i] = 1 - grid.uvs[i];
        const Made out = made(scene_of(grid, m));
        const std::array<Double3, 2>& b = out.statistics[0].before;
        const std::array<Double3, 2>& a = out.statistics[0].after;
        return Vec3d{a[0][0] - b[0][0], a[0][1] - b[0][1], a[0][2] - b[0][2]};
    };
    // u runs along x, v along -z, the normal is y.
    CHECK(length(moved(DisplacementSpace::tangent, false) - Vec3d{0.2, 0.6, -0.4}) < 1e-6);
    CHECK(length(moved(DisplacementSpace::tangent, true) - Vec3d{-0.2, 0.6, -0.4}) < 1e-6);
    CHECK(length(moved(DisplacementSpace::object, false) - Vec3d{0.2, 0.4, 0.6}) < 1e-6);
}

TEST_CASE("displace: heights are scene units wherever the mesh stands, with scale and offset") {
    MaterialDesc m = moved_by(0.5f);
    m.displacement_scale = 0.4f;
    m.displacement_offset = -0.1f;
    SceneDesc s = scene_of(subdivided(grid_cage(1), 0, Subdivision::linear, 2), m);
    s.instances[0].transforms = {{100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0}};
    CHECK(made(s).statistics[0].after[1][1] * 100 == doctest::Approx(0.4 * 0.5 - 0.1));
}

TEST_CASE("displace: instances that are moved otherwise get a mesh of their own, the rest share") {
    SceneDesc s = scene_of(subdivided(grid_cage(1), 0, Subdivision::linear, 2), moved_by(0.1f));
    const int other = add(s, moved_by(0.7f)), still = add(s, matte(0.2f));
    for (const int material : {-1, other, other, still}) {
        place(s, ShapeKind::mesh, 0);
        s.instances.back().material = material;
    }
    const Made m = made(s);
    REQUIRE(m.statistics.size() == 3);
    const auto top = [&](std::size_t instance) {
        return position(m.mesh(static_cast<std::size_t>(m.instances[instance].index)), 0).y;
    };
    CHECK(m.instances[0].index == m.instances[1].index);
    CHECK(m.instances[2].index == m.instances[3].index);
    CHECK(top(0) == doctest::Approx(0.1));
    CHECK(top(2) == doctest::Approx(0.7));
    CHECK(top(4) == doctest::Approx(0));
}

TEST_CASE("displace: the hard edges of a linear cage stay hard") {
    MeshDesc cube = cube_cage();
    for (std::size_t q = 0; q < 6; ++q) {
        const std::uint32_t* v = &cube.position_index[4 * q];
        Vec3d middle;
        for (int k = 0; k < 4; ++k) middle += position(cube, v[k]);
        const Vec3f n(normalize(middle));
        cube.normals.insert(cube.normals.end(), {n.x, n.y, n.z});
        for (int k = 0; k < 4; ++k) cube.normal_index.push_back(static_cast<std::uint32_t>(q));
    }
    const Made m = made(scene_of(subdivided(cube, 0, Subdivision::linear, 16), moved_by(0.01f)));
    CHECK(open_edges(m.mesh()) == 0);
    double inside = 1, rim = 1;
    for (std::size_t v = 0; v < m.mesh().positions.size() / 3; ++v) {
        const Vec3d p = abs(position(m.mesh(), v));
        const double middle = p.x + p.y + p.z - max_component(p) - min_component(p);
        // Next to the edge the pieces lean: the edge itself is moved by the mean of both faces.
        double& least = middle > 0.8 ? rim : inside;
        least = std::min(least, max_component(abs(normal(m.mesh(), v))));
    }
    CHECK(inside > 1 - 1e-6);
    CHECK(rim > 0.99);
}

TEST_CASE(
    "displace: rates follow the picture: pieces are as long as asked for, nearer ones shorter") {
    MeshDesc mesh = grid_cage(1);
    mesh.subdivision.scheme = Subdivision::linear;
    mesh.subdivision.edge_length_px = 4;
    const Cage cage = make_cage(mesh, false);
    const ViewScale view{{0.5, 0, 2}, 100, false};
    const Affined place;
    const EdgeRates r = edge_rates(cage, mesh.subdivision, 1, place, view);
    for (std::size_t e = 0; e < 4; ++e) {
        const Vec3d a = Vec3d(cage.places[cage.edges[e].a]) + cage.origin,
                    b = Vec3d(cage.places[cage.edges[e].b]) + cage.origin;
        const bool near = a.z == 0 && b.z == 0, far = a.z == -1 && b.z == -1;
        // 1 unit at distance 2, 3, or seen from its nearer end.
        const double distance = near ? 2 : (far ? 3 : std::sqrt(4.25));
        CHECK(r.rates[e] == static_cast<int>(std::ceil(100 / distance / 4)));
    }
    mesh.subdivision.max_rate = 10;
    CHECK(edge_rates(cage, mesh.subdivision, 1, place, view).limited == 3);
    mesh.subdivision.edge_length = 0.2;
    CHECK(edge_rates(cage, mesh.subdivision, 1, place, view).rates == std::vector<int>(4, 5));
    CHECK(edge_rates(cage, mesh.subdivision, 0.5, place, view).rates == std::vector<int>(4, 3));
    // Of two placements the one that looks larger, far and huge or near and small.
    const Affined small({0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}, {0, 0, 1}),
        huge({50, 0, 0}, {0, 50, 0}, {0, 0, 50}, {0, 0, -200});
    const std::array<Affined, 2> both{small, huge};
    CHECK(&nearest_placement(cage, both, view) == &both[1]);
    const std::array<Affined, 2> twice{small, place};
    CHECK(&nearest_placement(cage, twice, view) == &twice[1]);
}

TEST_CASE("displace: what is not finite stays where it is and is counted") {
    MaterialDesc m = moved_by(1);
    // exp(1000 u): infinite over most of the chart.
    const int u =
        add_node(m, NodeOp::extract, {from(add_node(m, NodeOp::texcoord, {})), constant(0)});
    const int steep = add_node(m, NodeOp::multiply, {from(u), constant(1000)});
    const int large = add_node(m, NodeOp::exp, {from(steep)});
    m.displacement.node = add_node(m, NodeOp::subtract, {from(large), from(large)});
    const Made out = made(scene_of(subdivided(grid_cage(1), 0, Subdivision::linear, 10), m));
    CHECK(out.statistics[0].non_finite == 11 * 10);
    for (const double p : out.mesh().positions) CHECK(std::isfinite(p));
    REQUIRE(out.problems.warnings().size() == 1);
    CHECK(has(out.problems.warnings()[0], "displacement is not finite at 110 vertices"));
}

TEST_CASE("displace: what cannot be made is refused with its place") {
    const auto file = std::make_shared<const std::string>("s.toml");
    SceneDesc s = scene_of(subdivided(grid_cage(1), 0, Subdivision::linear, 200), moved_by(0.1f));
    s.meshes[0].subdivision.loc = {file, 7, 3};
    s.materials[0].loc = {file, 20, 1};
    CHECK(refusal(s).empty());
    SceneDesc large = s;
    large.meshes[0].subdivision.max_triangles = 79999;
    CHECK(has(refusal(large),
              "s.toml:7:3: mesh 'cage': subdivision would make 80000 triangles, at "
              "most 79999 are allowed"));
    SceneDesc far = s;
    far.materials[0].displacement.value = 200;
    CHECK(
        has(refusal(far), "s.toml:20:1: material 'moved': displacement moves mesh 'cage' by 200 "));
    far.materials[0].displacement_loc = {file, 21, 4};
    CHECK(has(refusal(far), "s.toml:21:4: material 'moved': displacement moves"));
    far.materials[0].displacement.value = 100;
    CHECK(refusal(far).empty());
    SceneDesc bare = s;
    bare.meshes[0].uvs.clear();
    bare.materials[0].vector_displacement.value = {1, 0, 0};
    CHECK(
        has(refusal(bare), "s.toml:7:3: mesh 'cage': vector_displacement in tangent space needs"));
    bare.materials[0].displacement_space = DisplacementSpace::object;
    CHECK(refusal(bare).empty());
    SceneDesc pole = s;
    pole.meshes[0] = subdivided(star_cage(63), 0, Subdivision::catmull_clark, 2);
    CHECK(has(refusal(pole), "64 faces meet at one vertex, catmull_clark takes at most 63"));
    pole.meshes[0].subdivision.scheme = Subdivision::linear;
    CHECK(refusal(pole).empty());
    pole.meshes[0] = subdivided(star_cage(62), 0, Subdivision::catmull_clark, 2);
    CHECK(refusal(pole).empty());
}

TEST_CASE("displace: a mesh or sphere that cannot be displaced says so and stays") {
    SceneDesc s = scene_of(grid_cage(1), moved_by(0.1f));
    s.meshes[0].materials = {0};
    s.meshes[0].name = "sheet";
    add_sphere(s, {0, 0, 0}, 1, 0);
    Problems problems;
    CHECK(displaced_materials(s, flatten(s, problems), problems) == std::vector<bool>{false});
    REQUIRE(problems.warnings().size() == 2);
    CHECK(has(problems.warnings()[0],
              "mesh 'sheet': material 'moved' has displacement, which needs "
              "subdivision"));
    CHECK(has(problems.warnings()[1], "which spheres do not take"));
    s.materials[0].displacement_scale = 0;
    Problems none;
    displaced_materials(s, flatten(s, none), none);
    CHECK(none.warnings().empty());
}
