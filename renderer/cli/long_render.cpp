#include "renderer/cli/long_render.h"

#include <charconv>
#include <filesystem>

#include "renderer/api/error.h"
#include "renderer/core/log.h"
#include "renderer/film/film_file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSamples = 1 << 24;

// "16:32" -> {16, 32}
std::pair<int, int> parse_range(const std::string& text) {
    int first = 0, last = 0;
    const char* const end = text.data() + text.size();
    const auto [colon, code] = std::from_chars(text.data(), end, first);
    const bool begun = code == std::errc() && colon != end && *colon == ':';
    const auto [stop, code2] = std::from_chars(begun ? colon + 1 : end, end, last);
    if (!begun || code2 != std::errc() || stop != end || first < 0 || last <= first ||
        last > kMaxSamples)
        throw Error(ExitCode::usage, "--samples " + text +
                                         ": must be A:B, samples A to B-1 of each pixel, with 0 <= "
                                         "A < B <= 16777216, for example 16:32");
    return {first, last};
}

bool is_there(const std::string& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code ignored;
    return a == b || (!a.empty() && !b.empty() &&
                      fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored));
}

}  // namespace

void LongRenderOptions::add_to(Command app) {
    Option file =
        app.option("--checkpoint", checkpoint,
                   "Film file (.tsf) to save to while rendering and at the end, for --resume");
    app.option("--checkpoint-every", checkpoint_s,
               "Seconds between two (default 60, or more where saving would cost over 1 % of the "
               "time)")
        .in(0.01, 1e8)
        .needs(file);
    app.option("--resume", resume,
               "Film file to go on from; if it is that of --checkpoint it need not be there "
               "yet");
    app.option("--samples", samples,
               "Only samples A to B-1 of each pixel, A:B; with -o PART.tsf for tessera merge");
}

void LongRenderOptions::apply(std::optional<int>& spp, const std::string& output) {
    if (!samples.empty()) {
        if (spp) throw Error(ExitCode::usage, "--samples says how many: leave --spp out");
        const auto [first, last] = parse_range(samples);
        first_sample = first;
        spp = last - first;
    }
    if (!resume.empty() && !is_there(resume) &&
        (same_file(resume, checkpoint) || same_file(resume, output))) {
        log_info("note: " + resume + " is not there yet; starting anew");
        resume.clear();
    }
    if (!resume.empty()) read_film_header(resume);
    // One file under two names would have two writers.
    if (same_file(checkpoint, output)) checkpoint = output;
    if (checkpoint.empty() || !is_there(checkpoint) || same_file(checkpoint, resume)) return;
    try {
        read_film_header(checkpoint);
    } catch (const Error& e) {
        throw Error(ExitCode::usage, std::string("--checkpoint would replace a file: ") + e.what());
    }
    log_warning("checkpoint " + checkpoint +
                " is there already and will be replaced (--resume goes on from it)");
}

std::vector<OutputFile> LongRenderOptions::outputs(const std::string& output) const {
    // A part may be its own checkpoint.
    if (names_film_file(output) && same_file(checkpoint, output)) return {};
    return {{checkpoint, "--checkpoint", {}}};
}

}  // namespace tessera
