#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/describe_picture.h"
#include "renderer/cli/output_check.h"
#include "renderer/cli/output_options.h"
#include "renderer/cli/picture_files.h"
#include "renderer/cli/say_error.h"
#include "renderer/core/log.h"
#include "renderer/core/parallel.h"
#include "renderer/error/estimate.h"
#include "renderer/film/film_file.h"
#include "renderer/film/film_parts.h"
#include "renderer/film/mattes.h"

namespace tessera {
namespace {

struct MergeOptions {
    std::vector<std::string> parts;
    std::string output, preview, deep, view, crypto_manifest = "embedded";
    OutputOptions out;
    std::optional<int> spp;
    bool partial = false, quiet = false;
};

struct Part {
    std::string path;
    FilmHeader header;
    SampleBox box;
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ExitCode::scene, message); }

// By sample, then place: what comes out does not depend on the order of the arguments.
std::vector<Part> read_parts(const MergeOptions& o) {
    std::vector<Part> parts;
    for (const std::string& path : o.parts) {
        if (std::filesystem::path(path).extension() == ".exr")
            refuse(path + ": is a picture, whose sums are rounded; render parts with -o PART" +
                   kFilmExtension);
        Part part{path, read_film_header(path), {}};
        const FilmHeader& h = part.header;
        if (h.least != h.most && !o.partial)
            refuse(
                fmt::format("{}: is unfinished: some pixels have {} samples, others {} (render "
                            "--resume finishes it; --allow-partial takes it as it is)",
                            path, h.least, h.most));
        part.box = {h.window, h.first_sample, h.first_sample + static_cast<int>(h.most)};
        if (!parts.empty()) {
            if (const auto d = difference(parts.front().header, h))
                refuse(fmt::format("{}: does not belong to {}: its {} is {}, there {}", path,
                                   parts.front().path, d->what, d->b, d->a));
        }
        parts.push_back(std::move(part));
    }
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return std::tuple(a.box.first, a.box.window.y0, a.box.window.x0) <
               std::tuple(b.box.first, b.box.window.y0, b.box.window.x0);
    });
    return parts;
}

// What the parts should fill.
SampleBox whole_of(const std::vector<SampleBox>& boxes, const FilmHeader& h,
                   const MergeOptions& o) {
    SampleBox all = bounds(boxes);
    if (!names_film_file(o.output)) {
        all.first = 0;
        // Ranges of one window are a picture of it; what was cut up is the frame.
        const bool one_window = std::all_of(boxes.begin(), boxes.end(), [&](const SampleBox& b) {
            return b.window == boxes.front().window;
        });
        if (!one_window)
            all = bounds(std::vector<SampleBox>{all, {{0, 0, h.width, h.height}, 0, all.last}});
    }
    if (o.spp && all.last > *o.spp)
        refuse(fmt::format("the parts have {} samples per pixel, --spp says {}", all.last, *o.spp));
    if (o.spp) all.last = *o.spp;
    return all;
}

std::string list(const std::vector<SampleBox>& boxes) {
    constexpr std::size_t kShown = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(boxes.size(), kShown); ++i)
        text += (i ? "; " : "") + to_string(boxes[i]);
    return boxes.size() > kShown ? text + fmt::format("; and {} more", boxes.size() - kShown)
                                 : text;
}

// Whether nothing is missing. Throws for what cannot be merged.
bool check(const std::vector<Part>& parts, const std::vector<SampleBox>& boxes,
           const SampleBox& whole, const MergeOptions& o) {
    if (const auto both = overlap(boxes)) {
        const auto [a, b] = *both;
        refuse(fmt::format("{} and {} both have {}", parts[a].path, parts[b].path,
                           to_string(intersection(boxes[a], boxes[b]))));
    }
    const bool even = std::all_of(parts.begin(), parts.end(),
                                  [](const Part& p) { return p.header.least == p.header.most; });
    const std::vector<SampleBox> holes = missing(whole, boxes);
    if (holes.empty() && even) return true;
    if (names_film_file(o.output))
        refuse(holes.empty() ? "unfinished parts make no film file, only a picture"
                             : "a film file has no holes, but missing are " + list(holes));
    if (!o.partial)
        refuse("missing are " + list(holes) +
               " (--allow-partial makes a picture of what there is)");
    if (!holes.empty()) log_warning("missing are " + list(holes));
    return false;
}

FilmFile merge(const std::vector<Part>& parts, const SampleBox& whole) {
    const FilmHeader& first = parts.front().header;
    FilmFile all{first, Film(whole.window, first.passes, first.extras)};
    FilmHeader& h = all.header;
    h.window = whole.window;
    h.seconds = 0, h.parts = 0;
    for (const Part& part : parts) {
        const FilmFile file = read_film_file(part.path);
        if (difference(h, file.header) || file.header.window != part.header.window ||
            file.header.most != part.header.most)
            refuse(part.path + ": changed while it was read");
        all.film.merge(file.film);
        h.first_sample = std::min(h.first_sample, file.header.first_sample);
        h.seconds += file.header.seconds;
        h.parts += file.header.parts;
    }
    const SampleCounts counts = sample_range(all.film);
    h.least = counts.least, h.most = counts.most;
    return all;
}

// What a render of the whole would say of itself.
Statistics statistics_of(const FilmHeader& h, bool complete) {
    Statistics s;
    s.version = h.version;
    s.scene = h.scene;
    s.isa = h.isa;
    s.seed = h.seed;
    s.spp = static_cast<int>(h.most);
    s.first_sample = h.first_sample;
    s.render_s = h.seconds;
    s.complete = complete;
    return s;
}

ErrorEstimate error_of(const Film& film) {
    if (film.replicates().counts.empty()) return {};
    Workers workers;
    return estimate_error(film.replicates(), workers);
}

LayeredImage picture_of(FilmFile& all) {
    const FilmHeader& h = all.header;
    LayeredImage image;
    image.width = h.width, image.height = h.height;
    image.window = h.window;
    image.working_space = h.working_space;
    image.layers = all.film.layers(all.film.window());
    image.metadata = h.metadata;
    std::vector<std::string> notes;
    add_mattes(all.film, h.ids, image.layers, notes);
    if (all.film.deep()) note_crowds(*all.film.deep(), notes);
    for (const std::string& n : notes) log_info("note: " + n);
    return image;
}

WriteReport write(FilmFile& all, bool complete, const MergeOptions& o, const std::string& command) {
    const bool film = names_film_file(o.output);
    if (film) write_film_file(o.output, all.header, all.film);
    SceneDesc format;
    o.out.apply(format);
    LayeredImage image;
    if (!film || !o.preview.empty() || !o.deep.empty()) image = picture_of(all);
    Statistics stats = statistics_of(all.header, complete);
    stats.error = error_of(all.film);
    if (stats.error.asked) log_info("error    " + to_text(stats.error));
    describe_picture(image, all.header.scene_hash, stats, command, format.output);
    if (!format.output.deterministic_metadata)
        image.metadata.emplace_back("tessera/parts", all.header.parts);
    WriteReport report = write_picture_files(
        image, {o.output, o.preview, o.view, format.output, o.crypto_manifest == "sidecar"});
    if (!o.deep.empty()) {
        DeepImage deep = all.film.deep_image();
        deep.width = all.header.width, deep.height = all.header.height;
        deep.working_space = all.header.working_space;
        write_deep_file(image, deep, o.deep, write_options(format.output, 0), report);
    }
    return report;
}

int run_merge(const MergeOptions& o, const std::string& command) {
    set_log_level(o.quiet ? LogLevel::quiet : LogLevel::normal);
    const std::vector<OutputFile> outputs{{o.output, "--output", {".exr", kFilmExtension}},
                                          {o.preview, "--preview", {".png", ".jpg", ".jpeg"}},
                                          {o.deep, "--deep", {".exr"}}};
    check_outputs(outputs);
    const std::vector<Part> parts = read_parts(o);
    if (!o.deep.empty() && !parts.front().header.extras.deep)
        refuse("--deep: " + parts.front().path + " keeps no depths; render parts with --deep too");
    if (!o.preview.empty()) check_view(parts.front().header.working_space, o.view);
    std::vector<SampleBox> boxes;
    for (const Part& p : parts) boxes.push_back(p.box);
    SampleBox whole = whole_of(boxes, parts.front().header, o);
    const bool complete = check(parts, boxes, whole, o);
    if (!complete) whole.window = bounds(boxes).window;
    FilmFile all = merge(parts, whole);
    const WriteReport written = write(all, complete, o, command);
    log_info(fmt::format("merged   {} parts, {} spp, into {} ({:.1f} MiB){}", parts.size(),
                         all.header.most, names(written.files),
                         static_cast<double>(written.bytes) / (1 << 20),
                         complete ? "" : ", partial"));
    return static_cast<int>(ExitCode::done);
}

}  // namespace

void add_merge(Command app, CommandLine& line) {
    Command sub =
        app.add_command("merge", "Join parts of a picture (.tsf): ranges of samples, crops, tiles");
    auto o = std::make_shared<MergeOptions>();
    sub.option("parts", o->parts, "Film files, written by render -o PART.tsf or --checkpoint")
        .required();
    sub.option("-o,--output", o->output, "The EXR to write, or a .tsf to merge further").required();
    sub.option("--preview", o->preview, "Also a .png or .jpg for the eye");
    sub.option("--deep", o->deep, "Also a deep EXR, of parts that were rendered with --deep");
    sub.option("--view", o->view, "OpenColorIO view of the preview (default: the config's)");
    sub.option("-s,--spp", o->spp, "Samples per pixel that there must be").in(1, 1 << 24);
    sub.flag("--allow-partial", o->partial,
             "A picture of what there is, though samples or pixels are missing");
    o->out.add_format_to(sub);
    sub.option("--crypto-manifest", o->crypto_manifest,
               "Cryptomatte's names in the header or in files beside it: embedded, sidecar")
        .one_of({"embedded", "sidecar"});
    sub.flag("-q,--quiet", o->quiet, "Say nothing but errors");
    sub.footer(
        "Example:\n"
        "  tessera render scene.toml --samples 0:32 -o a.tsf\n"
        "  tessera render scene.toml --samples 32:64 -o b.tsf      (on another machine)\n"
        "  tessera merge a.tsf b.tsf -o out.exr                    (the bits of --spp 64)");
    sub.when_chosen([o, &line] { line.run = [o, &line] { return run_merge(*o, line.text); }; });
}

}  // namespace tessera
