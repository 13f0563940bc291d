#include "renderer/image/deep_reader.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStandardAttributes.h>

#include <cmath>
#include <new>
#include <numeric>

#include "renderer/image/check/deep_chunks.h"
#include "renderer/image/exr_limits.h"
#include "renderer/image/image_format.h"
#include "renderer/image/working_space.h"

namespace tessera {
namespace {

constexpr std::size_t kChannels = 6;
constexpr std::array<const char*, kChannels> kNames{"R", "G", "B", "A", "Z", "ZBack"};
constexpr std::uint64_t kMaxLineSamples = std::uint64_t(1) << 26;

void check(const std::string& path) {
    if (sniff_image(path) != ImageFormat::exr) fail_image(path, "it is not an OpenEXR file");
    const RawExr raw = read_raw_exr(path);
    if (!raw.damage.empty()) fail_image(path, raw.damage);
    const RawPart& part = raw.parts[0];
    if (!part.deep) fail_image(path, "it is not deep");
    if (part.tiled) fail_image(path, "it has deep tiles; deep scanlines are read");
    if (!part.data.sane() || !part.display.sane()) fail_image(path, "its windows are impossible");
    const std::string damage = deep_damage(path, raw);
    if (!damage.empty()) fail_image(path, damage);
}

template <class F>
auto guarded(const std::string& path, const F& f) {
    try {
        return f();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, "image '" + path + "': out of memory");
    } catch (const std::exception& error) {
        fail_image(path, error.what());
    }
}

}  // namespace

struct DeepReader::File {
    Imf::MultiPartInputFile file;
    Imf::DeepScanLineInputPart part;
    Imf::DeepFrameBuffer frame;
    std::vector<std::uint32_t> counts;
    std::array<std::vector<float>, kChannels> planes;
    std::array<std::vector<char*>, kChannels> pointers;

    explicit File(const std::string& path) : file(path.c_str(), 0), part(file, 0) {}

    bool has(std::size_t channel) const { return !pointers[channel].empty(); }

    // One line's pointers serve all lines: its stride is 0.
    void attach(const PixelWindow& window) {
        const auto width = static_cast<std::size_t>(window.width());
        counts.resize(width);
        const auto base = [&](void* first, std::size_t stride) {
            return reinterpret_cast<char*>(
                reinterpret_cast<std::uintptr_t>(first) -
                static_cast<std::uintptr_t>(window.x0 * static_cast<std::int64_t>(stride)));
        };
        frame.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, base(counts.data(), sizeof counts[0]), sizeof counts[0], 0));
        for (std::size_t c = 0; c < kChannels; ++c) {
            if (!part.header().channels().findChannel(kNames[c])) continue;
            pointers[c].resize(width);
            frame.insert(kNames[c],
                         Imf::DeepSlice(Imf::FLOAT, base(pointers[c].data(), sizeof(char*)),
                                        sizeof(char*), 0, sizeof(float)));
        }
        part.setFrameBuffer(frame);
    }

    void read(int y) {
        part.readPixelSampleCounts(y);
        const std::uint64_t samples =
            std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
        if (samples > kMaxLineSamples)
            throw std::runtime_error("line " + std::to_string(y) + " has more than 2^26 samples");
        for (std::size_t c = 0; c < kChannels; ++c) {
            if (!has(c)) continue;
            planes[c].assign(static_cast<std::size_t>(samples) + 1, 0.0f);
            float* to = planes[c].data();
            for (std::size_t x = 0; x < counts.size(); to += counts[x++])
                pointers[c][x] = reinterpret_cast<char*>(to);
        }
        part.readPixels(y);
    }
};

DeepReader::DeepReader(const std::string& path) : path_(path) {
    limit_exr_windows();
    check(path);
    guarded(path, [&] {
        file_ = std::make_unique<File>(path);
        const Imf::Header& header = file_->part.header();
        const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
        window_ = {data.min.x - display.min.x, data.min.y - display.min.y,
                   data.max.x - display.min.x + 1, data.max.y - display.min.y + 1};
        if (display.min != Imath::V2i(0, 0))
            fail_image(path, "its display window does not begin at 0,0");
        width_ = display.max.x + 1, height_ = display.max.y + 1;
        file_->attach(window_);
        for (std::size_t c = 0; c + 1 < kChannels; ++c)
            if (!file_->has(c))
                fail_image(path, std::string("it has no channel '") + kNames[c] + "'");
        working_space_ = "lin_rec709";
        if (Imf::hasChromaticities(header)) {
            const Imf::Chromaticities& c = Imf::chromaticities(header);
            working_space_ = working_space_of(Chromaticities{
                c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y});
        }
    });
}

DeepReader::~DeepReader() = default;

void DeepReader::read(int y, DeepLine& line) {
    guarded(path_, [&] { file_->read(y); });
    const auto& planes = file_->planes;
    line.counts = file_->counts;
    line.values.clear();
    for (std::size_t x = 0; x < line.counts.size(); ++x) {
        for (std::uint32_t s = 0; s < line.counts[x]; ++s) {
            const std::size_t i = line.values.size();
            DeepValue v{planes[4][i], file_->has(5) ? planes[5][i] : planes[4][i], {}};
            const auto fail = [&](const std::string& what) {
                fail_image(path_, "pixel " + std::to_string(window_.x0 + static_cast<int>(x)) +
                                      "," + std::to_string(y) + ", sample " + std::to_string(s) +
                                      ": " + what);
            };
            if (std::isnan(v.z) || std::isnan(v.z_back) || v.z == -INFINITY)
                fail("its depth is no number");
            if (v.z_back < v.z) v.z_back = v.z;  // readers are to take it so
            for (std::size_t c = 0; c < 4; ++c) {
                v.rgba[c] = planes[c][i];
                if (!std::isfinite(v.rgba[c])) fail("its colour is no number");
            }
            if (v.rgba[3] < 0) fail("its alpha is negative");
            line.values.push_back(v);
        }
    }
}

}  // namespace tessera
