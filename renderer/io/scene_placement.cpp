#include "renderer/io/scene_placement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace tessera {
namespace {

static_assert(std::endian::native == std::endian::little,
              "transforms files are read as they lie on disk");

constexpr std::size_t kRowBytes = 12 * sizeof(float);
constexpr std::uintmax_t kMaxRows = std::uintmax_t(1) << 24;

struct SinCos {
    double sin = 0;
    double cos = 1;
};

/// Exact at multiples of 90 degrees, so that turned boxes stay aligned to the axes.
SinCos sin_cos_deg(double degrees) {
    const double turn = std::fmod(degrees, 360.0);
    const double quarters = turn / 90.0;
    if (quarters == std::round(quarters)) {
        constexpr double kSine[4] = {0, 1, 0, -1};
        const auto q = static_cast<std::size_t>((static_cast<int>(quarters) + 4) % 4);
        return {kSine[q], kSine[(q + 1) % 4]};
    }
    const double radians = turn * (std::numbers::pi / 180.0);
    return {std::sin(radians), std::cos(radians)};
}

Matrix34 rotation(const Double3& degrees) {
    const auto [sx, cx] = sin_cos_deg(degrees[0]);
    const auto [sy, cy] = sin_cos_deg(degrees[1]);
    const auto [sz, cz] = sin_cos_deg(degrees[2]);
    const Matrix34 x{1, 0, 0, 0, 0, cx, -sx, 0, 0, sx, cx, 0};
    const Matrix34 y{cy, 0, sy, 0, 0, 1, 0, 0, -sy, 0, cy, 0};
    const Matrix34 z{cz, -sz, 0, 0, sz, cz, 0, 0, 0, 0, 1, 0};
    return compose(z, compose(y, x));
}

std::string row_problem(const Matrix34& m) {
    const auto usable = [](double v) {
        return std::isfinite(v) && std::abs(v) <= Limits::kLargest;
    };
    if (!std::all_of(m.begin(), m.end(), usable))
        return "has a number that is not finite or beyond 1e12";
    return is_invertible(m) ? "" : "is flat (its 3x3 part has no inverse)";
}

}  // namespace

const KeySet<PlacementEntry>& placement_keys() {
    using P = PlacementEntry;
    static const KeySet<P> keys{
        {"placement",
         {
             key("translate", &P::translate, "Moves by [x, y, z], after rotate_deg."),
             key("rotate_deg", &P::rotate_deg,
                 "Turns about the fixed axes x, then y, then z, after scale."),
             uniform_key("scale", &P::scale, "Number or [x, y, z]; negative mirrors."),
             key("matrix", &P::matrix, "3 rows of 4, instead of the three above."),
         }}};
    return keys;
}

Matrix34 compose(const Matrix34& a, const Matrix34& b) {
    Matrix34 m{};
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
            double sum = c == 3 ? a[4 * r + 3] : 0;
            for (std::size_t k = 0; k < 3; ++k) sum += a[4 * r + k] * b[4 * k + c];
            m[4 * r + c] = sum;
        }
    }
    return m;
}

bool is_invertible(const Matrix34& m) {
    const double det = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                       m[2] * (m[4] * m[9] - m[5] * m[8]);
    double columns = 1;
    for (std::size_t c = 0; c < 3; ++c) columns *= std::hypot(m[c], m[4 + c], m[8 + c]);
    constexpr double kFlat =
        1e-9;  // share of the volume that its columns would span at right angles
    constexpr double kTiny = 1e-30;  // a volume whose inverse leaves the range of floats
    return std::abs(det) > kFlat * columns && std::abs(det) > kTiny;
}

Matrix34 read_placement(const Value& table, const PlacementEntry& entry, const ReadContext& at) {
    Matrix34 m = kIdentity34;
    SourceLoc loc = table.loc;
    if (entry.matrix) {
        loc = table.find("matrix")->loc;
        for (const char* name : {"translate", "rotate_deg", "scale"}) {
            const Value* also = table.find(name);
            if (also)
                at.problems.error(also->loc,
                                  at.subject + ": give matrix or " + name + ", not both");
        }
        m = *entry.matrix;
    } else {
        if (const Value* scale = table.find("scale")) loc = scale->loc;
        m = rotation(entry.rotate_deg);
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) m[4 * r + c] *= entry.scale[c];
            m[4 * r + 3] = entry.translate[r];
        }
    }
    if (is_invertible(m)) return m;
    at.problems.error(loc, at.subject + ": the transform is flat (" +
                               (entry.matrix ? "matrix" : "scale") + " leaves no volume)");
    return kIdentity34;
}

std::vector<Matrix34> read_transforms(const std::string& name, const Value& written,
                                      const ReadContext& at, SceneReader& reader) {
    const std::string what = at.subject + ": transforms file '" + name + "' ";
    const auto fail = [&](const std::string& why) {
        at.problems.error(written.loc, what + why);
        return std::vector<Matrix34>();
    };
    const AssetPath found = reader.find(name, written.loc);
    if (found.path.empty()) return fail(found.reason);
    if (!found.note.empty()) at.problems.note(written.loc, at.subject + ": " + found.note);
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(found.path, failed);
    if (failed) return fail("cannot be read");
    if (size == 0 || size % kRowBytes != 0) {
        return fail("has " + std::to_string(size) +
                    " bytes, must be a multiple of 48 (3x4 floats each)");
    }
    if (size / kRowBytes > kMaxRows) return fail("has more than 16 777 216 rows");
    std::ifstream in(found.path, std::ios::binary);
    std::vector<Matrix34> rows;
    rows.reserve(size / kRowBytes);
    std::array<char, kRowBytes> bytes{};
    while (rows.size() < size / kRowBytes) {
        if (!in.read(bytes.data(), kRowBytes)) return fail("cannot be read");
        std::array<float, 12> floats{};
        std::memcpy(floats.data(), bytes.data(), kRowBytes);
        Matrix34 m{};
        std::copy(floats.begin(), floats.end(), m.begin());
        const std::string problem = row_problem(m);
        if (!problem.empty()) return fail("row " + std::to_string(rows.size()) + " " + problem);
        rows.push_back(m);
    }
    reader.add_file(found.path);
    return rows;
}

}  // namespace tessera
