#include "renderer/cli/pass_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "renderer/cli/progress.h"
#include "renderer/image/atomic_file.h"

namespace tessera {
namespace {

constexpr double kApart = 1.25;  // the last passes before a time is up are of a sample each

}  // namespace

PassFiles::PassFiles(std::string folder, Describe describe)
    : folder_(std::move(folder)), describe_(std::move(describe)) {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) fail_output(folder_, failed.message());
}

void PassFiles::write(RenderResult&& result) {
    if (result.stats.spp < kApart * last_spp_) return;
    last_spp_ = result.stats.spp;
    describe_(result);
    WriteOptions options;
    options.all_float = true;
    options.compression = ExrCompression::none;
    options.threads = result.stats.threads;
    const std::string name = fmt::format("{}/{:06}", folder_, last_spp_);
    result.stats.memory_peak = peak_memory();
    write_exr(result.image, name + ".exr", options);
    write_text_file(to_json(result.stats), name + ".json");
}

void write_text_file(const std::string& text, const std::string& path) {
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.finish();
    file.commit();
}

}  // namespace tessera
