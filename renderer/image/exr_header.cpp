#include "renderer/image/exr_header.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>

#include "renderer/core/parallel.h"
#include "renderer/image/working_space.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxName = 31;  // longer names set a flag that older readers refuse

[[noreturn]] void fail_bug(const std::string& what) {
    throw Error(ExitCode::bug, "write_exr: " + what);
}

struct PutAttribute {
    Imf::Header& header;
    const std::string& name;
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(const std::string& value) const {
        header.insert(name, Imf::StringAttribute(value));
    }
};

}  // namespace

void ExrStream::write(const char bytes[], int count) {
    file_.write(bytes, static_cast<std::size_t>(count));
}

std::uint64_t ExrStream::tellp() { return file_.position(); }

void ExrStream::seekp(std::uint64_t position) { file_.seek(position); }

Imf::Header exr_header(int width, int height, const PixelWindow& w,
                       const std::string& working_space) {
    const Imath::Box2i display({0, 0}, {width - 1, height - 1});
    const Imath::Box2i data({w.x0, w.y0}, {w.x1 - 1, w.y1 - 1});
    Imf::Header header(display, data);
    header.lineOrder() = Imf::INCREASING_Y;
    if (const auto xy = chromaticities_of(working_space)) {
        const Chromaticities& c = *xy;
        Imf::addChromaticities(
            header, Imf::Chromaticities({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}));
    }
    return header;
}

void put_metadata(const std::vector<std::pair<std::string, MetadataValue>>& metadata,
                  Imf::Header& header) {
    for (const auto& [name, value] : metadata) {
        if (name.empty() || name.size() > kMaxName)
            fail_bug("metadata name '" + name + "' must have 1 to 31 bytes");
        if (header.find(name) != header.end()) fail_bug("metadata name '" + name + "' is taken");
        std::visit(PutAttribute{header, name}, value);
    }
}

int exr_threads(int asked) {
    const int threads = std::clamp(asked > 0 ? asked : available_threads().threads, 1, 16);
    // The pool grows and never shrinks under another writer.
    if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
    return threads;
}

}  // namespace tessera
