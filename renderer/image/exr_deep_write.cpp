#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfPartType.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "renderer/image/atomic_file.h"
#include "renderer/image/deep_line.h"
#include "renderer/image/deep_reader.h"
#include "renderer/image/exr_header.h"

namespace tessera {
namespace {

constexpr std::size_t kChannels = 5;
constexpr std::array<const char*, kChannels> kNames{"R", "G", "B", "A", "Z"};
constexpr int kLinesAtOnce = 64;  // enough of them to keep every thread at work

/// The image's pixels in a window, in the form of the file.
class Lines {
public:
    Lines(const DeepImage& image, const PixelWindow& window, bool halves)
        : image_(image), window_(window), half_(halves) {
        starts_.reserve(image.counts.size());
        std::size_t at = 0;
        for (const std::uint32_t count : image.counts) {
            starts_.push_back(at);
            at += count;
        }
    }

    void append(int y, DeepLine& line, WriteReport& report) const {
        const PixelWindow& w = image_.window;
        for (int x = window_.x0; x < window_.x1; ++x) {
            std::span<const DeepSample> samples;
            if (x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1) {
                const std::size_t i =
                    static_cast<std::size_t>(y - w.y0) * static_cast<std::size_t>(w.width()) +
                    static_cast<std::size_t>(x - w.x0);
                samples = std::span(image_.samples).subspan(starts_[i], image_.counts[i]);
            }
            append_over(samples, half_, line, report);
        }
    }

private:
    const DeepImage& image_;
    PixelWindow window_;
    bool half_;
    std::vector<std::size_t> starts_;
};

/// Some lines in the types of the file, and where each pixel's samples begin.
class Strip {
public:
    Strip(const PixelWindow& window, bool halves) : window_(window), half_(halves) {}

    Imf::DeepFrameBuffer fill(const DeepLine& lines, int y0) {
        Imf::DeepFrameBuffer frame;
        counts_ = lines.counts;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, base(counts_.data(), sizeof(int), y0),
                                                sizeof(int), stride(sizeof(int))));
        for (std::size_t c = 0; c < kChannels; ++c) {
            const bool halves = half_ && c < 4;
            const std::size_t size = halves ? sizeof(Imath::half) : sizeof(float);
            planes_[c].resize((lines.values.size() + 1) * size);
            char* to = planes_[c].data();
            for (const DeepValue& v : lines.values) {
                put(c < 4 ? v.rgba[c] : v.z, halves, to);
                to += size;
            }
            pointers_[c].clear();
            char* at = planes_[c].data();
            for (const std::uint32_t count : counts_) {
                pointers_[c].push_back(at);
                at += count * size;
            }
            frame.insert(kNames[c], Imf::DeepSlice(halves ? Imf::HALF : Imf::FLOAT,
                                                   base(pointers_[c].data(), sizeof(char*), y0),
                                                   sizeof(char*), stride(sizeof(char*)), size));
        }
        return frame;
    }

private:
    static void put(float v, bool halves, char* to) {
        const Imath::half h(halves ? v : 0.0f);
        if (halves)
            std::memcpy(to, &h, sizeof h);
        else
            std::memcpy(to, &v, sizeof v);
    }
    std::size_t stride(std::size_t size) const {
        return static_cast<std::size_t>(window_.width()) * size;
    }
    // Where pixel (0, 0) would lie, as OpenEXR wants it.
    char* base(void* first, std::size_t size, int y0) const {
        const std::int64_t pixels = std::int64_t(y0) * window_.width() + window_.x0;
        return reinterpret_cast<char*>(
            reinterpret_cast<std::uintptr_t>(first) -
            static_cast<std::uintptr_t>(pixels * static_cast<std::int64_t>(size)));
    }

    PixelWindow window_;
    bool half_;
    std::vector<std::uint32_t> counts_;
    std::array<std::vector<char>, kChannels> planes_;
    std::array<std::vector<char*>, kChannels> pointers_;
};

void write_lines(AtomicFile& file, const Imf::Header& header, const Lines& lines,
                 const PixelWindow& window, bool halves, int threads, WriteReport& report) {
    ExrStream stream(file);
    Imf::DeepScanLineOutputFile out(stream, header, threads);
    Strip strip(window, halves);
    for (int y = window.y0; y < window.y1;) {
        const int to = std::min(y + kLinesAtOnce, window.y1);
        DeepLine some;
        for (int line = y; line < to; ++line) lines.append(line, some, report);
        out.setFrameBuffer(strip.fill(some, y));
        out.writePixels(to - y);
        y = to;
    }
}

/// Every chunk's place and size is looked at when the file is opened; both ends are decoded.
void check_written(const AtomicFile& file, const Lines& lines, const PixelWindow& window) {
    DeepReader in(file.temp_path());
    if (in.window() != window) fail_output(file.target(), "the header read back differs");
    for (const int y : {window.y0, window.y1 - 1}) {
        WriteReport ignored;
        DeepLine meant, found;
        lines.append(y, meant, ignored);
        in.read(y, found);
        if (found != meant) fail_output(file.target(), "the samples read back differ");
    }
}

}  // namespace

WriteReport write_deep_exr(const DeepImage& image, const PixelWindow& window,
                           const std::string& path, const WriteOptions& options) {
    WriteReport report;
    try {
        const bool halves = !options.all_float;
        Imf::Header header = exr_header(image.width, image.height, window, image.working_space);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = options.compression == ExrCompression::none ? Imf::NO_COMPRESSION
                                                                           : Imf::ZIPS_COMPRESSION;
        for (std::size_t c = 0; c < kChannels; ++c)
            header.channels().insert(kNames[c],
                                     Imf::Channel(halves && c < 4 ? Imf::HALF : Imf::FLOAT));
        put_metadata(image.metadata, header);
        const Lines lines(image, window, halves);
        AtomicFile file(path);
        write_lines(file, header, lines, window, halves, exr_threads(options.threads), report);
        report.bytes = file.finish();
        check_written(file, lines, window);
        file.commit();
        report.files = {path};
    } catch (const Error& error) {
        if (error.code() == ExitCode::scene) fail_output(path, error.what());
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, path + ": cannot write: out of memory");
    } catch (const std::exception& error) {
        fail_output(path, error.what());
    }
    return report;
}

}  // namespace tessera
