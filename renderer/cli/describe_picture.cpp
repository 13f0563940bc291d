#include "renderer/cli/describe_picture.h"

#include <unistd.h>

#include <array>
#include <ctime>

#include "renderer/cli/say_error.h"

namespace tessera {
namespace {

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// UTC, as OpenEXR's capDate is written.
std::string date_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    std::array<char, 32> text{};
    if (!::gmtime_r(&now, &utc)) return {};
    std::strftime(text.data(), text.size(), "%Y:%m:%d %H:%M:%S", &utc);
    return text.data();
}

}  // namespace

void describe_picture(LayeredImage& image, const std::string& scene_hash, const Statistics& s,
                      const std::string& command, const OutputDesc& format) {
    auto& m = image.metadata;
    m.emplace_back("tessera/version", s.version);
    m.emplace_back("tessera/scene", s.scene);
    m.emplace_back("tessera/sceneHash", scene_hash);
    m.emplace_back("tessera/spp", s.spp);
    if (s.first_sample > 0) m.emplace_back("tessera/firstSample", s.first_sample);
    m.emplace_back("tessera/seed", std::to_string(s.seed));
    m.emplace_back("tessera/embreeIsa", s.isa);
    m.emplace_back("tessera/colorSpace", image.working_space);
    if (!s.complete) m.emplace_back("tessera/partial", 1);
    add_error_metadata(image, s.error);
    if (format.deterministic_metadata) return;
    m.emplace_back("tessera/seconds", static_cast<float>(s.resumed_s + s.render_s));
    if (s.threads > 0) m.emplace_back("tessera/threads", s.threads);
    m.emplace_back("tessera/command", command);
    m.emplace_back("tessera/host", host_name());
    m.emplace_back("capDate", date_now());
    m.emplace_back("utcOffset", 0.0f);
}

}  // namespace tessera
