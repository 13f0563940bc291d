#pragma once
// tinyobjloader, behind plain types: its .cpp is the only one that sees it. Both functions expect
// text that a normaliser made.

#include <cstdint>
#include <streambuf>
#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFFu;

/// Indices from 0; kNoIndex where there is none. Not yet checked against the end of the arrays.
struct ObjCorner {
    std::uint32_t position = kNoIndex, uv = kNoIndex, normal = kNoIndex;
};

struct ObjNumbers {
    std::vector<double> positions;  // x y z
    std::vector<float> uvs;         // u v
    std::vector<float> normals;     // x y z, as written
    std::vector<ObjCorner> corners;
    std::vector<std::uint64_t> face_end;  // per face: one past its last corner
};

/// Parses v, vt, vn and f lines; polygons of any size.
ObjNumbers parse_obj(std::streambuf& text);

/// A map_ statement.
struct MtlTexture {
    std::string file;  // empty: not given
    Float2 scale{1, 1};
    Float2 offset{0, 0};
    bool clamp = false;
    float base = 0, gain = 1;  // -mm
    float bump = 1;            // -bm
    char channel = 'm';        // -imfchan
    std::string color_space;
};

/// One material. What the file does not say keeps the value here; MtlBlock::given tells which were
/// said.
struct MtlValues {
    Float3 kd{0, 0, 0}, ks{0, 0, 0}, ke{0, 0, 0}, tf{0, 0, 0}, ka{0, 0, 0};
    float ns = 0, ni = 0, d = 1;
    int illum = 0;
    float pr = 0, pm = 0, aniso = 0, ps = 0, pc = 0, pcr = 0;
    MtlTexture map_kd, map_ks, map_ke, map_d, map_pr, map_pm, map_ps, norm, bump, disp;
};

/// Parses the lines of one material (without newmtl).
MtlValues parse_mtl(const std::string& text);

}  // namespace tessera
