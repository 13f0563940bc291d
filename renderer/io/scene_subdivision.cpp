#include "renderer/io/scene_subdivision.h"

#include <tuple>

namespace tessera {
namespace {

/// A row whose member stands for "not given".
Key unset(Key row) {
    row.initial.clear();
    return row;
}

}  // namespace

const KeySet<SubdivisionDesc>& subdivision_rows() {
    using S = SubdivisionDesc;
    constexpr double kMostPieces = 4096, kMostTriangles = 1e9;
    static const KeySet<S> keys{
        {"subdivision",
         {
             choice("subdivision", &S::scheme, {"none", "linear", "catmull_clark"},
                    "Cuts the faces up, for displacement: linear keeps the shape, catmull_clark "
                    "makes it smooth."),
             choice("subdivision_boundary", &S::boundary, {"pin_corners", "smooth", "pin"},
                    "Open edges of catmull_clark: smooth between the surface's corners, smooth all "
                    "around, straight."),
             unset(key("subdivision_rate", &S::rate,
                       "Pieces that each edge is cut into, in place of a length.",
                       {.low = 1, .high = kMostPieces})),
             unset(key("edge_length", &S::edge_length,
                       "Length of the pieces in scene units, at the mesh's first placement.",
                       kAbove0)),
             key("edge_length_px", &S::edge_length_px,
                 "Length of the pieces in pixels of the full frame, at the nearest placement.",
                 kAbove0),
             key("subdivision_max_rate", &S::max_rate, "Most pieces of one edge.",
                 {.low = 1, .high = kMostPieces}),
             key("subdivision_max_triangles", &S::max_triangles,
                 "A mesh that would become more is refused.", {.low = 1, .high = kMostTriangles}),
         }}};
    return keys;
}

void check_subdivision(const Value& table, SubdivisionDesc& desc, const ReadContext& at) {
    const Value* scheme = table.find("subdivision");
    desc.loc = scheme ? scheme->loc : table.loc;
    if (desc.scheme == Subdivision::none) {
        for (const Key& row : subdivision_rows().list.keys) {
            const Value* written = row.name == "subdivision" ? nullptr : table.find(row.name);
            if (written)
                at.problems.warn(written->loc, at.subject + ": " + row.name +
                                                   " does nothing without subdivision");
        }
        return;
    }
    const Value* first = nullptr;
    std::string first_name;
    for (const char* name : {"subdivision_rate", "edge_length", "edge_length_px"}) {
        const Value* written = table.find(name);
        if (!written) continue;
        if (first)
            at.problems.error(written->loc,
                              at.subject + ": give " + first_name + " or " + name + ", not both");
        first = written;
        first_name = name;
    }
}

bool alike(const SubdivisionDesc& a, const SubdivisionDesc& b) {
    const auto key = [](const SubdivisionDesc& s) {
        return std::tie(s.scheme, s.boundary, s.rate, s.edge_length, s.edge_length_px, s.max_rate,
                        s.max_triangles);
    };
    return (a.scheme == Subdivision::none && b.scheme == Subdivision::none) || key(a) == key(b);
}

}  // namespace tessera
