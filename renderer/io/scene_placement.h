#pragma once
// translate, rotate_deg, scale, matrix and 'transforms' files. Private to the scene reader.

#include <optional>
#include <string>
#include <vector>

#include "renderer/io/scene_reader.h"

namespace tessera {

/// The transform keys as they are written. Applied in the order scale, rotate (x, y, z), translate.
struct PlacementEntry {
    Double3 translate{0, 0, 0};
    Double3 rotate_deg{0, 0, 0};
    Double3 scale{1, 1, 1};
    std::optional<Matrix34> matrix;
};

const KeySet<PlacementEntry>& placement_keys();

/// a after b: p' = a (b p).
Matrix34 compose(const Matrix34& a, const Matrix34& b);
/// True when the map keeps volume: its inverse exists and is finite in floats.
bool is_invertible(const Matrix34& m);

/// The transform that table's keys say; the identity after reporting matrix beside the others, or a
/// flat one.
Matrix34 read_placement(const Value& table, const PlacementEntry& entry, const ReadContext& at);

/// Rows of 3x4 little-endian floats; empty after reporting a file that is missing, cut off, too
/// large, or has a row that is not finite or flat.
std::vector<Matrix34> read_transforms(const std::string& name, const Value& written,
                                      const ReadContext& at, SceneReader& reader);

}  // namespace tessera
