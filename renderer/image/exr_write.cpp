#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cstdint>
#include <new>

#include "renderer/api/image.h"
#include "renderer/core/parallel.h"
#include "renderer/image/atomic_file.h"
#include "renderer/image/exr_strip.h"
#include "renderer/image/working_space.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxName = 31;  // longer names set a flag that older readers refuse

[[noreturn]] void fail_bug(const std::string& what) {
    throw Error(ExitCode::bug, "write_exr: " + what);
}

/// OpenEXR's stream over an AtomicFile, so that no error of the disk is lost in a library's buffer.
class Stream : public Imf::OStream {
public:
    explicit Stream(AtomicFile& file) : OStream(file.target().c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        file_.write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return file_.position(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }

private:
    AtomicFile& file_;
};

struct PutAttribute {
    Imf::Header& header;
    const std::string& name;
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(const std::string& value) const {
        header.insert(name, Imf::StringAttribute(value));
    }
};

Imf::Header make_header(const LayeredImage& image, const std::vector<ExrChannel>& channels) {
    const PixelWindow& w = image.window;
    const Imath::Box2i display({0, 0}, {image.width - 1, image.height - 1});
    const Imath::Box2i data({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1});
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.lineOrder() = Imf::INCREASING_Y;
    for (const ExrChannel& channel : channels) {
        if (header.channels().findChannel(channel.name))
            fail_bug("two channels named '" + channel.name + "'");
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    }
    if (const auto xy = chromaticities_of(image.working_space)) {
        const Chromaticities& c = *xy;
        Imf::addChromaticities(
            header, Imf::Chromaticities({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}));
    }
    for (const auto& [name, value] : image.metadata) {
        if (name.empty() || name.size() > kMaxName)
            fail_bug("metadata name '" + name + "' must have 1 to 31 bytes");
        if (header.find(name) != header.end()) fail_bug("metadata name '" + name + "' is taken");
        std::visit(PutAttribute{header, name}, value);
    }
    return header;
}

std::vector<ExrChannel> list_channels(const LayeredImage& image, bool all_float) {
    const PixelWindow& w = image.window;
    if (image.width <= 0 || image.height <= 0) fail_bug("the frame is empty");
    if (w.x1 <= w.x0 || w.y1 <= w.y0) fail_bug("the pixel window is empty");
    const std::size_t pixels =
        static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
    std::vector<ExrChannel> list;
    for (const Layer& layer : image.layers) {
        if (layer.pixels.size() != pixels * layer.channels.size())
            fail_bug("layer '" + layer.name + "' does not fill its window");
        for (std::size_t i = 0; i < layer.channels.size(); ++i) {
            const std::string& channel = layer.channels[i];
            const std::string name = layer.name.empty() ? channel : layer.name + "." + channel;
            if (channel.empty() || name.size() > kMaxName)
                fail_bug("channel name '" + name + "' must have 1 to 31 bytes");
            list.push_back(
                {name, layer.kind == LayerKind::color && !all_float, &layer, static_cast<int>(i)});
        }
    }
    if (list.empty()) fail_bug("no channels");
    return list;
}

/// The strip's planes as OpenEXR wants them: each base is where pixel (0, 0) would lie.
Imf::FrameBuffer frame_of(ExrStrip& strip, const std::vector<ExrChannel>& channels,
                          const Imath::Box2i& window, int y0) {
    const std::int64_t width = window.max.x - window.min.x + 1;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto bytes = static_cast<std::int64_t>(strip.element_bytes(c));
        const std::int64_t origin = (y0 * width + window.min.x) * bytes;
        const auto base =
            reinterpret_cast<std::uintptr_t>(strip.plane(c)) - static_cast<std::uintptr_t>(origin);
        frame.insert(
            channels[c].name,
            Imf::Slice(channels[c].half ? Imf::HALF : Imf::FLOAT, reinterpret_cast<char*>(base),
                       static_cast<std::size_t>(bytes), static_cast<std::size_t>(bytes * width)));
    }
    return frame;
}

/// Threads for compression: no more than one file keeps busy.
int thread_count(int asked) {
    return std::clamp(asked > 0 ? asked : available_threads().threads, 1, 16);
}

/// Re-opens the file and compares header and the first and last lines with what was meant. Each
/// write was checked, so what is left to find is a file that a library or file system closed short
/// or mixed up; the header, the complete offset table and both ends tell, at the cost of two
/// chunks.
void check_written(const AtomicFile& file, const Imf::Header& meant,
                   const std::vector<ExrChannel>& channels, ExrStrip& strip) {
    Imf::InputFile in(file.temp_path().c_str(), 0);
    const Imf::Header& found = in.header();
    if (!in.isComplete()) fail_output(file.target(), "read back incomplete");
    if (found.dataWindow() != meant.dataWindow() ||
        found.displayWindow() != meant.displayWindow() || !(found.channels() == meant.channels()))
        fail_output(file.target(), "the header read back differs");
    const int y0 = meant.dataWindow().min.y;
    const int y1 = meant.dataWindow().max.y + 1;
    constexpr int kChunk = 16;  // lines of a ZIP chunk
    const int last = y0 + (y1 - 1 - y0) / kChunk * kChunk;
    for (const int from : {y0, last}) {
        const int to = std::min(from + kChunk, y1);
        WriteReport ignored;
        strip.clear();
        strip.fill(from, to, ignored);
        const std::vector<char> wanted = strip.bytes();
        strip.clear();
        in.setFrameBuffer(frame_of(strip, channels, meant.dataWindow(), from));
        in.readPixels(from, to - 1);
        if (strip.bytes() != wanted) fail_output(file.target(), "the pixels read back differ");
    }
}

void write_pixels(AtomicFile& file, const Imf::Header& header,
                  const std::vector<ExrChannel>& channels, ExrStrip& strip, int threads,
                  WriteReport& report) {
    Stream stream(file);
    Imf::OutputFile out(stream, header, threads);
    const int end = header.dataWindow().max.y + 1;
    for (int y = header.dataWindow().min.y; y < end;) {
        const int to = std::min(y + ExrStrip::kMaxLines, end);
        strip.fill(y, to, report);
        out.setFrameBuffer(frame_of(strip, channels, header.dataWindow(), y));
        out.writePixels(to - y);
        y = to;
    }
}

}  // namespace

WriteReport write_exr(const LayeredImage& image, const std::string& path,
                      const WriteOptions& options) {
    WriteReport report;
    try {
        const std::vector<ExrChannel> channels = list_channels(image, options.all_float);
        const Imf::Header header = make_header(image, channels);
        AtomicFile file(path);
        const int threads = thread_count(options.threads);
        // The pool is shared by the process: it grows and never shrinks under another writer.
        if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
        ExrStrip strip(channels, image.window);
        write_pixels(file, header, channels, strip, threads, report);
        report.bytes = file.finish();
        check_written(file, header, channels, strip);
        file.commit();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, path + ": cannot write: out of memory");
    } catch (const std::exception& error) {
        fail_output(path, error.what());
    }
    return report;
}

}  // namespace tessera
