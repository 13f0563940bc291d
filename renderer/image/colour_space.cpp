#include "renderer/image/colour_space.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <mutex>

#include "renderer/api/error.h"
#include "renderer/core/log.h"
#include "renderer/image/colour_names.h"
#include "renderer/image/ocio_config.h"
#include "renderer/image/working_space.h"

namespace tessera {
namespace {

/// Inverse of srgb_to_linear, clamped to 0..1; NaN gives 0.
float encode_srgb(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

std::string quoted(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
    return text;
}

}  // namespace

float srgb_to_linear(float encoded) noexcept {
    // IEC 61966-2-1; OpenColorIO's smooth join differs by less than 1e-6 in the linear part.
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

struct ColorSpaces::Impl {
    std::string working;    // "lin_rec709" or "acescg"
    std::string in_config;  // the same, as the config names it
    std::string file;       // $OCIO
    Chromaticities chromaticities{};
    mutable std::once_flag once;
    mutable std::unique_ptr<OcioConfig> ocio;
    mutable std::atomic<bool> awake = false;

    const OcioConfig& config() const {
        std::call_once(once, [this] {
            ocio = std::make_unique<OcioConfig>(file);
            awake = true;
        });
        return *ocio;
    }

    /// The working space in a user's config: by name, else what that config renders in.
    std::string find_working() const {
        if (const auto found = config().find(working)) return *found;
        const auto role = config().find("scene_linear");
        if (!role)
            throw Error(ExitCode::scene, "colour config '" + file + "': no space '" + working +
                                             "' and no role 'scene_linear'");
        log_warning("colour config '" + file + "': no space '" + working + "', taking '" + *role +
                    "' (its scene_linear) for it");
        return *role;
    }

    bool is_plain_view(const std::string& view) const {
        return file.empty() && working == kLinRec709 && (view.empty() || view == "Standard");
    }
};

ColorSpaces::ColorSpaces(const std::string& working_space) : impl_(std::make_unique<Impl>()) {
    impl_->working = own_name(working_space);
    const auto xy = chromaticities_of(impl_->working);
    if (!xy)
        throw Error(ExitCode::scene, "working space '" + working_space +
                                         "': unknown, must be 'lin_rec709' or 'acescg'");
    impl_->chromaticities = *xy;
    const char* file = std::getenv("OCIO");
    if (file) impl_->file = file;
    impl_->in_config = impl_->file.empty() ? impl_->working : impl_->find_working();
}

ColorSpaces::~ColorSpaces() = default;

void ColorSpaces::to_working(std::span<float> rgb, const std::string& from) const {
    const std::string name = own_name(from);
    if (from.empty() || name == impl_->working || name == kRaw) return;
    if (is_plain_srgb(from)) {
        for (float& value : rgb) value = srgb_to_linear(value);
        return;
    }
    const OcioConfig& config = impl_->config();
    const auto found = config.find(from);
    if (!found) {
        const std::vector<std::string> known = config.spaces();
        const std::string near = nearest_name(from, known);
        throw Error(ExitCode::scene, "colour space '" + from + "': unknown (" +
                                         (near.empty() ? "the config has " + quoted(known)
                                                       : "did you mean '" + near + "'?") +
                                         ")");
    }
    if (*found == impl_->in_config || config.is_data(*found)) return;
    config.convert(rgb, *found, impl_->in_config);
}

bool ColorSpaces::is_plain_srgb(const std::string& from) const {
    return impl_->file.empty() && impl_->working == kLinRec709 && own_name(from) == kSrgbTexture;
}

void ColorSpaces::to_display(std::span<float> rgb, const std::string& view) const {
    if (impl_->is_plain_view(view)) {
        for (float& value : rgb) value = encode_srgb(value);
        return;
    }
    const OcioConfig& config = impl_->config();
    const std::vector<std::string> views = config.views();
    if (!view.empty() && std::find(views.begin(), views.end(), view) == views.end())
        throw Error(ExitCode::usage,
                    "view '" + view + "': unknown, the config has " + quoted(views));
    config.display(rgb, impl_->in_config, view);
    for (float& value : rgb) value = value > 0 ? std::min(value, 1.0f) : 0.0f;
}

bool ColorSpaces::awake() const noexcept { return impl_->awake; }

std::span<const float> ColorSpaces::chromaticities() const noexcept {
    return impl_->chromaticities;
}

}  // namespace tessera
