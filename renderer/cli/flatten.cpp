#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "renderer/api/deep.h"
#include "renderer/api/error.h"
#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/cli/output_check.h"
#include "renderer/core/log.h"

namespace tessera {
namespace {

struct FlattenOptions {
    std::vector<std::string> files;
    std::string output;
    bool all_float = false, quiet = false;
};

// Flat light has no depths any more.
void check_spares(const FlattenOptions& o) {
    for (const std::string& file : o.files) {
        std::error_code none;
        if (std::filesystem::equivalent(file, o.output, none))
            throw Error(ExitCode::usage, "--output " + o.output +
                                             ": would replace one of the deep files; give another "
                                             "name");
    }
}

int run_flatten(const FlattenOptions& o) {
    set_log_level(o.quiet ? LogLevel::quiet : LogLevel::normal);
    check_outputs({{o.output, "--output", {".exr"}}});
    check_spares(o);
    LayeredImage image = flatten_deep_exr(o.files);
    image.metadata.emplace_back("tessera/version", std::string(TESSERA_VERSION));
    image.metadata.emplace_back("tessera/colorSpace", image.working_space);
    WriteOptions options;
    options.all_float = o.all_float;
    const WriteReport report = write_exr(image, o.output, options);
    if (report.clamped > 0 && !o.quiet)
        log_warning(
            fmt::format("{} values are beyond half's 65504 and were clamped (--float keeps them)",
                        report.clamped));
    log_info(fmt::format("wrote    {} ({:.1f} MiB) of {} deep file{}", o.output,
                         static_cast<double>(report.bytes) / (1 << 20), o.files.size(),
                         o.files.size() == 1 ? "" : "s"));
    return 0;
}

}  // namespace

void add_flatten(Command app, CommandLine& line) {
    Command sub = app.add_command("flatten", "Merge deep EXR files by depth into a flat picture");
    auto o = std::make_shared<FlattenOptions>();
    sub.option("files", o->files, "Deep files of one frame, as render --deep writes them")
        .required();
    sub.option("-o,--output", o->output, "The EXR to write").required();
    sub.flag("--float", o->all_float, "All channels as 32-bit float");
    sub.flag("-q,--quiet", o->quiet, "Say nothing but errors");
    sub.footer(
        "Examples:\n"
        "  tessera flatten deep.exr -o flat.exr\n"
        "  tessera flatten car_deep.exr street_deep.exr -o both.exr --float");
    sub.when_chosen([o, &line] { line.run = [o] { return run_flatten(*o); }; });
}

}  // namespace tessera
