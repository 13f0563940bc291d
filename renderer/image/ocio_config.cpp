#include "renderer/image/ocio_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include "renderer/api/error.h"
#include "renderer/image/colour_names.h"

namespace tessera {
namespace {

namespace ocio = OCIO_NAMESPACE;

ocio::BuiltinTransformRcPtr builtin(
    const char* style, ocio::TransformDirection direction = ocio::TRANSFORM_DIR_FORWARD) {
    ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
    transform->setStyle(style);
    transform->setDirection(direction);
    return transform;
}

/// Our reference space to ACES2065-1.
void append_rec709_to_aces(const ocio::GroupTransformRcPtr& group) {
    group->appendTransform(
        builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE));
    group->appendTransform(builtin("ACEScg_to_ACES2065-1"));
}

ocio::ColorSpaceRcPtr make_space(const std::string& name, const char* encoding) {
    ocio::ColorSpaceRcPtr space = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_SCENE);
    space->setName(name.c_str());
    space->setEncoding(encoding);
    for (const std::string_view alias : colour_family(name))
        if (alias != name && alias != "data")  // "data" is a role
            space->addAlias(std::string(alias).c_str());
    return space;
}

ocio::ConstTransformRcPtr rec2020_to_rec709() {
    // From the primaries of ITU-R BT.2020 and BT.709, which share the white point D65.
    constexpr double kMatrix[16] = {1.6604910021084345,
                                    -0.5876411387885495,
                                    -0.07284986331988488,
                                    0,
                                    -0.12455047452159074,
                                    1.1328998971259603,
                                    -0.008349422604369477,
                                    0,
                                    -0.018150763354905303,
                                    -0.10057889800800739,
                                    1.1187296613629127,
                                    0,
                                    0,
                                    0,
                                    0,
                                    1};
    ocio::MatrixTransformRcPtr transform = ocio::MatrixTransform::Create();
    transform->setMatrix(kMatrix);
    return transform;
}

ocio::ConstTransformRcPtr srgb_curve() {
    ocio::ExponentWithLinearTransformRcPtr transform = ocio::ExponentWithLinearTransform::Create();
    transform->setGamma({2.4, 2.4, 2.4, 1.0});
    transform->setOffset({0.055, 0.055, 0.055, 0.0});
    return transform;
}

/// Reference = lin_rec709, so that the usual conversions are one step.
ocio::ConstConfigRcPtr make_config() {
    ocio::ConfigRcPtr config = ocio::Config::CreateRaw()->createEditableCopy();
    config->setMajorVersion(2);
    config->setName("tessera");
    config->clearColorSpaces();

    const auto add = [&](std::string_view name, const char* encoding,
                         const ocio::ConstTransformRcPtr& to_reference) {
        ocio::ColorSpaceRcPtr space = make_space(std::string(name), encoding);
        if (to_reference) space->setTransform(to_reference, ocio::COLORSPACE_DIR_TO_REFERENCE);
        if (name == kRaw) space->setIsData(true);
        config->addColorSpace(space);
    };
    ocio::GroupTransformRcPtr aces = ocio::GroupTransform::Create();
    append_rec709_to_aces(aces);
    aces->setDirection(ocio::TRANSFORM_DIR_INVERSE);
    add(kLinRec709, "scene-linear", nullptr);
    add(kAcescg, "scene-linear", builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD"));
    add(kAces2065, "scene-linear", aces);
    add(kLinRec2020, "scene-linear", rec2020_to_rec709());
    add(kSrgbTexture, "sdr-video", srgb_curve());
    add(kRaw, "data", nullptr);

    ocio::GroupTransformRcPtr sdr = ocio::GroupTransform::Create();
    append_rec709_to_aces(sdr);
    sdr->appendTransform(builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"));
    sdr->appendTransform(builtin("DISPLAY - CIE-XYZ-D65_to_sRGB"));
    ocio::ColorSpaceRcPtr out = make_space("aces_sdr_srgb", "sdr-video");
    out->setTransform(sdr, ocio::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(out);

    for (const char* role : {"scene_linear", "rendering", "compositing_linear", "default"})
        config->setRole(role, kLinRec709.data());
    for (const char* role : {"color_picking", "texture_paint"})
        config->setRole(role, kSrgbTexture.data());
    config->setRole("aces_interchange", kAces2065.data());
    config->setRole("data", kRaw.data());
    config->addDisplayView("sRGB", "Standard", kSrgbTexture.data(), "");
    config->addDisplayView("sRGB", "ACES", "aces_sdr_srgb", "");
    config->setActiveDisplays("sRGB");
    config->setActiveViews("Standard, ACES");
    config->validate();
    return config;
}

void apply_to(const ocio::ConstProcessorRcPtr& processor, std::span<float> rgb) {
    if (rgb.empty()) return;
    // Lossless: the default flags take an approximate pow, and are no faster here.
    const auto cpu = processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    ocio::PackedImageDesc pixels(rgb.data(), static_cast<long>(rgb.size() / 3), 1, 3);
    cpu->apply(pixels);
}

}  // namespace

struct OcioConfig::Impl {
    std::string file;
    ocio::ConstConfigRcPtr config;

    [[noreturn]] void fail(const char* what) const {
        throw Error(ExitCode::scene,
                    "colour config '" + (file.empty() ? "built-in" : file) + "': " + what);
    }
};

OcioConfig::OcioConfig(const std::string& file) : impl_(std::make_unique<Impl>()) {
    impl_->file = file;
    try {
        ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_WARNING);
        impl_->config = file.empty() ? make_config() : ocio::Config::CreateFromFile(file.c_str());
    } catch (const std::exception& error) {
        impl_->fail(error.what());
    }
}

OcioConfig::~OcioConfig() = default;

std::optional<std::string> OcioConfig::find(const std::string& name) const {
    if (const auto space = impl_->config->getColorSpace(name.c_str())) return space->getName();
    for (const std::string_view other : colour_family(name))
        if (const auto space = impl_->config->getColorSpace(std::string(other).c_str()))
            return space->getName();
    return std::nullopt;
}

bool OcioConfig::is_data(const std::string& found) const {
    const auto space = impl_->config->getColorSpace(found.c_str());
    return space && space->isData();
}

std::vector<std::string> OcioConfig::spaces() const {
    std::vector<std::string> names;
    for (int i = 0; i < impl_->config->getNumColorSpaces(); ++i)
        names.emplace_back(impl_->config->getColorSpaceNameByIndex(i));
    return names;
}

std::vector<std::string> OcioConfig::views() const {
    const char* display = impl_->config->getDefaultDisplay();
    std::vector<std::string> names;
    for (int i = 0; i < impl_->config->getNumViews(display); ++i)
        names.emplace_back(impl_->config->getView(display, i));
    return names;
}

void OcioConfig::convert(std::span<float> rgb, const std::string& from,
                         const std::string& to) const {
    try {
        apply_to(impl_->config->getProcessor(from.c_str(), to.c_str()), rgb);
    } catch (const std::exception& error) {
        impl_->fail(error.what());
    }
}

void OcioConfig::display(std::span<float> rgb, const std::string& from,
                         const std::string& view) const {
    try {
        const char* display = impl_->config->getDefaultDisplay();
        ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
        transform->setSrc(from.c_str());
        transform->setDisplay(display);
        transform->setView(view.empty() ? impl_->config->getDefaultView(display) : view.c_str());
        apply_to(impl_->config->getProcessor(transform), rgb);
    } catch (const std::exception& error) {
        impl_->fail(error.what());
    }
}

}  // namespace tessera
