#include <array>
#include <cmath>

#include "renderer/io/scene_environment.h"
#include "renderer/io/scene_reader.h"

namespace tessera {
namespace {

constexpr Limits kDepth{.low = 0, .high = 10000};
constexpr Limits kFrame{.low = -1e6, .high = 1e6};
constexpr Limits kSeed{.low = 0, .high = 9.2e18};
constexpr std::int64_t kMaxPixels = std::int64_t(1) << 30;

const KeySet<CameraDesc>& camera_rows() {
    using C = CameraDesc;
    static const KeySet<C> keys{
        {"camera",
         {
             key("position", &C::position, "Where the camera stands."),
             key("look_at", &C::look_at, "The point in the middle of the picture."),
             key("up", &C::up, "What points upward in the picture."),
             key("matrix", &C::matrix,
                 "Camera to world, 3 rows of 4 (x right, y up, looks along -z), instead of "
                 "position, look_at and up."),
             choice("projection", &C::projection,
                    {"perspective", "orthographic", "latlong", "cube"},
                    "How depth is drawn; latlong and cube: all directions around the position, to "
                    "be an environment's file."),
             key("fov_deg", &C::fov_deg, "Field of view, perspective only.",
                 {.low = 0, .high = 180, .open_low = true, .open_high = true}),
             choice("fov_axis", &C::fov_axis, {"vertical", "horizontal"},
                    "The side of the picture fov_deg spans."),
             key("ortho_height", &C::ortho_height,
                 "Height of the picture in scene units, orthographic only.", kAbove0),
             key("aperture_radius", &C::aperture_radius,
                 "Radius of the lens in scene units; 0 is a pinhole.", kAtLeast0),
             key("focus_distance", &C::focus_distance,
                 "Distance of what is sharp; 0 is the distance to look_at.", kAtLeast0),
         }}};
    return keys;
}

/// The film as it is written; FilmDesc keeps its resolution in two members.
struct FilmEntry {
    FilmDesc film;
    std::array<int, 2> resolution{960, 540};
};

const KeySet<FilmDesc>& film_part() {
    using F = FilmDesc;
    static const KeySet<F> keys = [] {
        KeySet<F> rows{
            {"film",
             {
                 key("crop", &F::crop,
                     "Only these pixels: [x0, y0, x1, y1], x1 and y1 excluded, y downward.",
                     {.low = 0, .high = 65536}),
                 key("overscan", &F::overscan,
                     "Share of width and height rendered beyond each edge of the frame.", kUnit),
                 key("overscan_px", &F::overscan_px,
                     "The same in pixels, one number for all edges.", {.low = 0, .high = 16384}),
                 choice("filter", &F::filter, {"box", "triangle", "gaussian", "blackman_harris"},
                        "Pixel filter."),
                 key("filter_width_px", &F::filter_width_px, "Full width of the filter in pixels.",
                     {.low = 0, .high = 32, .open_low = true}),
                 word("working_space", &F::working_space, {"lin_rec709", "acescg"},
                      "The linear colour space of every colour in the scene and of the picture."),
                 key("aovs", &F::aovs,
                     "Layers beside beauty: passes, presets, 'light_groups', 'PASS@groups', "
                     "'NAME = LIGHT PATH EXPRESSION'; none named: Z, N, P and albedo; 'beauty' "
                     "alone: no other."),
                 key("ao_distance", &F::ao_distance,
                     "How far ambient occlusion looks, scene units; 0: without end.", kAtLeast0),
             }}};
        return rows;
    }();
    return keys;
}

const KeySet<FilmEntry>& film_rows() {
    static const KeySet<FilmEntry> keys = [] {
        KeySet<FilmEntry> rows{{"film", {}}};
        rows.list.keys.push_back(key("resolution", &FilmEntry::resolution,
                                     "Width and height in pixels.", {.low = 1, .high = 65536}));
        add_part(rows, film_part(), &FilmEntry::film);
        return rows;
    }();
    return keys;
}

const KeySet<RenderDesc>& render_rows() {
    using R = RenderDesc;
    static const KeySet<R> keys{
        {"render",
         {
             choice("integrator", &R::integrator, {"path", "whitted"}, "How light is followed."),
             key("spp", &R::spp, "Samples per pixel.", {.low = 1, .high = 1 << 24}),
             key("seed", &R::seed, "Another seed, another noise.", kSeed),
             key("max_depth", &R::max_depth, "Bounces in all.", kDepth),
             key("max_diffuse_depth", &R::max_diffuse_depth, "Diffuse bounces.", kDepth),
             key("max_glossy_depth", &R::max_glossy_depth, "Glossy and mirror bounces.", kDepth),
             key("max_transmission_depth", &R::max_transmission_depth, "Passages through surfaces.",
                 kDepth),
             key("min_depth", &R::min_depth, "No path is ended by chance before this many bounces.",
                 kDepth),
             key("frame", &R::frame, "Frame of image sequences.", kFrame),
         }}};
    return keys;
}

Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Double3& v) { return std::hypot(v[0], v[1], v[2]); }

void check_view(const Value& table, CameraDesc& camera, const ReadContext& at) {
    const Double3& from = camera.position;
    const Double3& to = camera.look_at;
    const Double3 view{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double distance = length(view);
    if (distance == 0)
        return at.problems.error(table.loc, "camera: position and look_at are the same point");
    const auto parallel = [&] {
        return length(cross(view, camera.up)) <= 1e-9 * distance * length(camera.up);
    };
    if (!table.find("up") && parallel()) camera.up = {0, 0, -1};
    if (parallel())
        at.problems.error(table.loc,
                          "camera: up is parallel to the line of sight, give another up");
}

void check_matrix(const Value& table, const CameraDesc& camera, const ReadContext& at) {
    const Matrix34& m = *camera.matrix;
    const Double3 x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
    const Double3 side = cross(x, y);
    const double volume = std::abs(side[0] * z[0] + side[1] * z[1] + side[2] * z[2]);
    if (!(volume > 1e-9 * length(x) * length(y) * length(z))) {
        at.problems.error(table.find("matrix")->loc,
                          "camera: matrix is flat, its first 3 columns span no space");
    }
    for (const char* name : {"position", "look_at", "up"}) {
        const Value* also = table.find(name);
        if (also)
            at.problems.error(also->loc,
                              std::string("camera: give matrix or ") + name + ", not both");
    }
}

// What is written for another projection.
void note_unused(const Value& table, Projection projection, const ReadContext& at) {
    struct Row {
        const char* camera;
        std::vector<const char*> unused;
    };
    static const std::array<Row, 4> rows{{
        {"a perspective camera", {"ortho_height"}},
        {"an orthographic camera", {"fov_deg"}},
        {"a latlong camera", {"fov_deg", "ortho_height", "look_at", "up"}},
        {"a cube camera", {"fov_deg", "ortho_height", "look_at", "up"}},
    }};
    const Row& row = rows[static_cast<std::size_t>(projection)];
    for (const char* name : row.unused) {
        if (const Value* found = table.find(name))
            at.problems.note(found->loc,
                             std::string("camera: ") + name + " has no effect on " + row.camera);
    }
}

void read_camera(const Value& table, SceneReader& reader) {
    const ReadContext at{reader.problems, "camera"};
    CameraDesc& camera = reader.scene.camera;
    camera.loc = table.loc;
    read_keys(table, camera_rows(), camera, at);
    const bool map = shows_all_directions(camera.projection);
    camera.automatic =
        !table.find("position") && (map || !table.find("look_at")) && !table.find("matrix");
    if (map) set_map_size(camera.projection, reader.scene.film);
    if (camera.matrix) {
        check_matrix(table, camera, at);
    } else if (!map && !camera.automatic) {
        check_view(table, camera, at);
    } else if (const Value* up = map ? nullptr : table.find("up")) {
        at.problems.warn(up->loc, "camera: up has no effect without position or look_at");
    }
    note_unused(table, camera.projection, at);
}

void read_film(const Value& table, SceneReader& reader) {
    const ReadContext at{reader.problems, "film"};
    FilmDesc& film = reader.scene.film;
    FilmEntry entry;
    entry.resolution = {film.width, film.height};
    read_keys(table, film_rows(), entry, at);
    film = entry.film;
    film.loc = film.aovs_loc = table.loc;
    if (const Value* aovs = table.find("aovs")) film.aovs_loc = aovs->loc;
    film.width = entry.resolution[0];
    film.height = entry.resolution[1];
    const std::string size = std::to_string(film.width) + " x " + std::to_string(film.height);
    if (std::int64_t(film.width) * film.height > kMaxPixels) {
        const Value* found = table.find("resolution");
        at.problems.error(found->loc,
                          "film: resolution is " + size + ", must be at most 2^30 pixels in all");
    }
    if (film.overscan > 0 && film.overscan_px > 0) {
        at.problems.error(table.find("overscan_px")->loc,
                          "film: give overscan or overscan_px, not both");
    }
    if (!film.crop) return;
    const PixelWindow& crop = *film.crop;
    const bool in_frame = crop.x1 <= film.width && crop.y1 <= film.height;
    if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1 || !in_frame) {
        at.problems.error(
            table.find("crop")->loc,
            "film: crop must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1, inside " + size);
    }
}

void read_render(const Value& table, SceneReader& reader) {
    const ReadContext at{reader.problems, "render"};
    reader.scene.render.loc = table.loc;
    read_keys(table, render_rows(), reader.scene.render, at);
}

}  // namespace

void read_settings(const Value& document, SceneReader& reader) {
    if (const Value* table = document.find("camera")) read_camera(*table, reader);
    if (const Value* table = document.find("film")) read_film(*table, reader);
    if (const Value* table = document.find("output")) read_output(*table, reader);
    if (const Value* table = document.find("render")) read_render(*table, reader);
    if (const Value* table = document.find("environment")) read_environment(*table, reader);
    if (const Value* table = document.find("sky")) read_sky(*table, reader);
}

const KeyList& camera_keys() { return camera_rows().list; }
const KeyList& film_keys() { return film_rows().list; }
const KeyList& render_keys() { return render_rows().list; }

}  // namespace tessera
