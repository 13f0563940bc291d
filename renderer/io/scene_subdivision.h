#pragma once
// The keys of a [[mesh]] that have it subdivided. Private to the scene reader.

#include "renderer/io/params.h"

namespace tessera {

const KeySet<SubdivisionDesc>& subdivision_rows();
/// Sets the place; reports keys that contradict each other or do nothing.
void check_subdivision(const Value& table, SubdivisionDesc& desc, const ReadContext& at);
/// Whether two make the same of a mesh.
bool alike(const SubdivisionDesc& a, const SubdivisionDesc& b);

}  // namespace tessera
