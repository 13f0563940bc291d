#include "renderer/io/obj_parse.h"

#include <tiny_obj_loader.h>

#include <istream>
#include <map>
#include <sstream>

namespace tessera {
namespace {

static_assert(sizeof(tinyobj::real_t) == sizeof(double), "define TINYOBJLOADER_USE_DOUBLE");

ObjNumbers& numbers(void* user) { return *static_cast<ObjNumbers*>(user); }

void add_vertex(void* user, double x, double y, double z, double) {
    numbers(user).positions.insert(numbers(user).positions.end(), {x, y, z});
}

void add_normal(void* user, double x, double y, double z) {
    for (const double value : {x, y, z}) numbers(user).normals.push_back(static_cast<float>(value));
}

void add_uv(void* user, double u, double v, double) {
    for (const double value : {u, v}) numbers(user).uvs.push_back(static_cast<float>(value));
}

// Relative indices count back from what was read so far.
std::uint32_t from_zero(int index, std::size_t count) {
    if (index == 0) return kNoIndex;
    if (index > 0) return static_cast<std::uint32_t>(index - 1);
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(count) + index);
}

void add_face(void* user, tinyobj::index_t* indices, int count) {
    ObjNumbers& out = numbers(user);
    const std::size_t positions = out.positions.size() / 3;
    const std::size_t uvs = out.uvs.size() / 2;
    const std::size_t normals = out.normals.size() / 3;
    for (int i = 0; i < count; ++i) {
        out.corners.push_back({from_zero(indices[i].vertex_index, positions),
                               from_zero(indices[i].texcoord_index, uvs),
                               from_zero(indices[i].normal_index, normals)});
    }
    out.face_end.push_back(out.corners.size());
}

Float3 color(const double (&c)[3]) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

MtlTexture texture(const std::string& file, const tinyobj::texture_option_t& option) {
    MtlTexture out;
    out.file = file;
    for (std::size_t i = 0; i < 2; ++i) {
        out.scale[i] = static_cast<float>(option.scale[i]);
        out.offset[i] = static_cast<float>(option.origin_offset[i]);
    }
    out.clamp = option.clamp;
    out.base = static_cast<float>(option.brightness);
    out.gain = static_cast<float>(option.contrast);
    out.bump = static_cast<float>(option.bump_multiplier);
    out.channel = option.imfchan;
    out.color_space = option.colorspace;
    return out;
}

}  // namespace

ObjNumbers parse_obj(std::streambuf& text) {
    ObjNumbers out;
    tinyobj::callback_t callback;
    callback.vertex_cb = add_vertex;
    callback.normal_cb = add_normal;
    callback.texcoord_cb = add_uv;
    callback.index_cb = add_face;
    std::istream stream(&text);
    tinyobj::LoadObjWithCallback(stream, callback, &out);
    return out;
}

MtlValues parse_mtl(const std::string& text) {
    std::map<std::string, int> names;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    std::istringstream stream("newmtl m\n" + text);
    tinyobj::LoadMtl(&names, &materials, &stream, &warning, &error);
    const tinyobj::material_t& m = materials.front();

    MtlValues out;
    out.ka = color(m.ambient);
    out.kd = color(m.diffuse);
    out.ks = color(m.specular);
    out.ke = color(m.emission);
    out.tf = color(m.transmittance);
    out.ns = static_cast<float>(m.shininess);
    out.ni = static_cast<float>(m.ior);
    out.d = static_cast<float>(m.dissolve);
    out.illum = m.illum;
    out.pr = static_cast<float>(m.roughness);
    out.pm = static_cast<float>(m.metallic);
    out.aniso = static_cast<float>(m.anisotropy);
    out.ps = static_cast<float>(m.sheen);
    out.pc = static_cast<float>(m.clearcoat_thickness);
    out.pcr = static_cast<float>(m.clearcoat_roughness);
    out.map_kd = texture(m.diffuse_texname, m.diffuse_texopt);
    out.map_ks = texture(m.specular_texname, m.specular_texopt);
    out.map_ke = texture(m.emissive_texname, m.emissive_texopt);
    out.map_d = texture(m.alpha_texname, m.alpha_texopt);
    out.map_pr = texture(m.roughness_texname, m.roughness_texopt);
    out.map_pm = texture(m.metallic_texname, m.metallic_texopt);
    out.map_ps = texture(m.sheen_texname, m.sheen_texopt);
    out.norm = texture(m.normal_texname, m.normal_texopt);
    out.bump = texture(m.bump_texname, m.bump_texopt);
    out.disp = texture(m.displacement_texname, m.displacement_texopt);
    return out;
}

}  // namespace tessera
