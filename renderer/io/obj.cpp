#include "renderer/io/obj.h"

#include <filesystem>

#include "renderer/io/mtl.h"
#include "renderer/io/obj_checks.h"
#include "renderer/io/obj_mesh.h"
#include "renderer/io/obj_normalise.h"
#include "renderer/io/obj_normals.h"
#include "renderer/io/obj_parse.h"
#include "renderer/io/obj_text.h"

namespace tessera {
namespace {

struct ObjContent {
    ObjNumbers numbers;
    ObjStatements statements;
};

// The text is gone when this returns: the mesh is built in the memory it leaves.
ObjContent read_obj(const std::string& path, Tally& tally, const ObjOptions& options) {
    FileBytes file = read_regular_file(path);
    if (!file.error.empty())
        throw Error(ExitCode::scene, options.from, "'" + path + "' cannot be read: " + file.error);
    const std::string text = to_utf8(std::move(file.bytes));
    ObjNormaliser normaliser(text, tally);
    ObjContent out;
    out.numbers = parse_obj(normaliser);
    out.statements = normaliser.take();
    if (out.numbers.face_end.size() != out.statements.face_lines.size() ||
        out.numbers.positions.size() / 3 < out.statements.colors.size() / 3)
        throw Error(ExitCode::bug, {tally.file()}, "the parser and the normaliser disagree");
    return out;
}

std::string plural(std::uint64_t count, const std::string& one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string no_faces(const ObjRemainder& remainder) {
    if (remainder.faces_seen > 0)
        return "none of its " + plural(remainder.faces_seen, "face") + " can be used";
    std::string text = "no faces found";
    if (remainder.points_and_lines > 0)
        text += " (points and lines are not rendered)";
    else if (remainder.not_understood > 0)
        text += " (" + plural(remainder.not_understood, "line") +
                " not understood; is this an OBJ file?)";
    return text;
}

// A file in order that merely holds nothing to render: only lines or points, only faces without
// area, or only materials.
bool is_empty_in_order(const ObjRemainder& remainder, std::uint64_t degenerate) {
    if (remainder.faces_seen > 0) return remainder.faces_seen == degenerate;
    if (remainder.points_and_lines > 0) return true;
    return remainder.materials_named > 0 && remainder.not_understood == 0 &&
           remainder.vertices == 0;
}

void remark(const ObjMesh& built, const ObjRemainder& remainder, Problems& problems,
            const SourceLoc& loc) {
    if (built.degenerate > 0)
        problems.note(loc, plural(built.degenerate, "face") + " without area dropped");
    if (built.fanned > 0)
        problems.warn(loc, plural(built.fanned, "polygon") + " too tangled to split well");
    if (remainder.points_and_lines > 0)
        problems.note(loc,
                      plural(remainder.points_and_lines, "point or line element") + " ignored");
    if (remainder.not_understood > 0) {
        const SourceLoc first{loc.file, static_cast<int>(remainder.first_not_understood_line), 0};
        problems.note(first, plural(remainder.not_understood, "line") +
                                 " not understood, the first starts with " +
                                 remainder.first_not_understood);
    }
}

int default_material(const ObjMaterialUse& use, const ObjOptions& options, Tally& tally,
                     SceneDesc& scene) {
    MaterialDesc grey;
    grey.name = use.line > 0 ? use.name : "(no material)";
    grey.specular_weight.value = 0;
    // A stand-in without a place: the scene's own definition follows.
    const bool defined = use.line > 0 && options.defined.contains(use.name);
    if (!defined) grey.loc = {tally.file(), static_cast<int>(use.line), 0};
    if (use.line > 0 && !defined)
        tally.add("no mtllib defines the material, grey is used:", use.line, "'" + use.name + "'");
    scene.materials.push_back(std::move(grey));
    return static_cast<int>(scene.materials.size() - 1);
}

}  // namespace

int load_obj(const std::string& path, const AssetRules& assets, SceneDesc& scene,
             Problems& problems, const ObjOptions& options) {
    const SourceLoc loc{std::make_shared<const std::string>(path), 0, 0};
    Tally tally(problems, loc.file);
    auto [numbers, statements] = read_obj(path, tally, options);
    scene.files.push_back(path);

    check_faces(numbers, statements, tally);
    statements.face_lines = {};
    resolve_normals(numbers, statements);
    const std::vector<ObjLibrary> libraries = std::move(statements.libraries);
    const ObjRemainder remainder = statements.remainder;
    const std::string stem = std::filesystem::path(path).stem().string();
    ObjMesh built = build_obj_mesh(std::move(numbers), std::move(statements), stem);
    MeshDesc& mesh = built.mesh;
    remark(built, remainder, problems, loc);
    if (mesh.triangles == 0 && mesh.quads == 0) {
        if (!is_empty_in_order(remainder, built.degenerate)) {
            tally.finish();
            std::string text = to_string(loc) + ": " + no_faces(remainder);
            for (const std::string& line : problems.errors()) text += "\n" + line;
            for (const std::string& line : problems.warnings())
                if (line.starts_with(path)) text += "\n" + line;
            throw Error(ExitCode::scene, text);
        }
        problems.warn(loc, no_faces(remainder));
    }

    MtlLibraries materials(assets, scene, problems);
    for (const ObjLibrary& library : libraries)
        materials.add(library.text, path, library.line, tally);
    Tally unresolved(problems, loc.file, Problems::kMax);
    for (const ObjMaterialUse& use : built.materials) {
        int material = use.line > 0 ? materials.material(use.name) : -1;
        if (material < 0) material = default_material(use, options, unresolved, scene);
        MaterialDesc& desc = scene.materials[static_cast<std::size_t>(material)];
        desc.use_vertex_color = !mesh.colors.empty() && desc.base_color.texture < 0;
        mesh.materials.push_back(material);
    }
    materials.finish();
    unresolved.finish();
    tally.finish();
    mesh.name = stem;
    mesh.loc = loc;
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size() - 1);
}

}  // namespace tessera
