#include "renderer/image/check/exr_raw.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "renderer/image/image_format.h"

namespace tessera {
namespace {

constexpr std::uint32_t kTiled = 0x200, kDeep = 0x800, kMultipart = 0x1000;
constexpr std::int64_t kFar = 1 << 24;
constexpr std::size_t kMaxParts = 4096, kMaxChannels = 4096, kMaxAttributes = 65536;
constexpr std::uint64_t kMaxAttribute = std::uint64_t(256) << 20;

struct Damage : std::runtime_error {
    using runtime_error::runtime_error;
};

/// Little-endian values from a file of known size.
class Reader {
public:
    explicit Reader(const std::string& path)
        : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

    std::uint64_t left() const { return size_ - position_; }
    std::uint64_t position() const { return position_; }
    std::uint64_t size() const { return size_; }

    std::string bytes(std::uint64_t count) {
        if (count > left()) throw Damage("the file ends within its header");
        std::string out(count, '\0');
        file_.read(out.data(), static_cast<std::streamsize>(count));
        if (!file_) throw Damage("the file cannot be read");
        position_ += count;
        return out;
    }
    template <class T>
    T value() {
        T out;
        std::memcpy(&out, bytes(sizeof out).data(), sizeof out);
        return out;
    }
    /// Anywhere in the file; reading goes on where it was.
    template <class T>
    std::uint64_t peek(std::uint64_t offset) {
        T number = 0;
        file_.seekg(static_cast<std::streamoff>(offset));
        file_.read(reinterpret_cast<char*>(&number), sizeof number);
        if (!file_) throw Damage("the file cannot be read");
        file_.seekg(static_cast<std::streamoff>(position_));
        return number;
    }
    std::string word(std::size_t longest) {
        std::string out;
        while (true) {
            const char c = bytes(1)[0];
            if (c == 0) return out;
            if (out.size() == longest) throw Damage("a name in the header has no end");
            out += c;
        }
    }

private:
    std::ifstream file_;
    std::uint64_t size_ = 0, position_ = 0;
};

template <class T>
T at(const std::string& bytes, std::size_t offset) {
    if (offset + sizeof(T) > bytes.size()) throw Damage("an attribute is too short");
    T out;
    std::memcpy(&out, bytes.data() + offset, sizeof out);
    return out;
}

RawBox box(const std::string& bytes) {
    return {at<std::int32_t>(bytes, 0), at<std::int32_t>(bytes, 4),
            std::int64_t{at<std::int32_t>(bytes, 8)} + 1,
            std::int64_t{at<std::int32_t>(bytes, 12)} + 1};
}

std::vector<RawChannel> channel_list(const std::string& bytes) {
    std::vector<RawChannel> out;
    std::size_t offset = 0;
    while (at<char>(bytes, offset) != 0) {
        if (out.size() == kMaxChannels) throw Damage("it has more than 4096 channels");
        const std::size_t end = bytes.find('\0', offset);
        if (end == std::string::npos) throw Damage("the list of channels has no end");
        const auto type = at<std::int32_t>(bytes, end + 1);
        if (type < 0 || type > 2) throw Damage("a channel is of no known type");
        out.push_back({bytes.substr(offset, end - offset), static_cast<ExrType>(type),
                       at<std::int32_t>(bytes, end + 9), at<std::int32_t>(bytes, end + 13)});
        offset = end + 17;
    }
    return out;
}

void take(RawPart& part, const std::string& name, const std::string& bytes) {
    if (name == "channels") part.channels = channel_list(bytes);
    if (name == "dataWindow") part.data = box(bytes);
    if (name == "displayWindow") part.display = box(bytes);
    if (name == "compression") part.compression = at<unsigned char>(bytes, 0);
    if (name == "name") part.name = bytes;
    if (name == "type") {
        part.tiled = bytes == "tiledimage" || bytes == "deeptile";
        part.deep = bytes == "deepscanline" || bytes == "deeptile";
    }
}

/// False at the empty header that ends the list of a multi-part file.
bool read_header(Reader& in, std::uint32_t flags, RawPart& part) {
    part.tiled = (flags & kTiled) != 0;
    part.deep = (flags & kDeep) != 0;
    for (std::size_t count = 0;; ++count) {
        if (count > kMaxAttributes) throw Damage("it has too many attributes");
        const std::string name = in.word(255);
        if (name.empty()) break;
        const std::string type = in.word(255);
        const auto size = in.value<std::int32_t>();
        if (size < 0 || std::uint64_t(size) > kMaxAttribute)
            throw Damage("attribute '" + name + "' is of an impossible size");
        const std::string bytes = in.bytes(static_cast<std::uint64_t>(size));
        take(part, name, bytes);
        part.attributes[name] = {type, bytes};
    }
    if (part.attributes.empty()) return false;
    for (const char* needed : {"channels", "compression", "dataWindow", "displayWindow"}) {
        if (!part.attributes.contains(needed))
            throw Damage(std::string("the header has no ") + needed);
    }
    if (part.compression > 9) throw Damage("the codec is unknown");
    return true;
}

std::uint64_t parts_of(std::int64_t length, std::int64_t piece) {
    return static_cast<std::uint64_t>((length + piece - 1) / piece);
}

std::uint64_t count_tiles(const RawPart& part) {
    const auto tiles = part.attributes.find("tiles");
    if (tiles == part.attributes.end()) throw Damage("a tiled part does not say how");
    const std::string& bytes = tiles->second.second;
    const std::int64_t tx = at<std::uint32_t>(bytes, 0), ty = at<std::uint32_t>(bytes, 4);
    const int mode = at<unsigned char>(bytes, 8) & 15, up = at<unsigned char>(bytes, 8) >> 4;
    if (tx < 1 || ty < 1 || mode > 2 || up > 1) throw Damage("the size of tiles is impossible");
    const auto level = [&](std::int64_t side, int l) {
        const std::int64_t one = std::int64_t{1} << l;
        return std::max<std::int64_t>(up ? (side + one - 1) / one : side / one, 1);
    };
    const auto levels = [&](std::int64_t side) {
        int l = 0;
        while (up ? (std::int64_t{1} << l) < side : (std::int64_t{2} << l) <= side) ++l;
        return l + 1;
    };
    const std::int64_t w = part.data.width(), h = part.data.height();
    if (mode == 0) return parts_of(w, tx) * parts_of(h, ty);
    std::uint64_t sum = 0;
    for (int ly = 0; ly < levels(mode == 1 ? std::max(w, h) : h); ++ly) {
        if (mode == 1) {
            sum += parts_of(level(w, ly), tx) * parts_of(level(h, ly), ty);
            continue;
        }
        for (int lx = 0; lx < levels(w); ++lx)
            sum += parts_of(level(w, lx), tx) * parts_of(level(h, ly), ty);
    }
    return sum;
}

// A chunk that is missing has offset 0 or one behind the end; the last one may be there in part.
void read_table(Reader& in, bool multipart, RawPart& part) {
    part.table = in.position();
    part.chunks = part.tiled ? count_tiles(part) : parts_of(part.data.height(), part.chunk_lines());
    const std::uint64_t there = std::min(part.chunks, in.left() / 8);
    part.missing = part.chunks - there;
    std::uint64_t last = 0;
    for (std::uint64_t i = 0; i < there; ++i) {
        const auto offset = in.value<std::uint64_t>();
        if (offset == 0 || offset >= in.size())
            ++part.missing;
        else
            last = std::max(last, offset);
    }
    if (last == 0) return;
    // Before the pixels: the part's number, a line or a tile and its level, the size; of deep ones
    // the sizes of the counts, of the samples, and of these before compression.
    const std::uint64_t size_at = last + (multipart ? 4 : 0) + (part.tiled ? 16 : 4);
    const std::uint64_t end = size_at + (part.deep ? 24 : 4);
    if (end > in.size()) {
        ++part.missing;
        return;
    }
    std::uint64_t left = in.size() - end, size = 0;
    if (part.deep) {
        const auto counts = in.peek<std::uint64_t>(size_at);
        left -= std::min(left, counts);
        size = in.peek<std::uint64_t>(size_at + 8);
    } else {
        size = in.peek<std::uint32_t>(size_at);
    }
    if (left < size) ++part.missing;
}

void read_all(const std::string& path, RawExr& out) {
    if (sniff_image(path) != ImageFormat::exr) throw Damage("it is not an OpenEXR file");
    Reader in(path);
    in.bytes(4);
    const auto version = in.value<std::uint32_t>();
    if ((version & 255) != 2) throw Damage("its version of the format is unknown");
    const bool multipart = (version & kMultipart) != 0;
    do {
        RawPart part;
        if (!read_header(in, version, part)) break;
        if (out.parts.size() == kMaxParts) throw Damage("it has more than 4096 parts");
        out.parts.push_back(std::move(part));
    } while (multipart);
    if (out.parts.empty()) throw Damage("it has no header");
    for (RawPart& part : out.parts) {
        if (!part.data.sane() || !part.display.sane()) return;
        read_table(in, multipart, part);
    }
}

}  // namespace

std::string RawChannel::layer() const {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot);
}

std::string RawChannel::token() const {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
}

bool RawBox::sane() const {
    return x0 > -kFar && y0 > -kFar && x1 < kFar && y1 < kFar && x0 < x1 && y0 < y1;
}

std::string RawPart::text(const std::string& attribute) const {
    const auto found = attributes.find(attribute);
    return found != attributes.end() && found->second.first == "string" ? found->second.second
                                                                        : std::string();
}

bool RawPart::lossy(ExrType type) const {
    if (lossy()) return true;
    const bool b44 = compression == 6 || compression == 7;
    return type == ExrType::half ? b44 : type == ExrType::real && compression == 5;
}

int RawPart::chunk_lines() const {
    constexpr std::array<int, 10> kLines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return kLines[static_cast<std::size_t>(compression)];
}

RawExr read_raw_exr(const std::string& path) {
    RawExr out;
    try {
        read_all(path, out);
    } catch (const std::exception& error) {
        out.damage = error.what();
    }
    return out;
}

}  // namespace tessera
