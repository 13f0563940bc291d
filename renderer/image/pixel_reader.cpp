#include "renderer/image/pixel_reader.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/image/exr_limits.h"
#include "renderer/image/image_end.h"

namespace tessera {
namespace {

constexpr std::size_t kStripBytes = std::size_t(4) << 20;

/// OpenImageIO's name for the one reader that may touch the file.
const char* reader_of(ImageFormat format) {
    switch (format) {
        case ImageFormat::png:
            return "png";
        case ImageFormat::jpeg:
            return "jpeg";
        case ImageFormat::tiff:
            return "tiff";
        case ImageFormat::exr:
            return "openexr";
        case ImageFormat::hdr:
            return "hdr";
    }
    return "";
}

/// A library's message on one line, without the file's name that ours has already.
std::string reason(std::string text, const std::string& path) {
    for (const std::string& name : {"\"" + path + "\"", "'" + path + "'", path})
        for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
            text.replace(at, name.size(), "the file");
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    constexpr std::size_t kEnough = 200;
    if (text.size() > kEnough) text = text.substr(0, kEnough) + " ...";
    return text.empty() ? "truncated or corrupt" : "truncated or corrupt (" + text + ")";
}

/// Sub-8-bit CMYK is a known overflow in the readers that ship today.
bool is_risky(const OIIO::ImageSpec& spec) {
    return spec.get_int_attribute("oiio:BitsPerSample", 8) < 8 &&
           spec.get_string_attribute("tiff:ColorSpace") == "CMYK";
}

void check_size(const OIIO::ImageSpec& spec, const ImageLimits& limits, const std::string& path) {
    const std::int64_t width = spec.width, height = spec.height, channels = spec.nchannels;
    const std::string size = std::to_string(width) + " x " + std::to_string(height) +
                             " pixels of " + std::to_string(channels) + " channels";
    if (width <= 0 || height <= 0 || channels <= 0 || spec.depth > 1)
        fail_image(path, "it claims " + size + ", expected a flat picture of at least 1 x 1");
    const auto bytes = static_cast<std::int64_t>(spec.format.size());
    if (channels > limits.max_channels || height > limits.max_pixels / width ||
        width * height > limits.max_bytes / (channels * std::max<std::int64_t>(bytes, 1)))
        fail_image(path, "it claims " + size + ", more than the limit of " +
                             std::to_string(limits.max_pixels) + " pixels, " +
                             std::to_string(limits.max_channels) + " channels, " +
                             std::to_string(limits.max_bytes >> 20) + " MiB");
}

ImageInfo info_of(const OIIO::ImageSpec& spec, bool mipped) {
    ImageInfo info;
    info.width = spec.width;
    info.height = spec.height;
    info.channels = spec.nchannels;
    info.bits = static_cast<int>(spec.format.size()) * 8;
    info.is_float = spec.format.is_floating_point();
    info.tiled = spec.tile_width > 0 && mipped;
    return info;
}

}  // namespace

struct PixelReader::Impl {
    std::string path;
    ImageFormat format = ImageFormat::png;
    std::unique_ptr<OIIO::ImageInput> input;
    ImageInfo info;
    int alpha = -1;
    bool premultiplied = false;

    void open(const ImageLimits& limits);
    template <class T>
    void read(const std::function<void(int, std::span<const T>)>& sink);
    bool read_strip(int y0, int y1, OIIO::TypeDesc type, void* to);
    [[noreturn]] void fail() { fail_image(path, reason(input->geterror(), path)); }
};

void PixelReader::Impl::open(const ImageLimits& limits) {
    format = sniff_image(path);
    limit_exr_windows();
    if (!reaches_end(path, format)) fail_image(path, "the file is truncated");
    input = OIIO::ImageInput::create(reader_of(format));
    if (!input) fail_image(path, "no reader for it: " + OIIO::geterror());
    OIIO::ImageSpec spec, config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // values as stored
    if (!input->open(path, spec, config)) fail();
    check_size(spec, limits, path);
    if (spec.deep || is_risky(spec)) fail_image(path, "this kind of file is not supported");
    const bool mipped = spec.tile_width > 0 && input->seek_subimage(0, 1);
    if (!input->seek_subimage(0, 0)) fail();
    static_cast<void>(input->geterror());  // "no level 1" is no error of the file
    info = info_of(spec, mipped);
    alpha = spec.alpha_channel;
    premultiplied = alpha >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha", 0);
}

bool PixelReader::Impl::read_strip(int y0, int y1, OIIO::TypeDesc type, void* to) {
    const OIIO::ImageSpec& spec = input->spec();
    const int top = spec.y;
    const bool ok =
        spec.tile_width > 0
            ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, top + y0, top + y1, 0, 1, 0,
                                spec.nchannels, type, to)
            : input->read_scanlines(0, 0, top + y0, top + y1, 0, 0, spec.nchannels, type, to);
    return ok && !input->has_error();  // some readers warn of missing data and return grey
}

template <class T>
void PixelReader::Impl::read(const std::function<void(int, std::span<const T>)>& sink) {
    constexpr auto kType = std::is_same_v<T, float> ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8;
    const std::size_t row =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.channels);
    const int unit = std::max(1, input->spec().tile_height);
    const auto wanted = static_cast<int>(std::clamp<std::size_t>(
        kStripBytes / (row * sizeof(T)), 1, static_cast<std::size_t>(info.height)));
    const std::int64_t whole = (std::int64_t(wanted) + unit - 1) / unit * unit;
    const int rows = static_cast<int>(std::min<std::int64_t>(whole, info.height));
    std::vector<T> strip(row * static_cast<std::size_t>(rows));
    for (int y = 0; y < info.height;) {
        const int end = info.height - y > rows ? y + rows : info.height;
        if (!read_strip(y, end, kType, strip.data())) fail();
        sink(y, std::span<const T>(strip.data(), row * static_cast<std::size_t>(end - y)));
        y = end;
    }
}

PixelReader::PixelReader(const std::string& path, const ImageLimits& limits)
    : impl_(std::make_unique<Impl>()) {
    impl_->path = path;
    try {
        impl_->open(limits);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail_image(path, reason(error.what(), path));
    }
}

PixelReader::~PixelReader() = default;

const ImageInfo& PixelReader::info() const noexcept { return impl_->info; }
ImageFormat PixelReader::format() const noexcept { return impl_->format; }
int PixelReader::alpha_channel() const noexcept { return impl_->alpha; }
bool PixelReader::premultiplied() const noexcept { return impl_->premultiplied; }

namespace {

/// Runs a read; whatever a library throws becomes an Error.
template <class Read>
void guarded(const std::string& path, const Read& read) {
    try {
        read();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, "image '" + path + "': cannot read: out of memory");
    } catch (const std::exception& error) {
        fail_image(path, reason(error.what(), path));
    }
}

}  // namespace

void PixelReader::read_floats(const std::function<void(int, std::span<const float>)>& sink) {
    guarded(impl_->path, [&] { impl_->read<float>(sink); });
}

void PixelReader::read_bytes(const std::function<void(int, std::span<const std::uint8_t>)>& sink) {
    guarded(impl_->path, [&] { impl_->read<std::uint8_t>(sink); });
}

}  // namespace tessera
