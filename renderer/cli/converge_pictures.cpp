#include "renderer/cli/converge_pictures.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "renderer/cli/compare_sides.h"
#include "renderer/compare/heat_map.h"
#include "renderer/image/eight_bit.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// And the file is gone.
std::string take_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    std::error_code ignored;
    fs::remove(path, ignored);
    return bytes.str();
}

std::string heat_bytes(std::span<const float> values, const ErrorMaps& maps,
                       const std::string& folder) {
    const std::string path = folder + "/map.jpg";
    write_eight_bit(heat_map(values), maps.width, maps.height, path);
    return take_bytes(path);
}

double value_of(const ComparedLayer& layer, Metric metric) {
    const auto& v = layer.sides[0].values[static_cast<std::size_t>(metric)];
    return v ? v->mean : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Measured measure(const std::string& picture, const std::string& reference, int threads, bool maps,
                 const std::string& folder) {
    CompareRequest request;
    request.sides = {{picture}};
    request.reference = reference;
    request.layers = {"beauty"};
    request.maps = maps;
    request.threads = threads;
    const Comparison c = compare_pictures(request);
    Measured out;
    out.truth = {value_of(c.layers[0], Metric::rmse), value_of(c.layers[0], Metric::relmse),
                 value_of(c.layers[0], Metric::flip)};
    if (maps) {
        out.relative = heat_bytes(on_log_scale(c.maps.relative[0]), c.maps, folder);
        out.flip = heat_bytes(c.maps.flip[0], c.maps, folder);
    }
    return out;
}

std::string as_png(const std::string& picture, const std::string& folder) {
    const ComparedPicture read = read_compared(picture);
    const std::string path = folder + "/picture.png";
    write_preview(read.image, path);
    return take_bytes(path);
}

PictureFrame frame_of(const std::string& picture) {
    const ComparedPicture read = read_compared(picture);
    return {read.image.width, read.image.height, read.encoded};
}

}  // namespace tessera
