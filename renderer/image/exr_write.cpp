#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <set>

#include "renderer/api/image.h"
#include "renderer/image/atomic_file.h"
#include "renderer/image/exr_header.h"
#include "renderer/image/exr_plan.h"
#include "renderer/image/exr_strip.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxName = 31;  // longer names set a flag that older readers refuse

[[noreturn]] void fail_bug(const std::string& what) {
    throw Error(ExitCode::bug, "write_exr: " + what);
}

Imf::Compression codec_of(ExrCompression c) {
    switch (c) {
        case ExrCompression::none:
            return Imf::NO_COMPRESSION;
        case ExrCompression::zips:
            return Imf::ZIPS_COMPRESSION;
        case ExrCompression::zip:
            return Imf::ZIP_COMPRESSION;
        case ExrCompression::piz:
            return Imf::PIZ_COMPRESSION;
        case ExrCompression::dwaa:
            return Imf::DWAA_COMPRESSION;
        case ExrCompression::dwab:
            return Imf::DWAB_COMPRESSION;
    }
    return Imf::ZIP_COMPRESSION;
}

/// Cryptomatte's entries go with its layers: readers look for layers wherever they find entries.
bool belongs(const std::string& name, const LayeredImage& image, const ExrFile& file) {
    if (!name.starts_with("cryptomatte/")) return true;
    const std::string key = name.substr(0, name.rfind('/') + 1) + "name";
    for (const auto& [other, type] : image.metadata) {
        if (other != key) continue;
        for (const ExrPart& part : file.parts) {
            for (const ExrChannel& channel : part.channels)
                if (channel.name.starts_with(std::get<std::string>(type))) return true;
        }
    }
    return false;
}

Imf::Header make_header(const LayeredImage& image, const ExrFile& file, const ExrPart& part,
                        float dwa_level) {
    Imf::Header header = exr_header(image.width, image.height, image.window, image.working_space);
    header.compression() = codec_of(part.compression);
    if (is_lossy(part.compression)) header.dwaCompressionLevel() = dwa_level;
    for (const ExrChannel& channel : part.channels) {
        if (channel.name.empty() || channel.name.size() > kMaxName)
            fail_bug("channel name '" + channel.name + "' must have 1 to 31 bytes");
        if (header.channels().findChannel(channel.name))
            fail_bug("two channels named '" + channel.name + "'");
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    }
    if (file.parts.size() > 1) {
        header.setType(Imf::SCANLINEIMAGE);
        header.setName(part.name);
    }
    if (&part == file.parts.data()) {
        std::vector<std::pair<std::string, MetadataValue>> metadata = image.metadata;
        std::erase_if(metadata, [&](const auto& m) { return !belongs(m.first, image, file); });
        put_metadata(metadata, header);
        put_metadata(file.metadata, header);
    }
    return header;
}

std::vector<Imf::Header> make_headers(const LayeredImage& image, const ExrFile& file,
                                      float dwa_level) {
    std::vector<Imf::Header> headers;
    std::set<std::string> names;
    for (const ExrPart& part : file.parts) {
        if (!names.insert(part.name).second) fail_bug("two parts named '" + part.name + "'");
        headers.push_back(make_header(image, file, part, dwa_level));
    }
    return headers;
}

void check_image(const LayeredImage& image) {
    const PixelWindow& w = image.window;
    if (image.width <= 0 || image.height <= 0) fail_bug("the frame is empty");
    if (w.x1 <= w.x0 || w.y1 <= w.y0) fail_bug("the pixel window is empty");
    const std::size_t pixels =
        static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
    if (image.layers.empty()) fail_bug("no channels");
    for (const Layer& layer : image.layers) {
        if (layer.channels.empty()) fail_bug("layer '" + layer.name + "' has no channels");
        if (layer.pixels.size() != pixels * layer.channels.size())
            fail_bug("layer '" + layer.name + "' does not fill its window");
    }
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

/// Lines of a chunk.
int chunk_lines(ExrCompression c) {
    switch (c) {
        case ExrCompression::none:
        case ExrCompression::zips:
            return 1;
        case ExrCompression::zip:
            return 16;
        case ExrCompression::piz:
        case ExrCompression::dwaa:
            return 32;
        case ExrCompression::dwab:
            break;
    }
    return 256;
}

/// Compares the first and last lines with what was meant; of a lossy part only that they decode.
void check_part(Imf::InputPart& in, const Imf::Header& meant, const ExrPart& part, ExrStrip& strip,
                const std::string& target) {
    const Imf::Header& found = in.header();
    if (!in.isComplete()) fail_output(target, "read back incomplete");
    if (found.dataWindow() != meant.dataWindow() ||
        found.displayWindow() != meant.displayWindow() ||
        found.compression() != meant.compression() || !(found.channels() == meant.channels()))
        fail_output(target, "the header read back differs");
    const int y0 = meant.dataWindow().min.y;
    const int y1 = meant.dataWindow().max.y + 1;
    const int chunk = chunk_lines(part.compression);
    const int last = y0 + (y1 - 1 - y0) / chunk * chunk;
    for (const int from : {y0, last}) {
        const int to = std::min(from + chunk, y1);
        WriteReport ignored;
        strip.clear();
        strip.fill(from, to, ignored);
        const std::vector<char> wanted = strip.bytes();
        strip.clear();
        in.setFrameBuffer(frame_of(strip, part.channels, meant.dataWindow(), from));
        in.readPixels(from, to - 1);
        if (!is_lossy(part.compression) && strip.bytes() != wanted)
            fail_output(target, "the pixels read back differ");
    }
}

/// Re-opens the file. Each write was checked, so what is left to find is a file that a library or
/// file system closed short or mixed up; the headers, the complete offset tables and both ends of
/// each part tell, at the cost of two chunks.
void check_written(const AtomicFile& file, const std::vector<Imf::Header>& meant,
                   const ExrFile& plan, const PixelWindow& window) {
    Imf::MultiPartInputFile in(file.temp_path().c_str(), 0);
    if (in.parts() != static_cast<int>(meant.size()))
        fail_output(file.target(), "read back with another number of parts");
    for (std::size_t i = 0; i < meant.size(); ++i) {
        Imf::InputPart part(in, static_cast<int>(i));
        ExrStrip strip(plan.parts[i].channels, window);
        check_part(part, meant[i], plan.parts[i], strip, file.target());
    }
}

template <class Out>
void write_part(Out& out, const ExrPart& part, const PixelWindow& window, WriteReport& report) {
    ExrStrip strip(part.channels, window);
    const Imath::Box2i box({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1});
    for (int y = window.y0; y < window.y1;) {
        const int to = std::min(y + ExrStrip::kMaxLines, window.y1);
        strip.fill(y, to, report);
        out.setFrameBuffer(frame_of(strip, part.channels, box, y));
        out.writePixels(to - y);
        y = to;
    }
}

void write_file(AtomicFile& file, const std::vector<Imf::Header>& headers, const ExrFile& plan,
                const PixelWindow& window, int threads, WriteReport& report) {
    ExrStream stream(file);
    if (headers.size() == 1) {
        Imf::OutputFile out(stream, headers[0], threads);
        write_part(out, plan.parts[0], window, report);
        return;
    }
    Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()), false,
                                 threads);
    for (std::size_t i = 0; i < headers.size(); ++i) {
        Imf::OutputPart part(out, static_cast<int>(i));
        write_part(part, plan.parts[i], window, report);
    }
}

}  // namespace

WriteReport write_exr(const LayeredImage& image, const std::string& path,
                      const WriteOptions& options) {
    WriteReport report;
    try {
        check_image(image);
        const std::vector<ExrFile> plans = plan_exr(image, path, options);
        std::vector<std::vector<Imf::Header>> headers;
        for (const ExrFile& plan : plans)
            headers.push_back(make_headers(image, plan, options.dwa_level));
        const int threads = exr_threads(options.threads);
        std::vector<std::unique_ptr<AtomicFile>> files;
        for (std::size_t i = 0; i < plans.size(); ++i) {
            files.push_back(std::make_unique<AtomicFile>(plans[i].path));
            AtomicFile& file = *files.back();
            write_file(file, headers[i], plans[i], image.window, threads, report);
            report.bytes += file.finish();
            check_written(file, headers[i], plans[i], image.window);
            report.files.push_back(plans[i].path);
        }
        for (const auto& file : files) file->commit();
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
