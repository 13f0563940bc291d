#include "renderer/io/scene_environment.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <tuple>

#include "renderer/io/light_group_key.h"
#include "renderer/io/params.h"
#include "renderer/io/texture_files.h"

namespace tessera {
namespace {

/// The environment as it is written: radiance and scale multiply.
struct EnvironmentEntry {
    EnvironmentDesc environment;
    double scale = 1;
};

std::vector<std::string> map_projections() {
    return {"automatic",   "latlong", "cube_cross_horizontal", "cube_cross_vertical", "cube_strip",
            "mirror_ball", "angular"};
}

const KeySet<EnvironmentDesc>& environment_part() {
    using E = EnvironmentDesc;
    static const KeySet<E> keys{
        {"environment",
         {
             key("file", &E::file, "Image of all directions, y up; its middle looks along -z."),
             key("faces", &E::faces,
                 "Six images in its place: +x -x +y -y +z -z as seen from inside."),
             key("camera", &E::camera, "Image that camera rays see in place of file."),
             key("lighting", &E::lighting, "Image that surfaces are lit by in place of file."),
             key("reflection", &E::reflection,
                 "Image that mirrors, gloss and glass show in place of file."),
             choice("projection", &E::projection, map_projections(),
                    "How the image shows all directions; automatic: by its shape."),
             key("radiance", &E::radiance,
                 "Radiance from everywhere, W/m2/sr; with a file, a factor on the image.",
                 kAtLeast0),
             key("rotate_deg", &E::rotate_deg, "Turn about +y."),
             key("color_space", &E::color_space,
                 "Colour space of the image; absent: the working space."),
             key("visible", &E::visible, "Seen by camera rays."),
             light_group_key(&E::light_group),
         }}};
    return keys;
}

const KeySet<EnvironmentEntry>& environment_rows() {
    static const KeySet<EnvironmentEntry> keys = [] {
        KeySet<EnvironmentEntry> rows{{"environment", {}}};
        add_part(rows, environment_part(), &EnvironmentEntry::environment);
        rows.list.keys.push_back(
            key("scale", &EnvironmentEntry::scale, "Factor on the radiance.", kAtLeast0));
        return rows;
    }();
    return keys;
}

/// The sky as it is written.
struct SkyEntry {
    SkyDesc sky;
    double latitude_deg = 0, longitude_deg = 0;
    std::string time;
};

const KeySet<SkyDesc>& sky_part() {
    using S = SkyDesc;
    static const KeySet<S> keys{
        {"sky",
         {
             key("turbidity", &S::turbidity, "Haze: 1.8 the clearest air, 10 thick.",
                 {.low = 1.8, .high = 10}),
             key("ground_albedo", &S::ground_albedo, "What the ground sends back up.",
                 kUnitClamped),
             key("sun_elevation_deg", &S::sun_elevation_deg, "Height of the sun.",
                 {.low = -90, .high = 90}),
             key("sun_azimuth_deg", &S::sun_azimuth_deg,
                 "Direction of the sun from north (-z) by east (+x)."),
             key("sun_angle_deg", &S::sun_angle_deg, "Breadth of the sun's disc.",
                 {.low = 0.01, .high = 20}),
             key("intensity", &S::intensity, "Factor on sky and sun.", kAtLeast0),
             key("sun", &S::sun, "With the sun's disc, as a distant light."),
             key("visible", &S::visible, "Seen by camera rays."),
             light_group_key(&S::light_group),
         }}};
    return keys;
}

const KeySet<SkyEntry>& sky_rows() {
    static const KeySet<SkyEntry> keys = [] {
        KeySet<SkyEntry> rows{{"sky", {}}};
        add_part(rows, sky_part(), &SkyEntry::sky);
        auto& list = rows.list.keys;
        list.push_back(key("latitude_deg", &SkyEntry::latitude_deg, "Place, with time: north.",
                           {.low = -90, .high = 90}));
        list.push_back(key("longitude_deg", &SkyEntry::longitude_deg, "Place, with time: east.",
                           {.low = -180, .high = 180}));
        list.push_back(key("time", &SkyEntry::time,
                           "When, in place of the sun's angles: \"2026-06-21T14:30Z\", UTC."));
        return rows;
    }();
    return keys;
}

bool is_date(int year, int month, int day) {
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    return date.ok();
}

/// Nothing if it is no time at all; with day 0 if there is no such day.
std::optional<SkyDesc::PlaceAndTime> parse_time(const std::string& text) {
    SkyDesc::PlaceAndTime t;
    int hour = 0, minute = 0, second = 0, used = 0;
    const int read = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d%n", &t.year, &t.month, &t.day,
                                 &hour, &minute, &used);
    if (read != 5) return std::nullopt;
    int more = 0;
    if (std::sscanf(text.c_str() + used, ":%2d%n", &second, &more) == 1) used += more;
    const std::string rest = text.substr(static_cast<std::size_t>(used));
    const bool good = (rest.empty() || rest == "Z") && t.year >= 1900 && t.year <= 2100 &&
                      t.month >= 1 && t.month <= 12 && t.day >= 1 && t.day <= 31 && hour >= 0 &&
                      hour < 24 && minute >= 0 && minute < 60 && second >= 0 && second < 61;
    if (!good) return std::nullopt;
    if (!is_date(t.year, t.month, t.day)) t.day = 0;
    t.hour = hour + minute / 60.0 + second / 3600.0;
    return t;
}

/// The path of the image that a key names; "" after an error.
std::string find_image(const std::string& key, const std::string& file, const Value& written,
                       SceneReader& reader, const ReadContext& at) {
    const TextureFiles files = find_texture_files(
        reader.assets, file, reader.folder_of(written.loc), reader.scene.render.frame);
    const AssetPath& found = files.found;
    if (!files.tiles.empty()) {
        at.problems.error(written.loc,
                          at.subject + ": " + key + " '" + file + "' is a set of tiles");
        return {};
    }
    if (found.path.empty())
        at.problems.error(written.loc, at.subject + ": " + key + " '" + files.name + "' " +
                                           (files.missing.empty() ? found.reason : files.missing));
    if (!found.note.empty())
        at.problems.note(written.loc, at.subject + ": " + key + " " + found.note);
    return found.path;
}

}  // namespace

const KeySet<ReflectionMapDesc>& reflection_map_keys() {
    using R = ReflectionMapDesc;
    static const KeySet<R> keys{
        {"reflection map",
         {
             key("file", &R::file, "Image of all directions, y up; its middle looks along -z.")
                 .must(),
             choice("projection", &R::projection, map_projections(),
                    "How the image shows all directions; automatic: by its shape."),
             key("scale", &R::scale, "Factor on the image.", kAtLeast0),
             key("rotate_deg", &R::rotate_deg, "Turn about +y."),
             key("color_space", &R::color_space,
                 "Colour space of the image; absent: the working space."),
             key("position", &R::position, "Where it was taken; with radius or box."),
             key("radius", &R::radius, "Of the sphere about position whose wall it shows.",
                 kAbove0),
             key("box", &R::box, "Two corners of the box whose walls it shows."),
         }}};
    return keys;
}

std::optional<ReflectionMapDesc> read_reflection_map(const Value& value, SceneReader& reader,
                                                     const ReadContext& at) {
    ReflectionMapDesc map;
    map.loc = value.loc;
    const ReadContext here{at.problems, at.subject + ": reflection_map"};
    read_keys(value, reflection_map_keys(), map, here);
    if (map.file.empty()) return std::nullopt;  // reported as missing
    map.loc = value.find("file")->loc;
    map.file = find_image("file", map.file, *value.find("file"), reader, here);
    const auto wrong = [&](const char* key, const std::string& message) {
        at.problems.error(value.find(key)->loc, here.subject + ": " + message);
    };
    const bool walls = map.radius > 0 || map.box;
    if (map.radius > 0 && map.box) wrong("box", "radius and box both say where the walls are");
    if (walls && !value.find("position"))
        wrong(map.box ? "box" : "radius", "radius and box need a position");
    if (map.box) {
        auto& [lo, hi] = *map.box;
        for (std::size_t i = 0; i < 3; ++i) {
            if (lo[i] > hi[i]) std::swap(lo[i], hi[i]);
            if (!(lo[i] < hi[i])) return wrong("box", "the box is flat"), std::nullopt;
        }
    }
    return map;
}

void read_environment(const Value& table, SceneReader& reader) {
    const ReadContext at{reader.problems, "environment"};
    EnvironmentEntry entry;
    read_keys(table, environment_rows(), entry, at);
    EnvironmentDesc& environment = entry.environment;
    environment.loc = table.loc;
    for (float& channel : environment.radiance) {
        channel = static_cast<float>(std::min(double(channel) * entry.scale, Limits::kLargest));
    }
    EnvironmentDesc& e = environment;
    for (const auto& [name, file, loc] : {std::tuple{"file", &e.file, &e.file_loc},
                                          {"camera", &e.camera, &e.camera_loc},
                                          {"lighting", &e.lighting, &e.lighting_loc},
                                          {"reflection", &e.reflection, &e.reflection_loc}}) {
        if (file->empty()) continue;
        *loc = table.find(name)->loc;
        *file = find_image(name, *file, *table.find(name), reader, at);
    }
    if (!environment.faces.empty()) {
        const Value& written = *table.find("faces");
        environment.faces_loc = written.loc;
        if (environment.faces.size() != 6 || !environment.file.empty()) {
            at.problems.error(
                written.loc, "environment: faces are six images, and there is no file beside them");
            environment.faces.clear();
        }
        for (std::string& face : environment.faces)
            face = find_image("faces", face, written, reader, at);
    }
    reader.scene.environment = environment;
}

void read_sky(const Value& table, SceneReader& reader) {
    const ReadContext at{reader.problems, "sky"};
    SkyEntry entry;
    read_keys(table, sky_rows(), entry, at);
    entry.sky.loc = table.loc;
    const Value* time = table.find("time");
    const bool place = table.find("latitude_deg") && table.find("longitude_deg");
    if (time && !entry.time.empty()) {
        entry.sky.when = parse_time(entry.time);
        if (!entry.sky.when)
            at.problems.error(time->loc, "sky: time is '" + entry.time +
                                             "', must be like \"2026-06-21T14:30Z\" (UTC)");
        else if (entry.sky.when->day == 0)
            at.problems.error(time->loc,
                              "sky: time is '" + entry.time + "', a day that there is not");
        else if (!place)
            at.problems.error(time->loc, "sky: time needs latitude_deg and longitude_deg");
        if (entry.sky.when) {
            entry.sky.when->latitude_deg = entry.latitude_deg;
            entry.sky.when->longitude_deg = entry.longitude_deg;
        }
        for (const char* angle : {"sun_elevation_deg", "sun_azimuth_deg"})
            if (const Value* other = table.find(angle))
                at.problems.error(other->loc, std::string("sky: ") + angle +
                                                  " and time both say where the sun is");
    } else if (table.find("latitude_deg") || table.find("longitude_deg")) {
        at.problems.error(table.loc, "sky: latitude_deg and longitude_deg need a time");
    }
    if (reader.scene.environment)
        at.problems.error(table.loc, "sky: there is an [environment] already");
    reader.scene.sky = entry.sky;
}

const KeyList& environment_keys() { return environment_rows().list; }
const KeyList& sky_keys() { return sky_rows().list; }

}  // namespace tessera
