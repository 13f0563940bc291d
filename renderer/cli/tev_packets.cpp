#include "renderer/cli/tev_packets.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace tessera {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers go out as they lie in memory");

class Packet {
public:
    Packet(std::uint8_t type, const std::string& name) : bytes_(sizeof(std::uint32_t), '\0') {
        bytes_.push_back(static_cast<char>(type));
        bytes_.push_back('\0');  // leave the focus where it is
        text(name);
    }
    Packet& number(std::int32_t value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    Packet& names(const std::vector<std::string>& channels) {
        number(static_cast<std::int32_t>(channels.size()));
        for (const std::string& c : channels) text(c);
        return *this;
    }
    Packet& pixels(const std::vector<float>& values) {
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
        return *this;
    }
    std::string take() {
        const auto size = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &size, sizeof size);
        return std::move(bytes_);
    }

private:
    void text(const std::string& s) { bytes_.append(s.c_str(), std::strlen(s.c_str()) + 1); }

    std::string bytes_;
};

constexpr std::uint8_t kCreateImage = 4, kUpdateImageV2 = 5;

}  // namespace

std::string tev_create(const std::string& name, int width, int height,
                       const std::vector<std::string>& channels) {
    return Packet(kCreateImage, name).number(width).number(height).names(channels).take();
}

std::string tev_update(const std::string& name, const std::vector<std::string>& channels,
                       const LivePicture::Piece& piece) {
    const PixelWindow& w = piece.window;
    return Packet(kUpdateImageV2, name)
        .names(channels)
        .number(w.x0)
        .number(w.y0)
        .number(w.width())
        .number(w.height())
        .pixels(piece.pixels)
        .take();
}

}  // namespace tessera
