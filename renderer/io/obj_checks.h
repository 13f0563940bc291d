#pragma once
// After the parser: nothing in a file reaches memory unchecked.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/io/obj_normalise.h"
#include "renderer/io/obj_parse.h"

namespace tessera {

/// Makes every index of `numbers` safe. A face that uses a vertex past the end, or one that is not
/// finite or beyond 1e15, loses all its corners (and keeps its number); a uv or normal index past
/// the end, or one of a value that is not finite, becomes kNoIndex. What is dropped is told to the
/// tally with its line.
void check_faces(ObjNumbers& numbers, const ObjStatements& statements, Tally& tally);

/// The statements in force at a face.
struct ObjState {
    std::int32_t object = -1, group = -1, material = -1;  // index of a name, -1 = none
    std::int32_t smoothing = 0;                           // 0 = off
    std::uint32_t material_line = 0;
};

/// Walks the events along with the faces.
class StatementCursor {
public:
    explicit StatementCursor(const ObjStatements& statements) : statements_(&statements) {}

    /// The state at `face`; faces must be asked in rising order.
    const ObjState& advance(std::uint32_t face);

private:
    const ObjStatements* statements_;
    std::size_t at_ = 0;
    ObjState state_;
};

}  // namespace tessera
