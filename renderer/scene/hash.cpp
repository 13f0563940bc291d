#include "renderer/scene/hash.h"

#include "renderer/api/openpbr_inputs.h"
#include "renderer/scene/file_hash.h"

#include <xxhash.h>

#include <cstdio>
#include <map>
#include <type_traits>

namespace tessera {
namespace {

class Hasher {
public:
    Hasher() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
    ~Hasher() { XXH3_freeState(state_); }
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    template <class T>
    void operator()(const T& v) requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) {
        bytes(&v, sizeof v);
    }
    void operator()(const std::string& s) { (*this)(s.size()), bytes(s.data(), s.size()); }
    template <class T, std::size_t N>
    void operator()(const std::array<T, N>& a) {
        for (const T& v : a) (*this)(v);
    }
    template <class T>
    void operator()(const std::vector<T>& v) {
        (*this)(v.size());
        if constexpr (std::is_arithmetic_v<T>) {
            bytes(v.data(), v.size() * sizeof(T));
        } else {
            for (const T& x : v) (*this)(x);
        }
    }
    template <class T>
    void operator()(const std::optional<T>& o) {
        (*this)(o.has_value());
        if (o) (*this)(*o);
    }
    template <class... T>
    void all(const T&... v) {
        ((*this)(v), ...);
    }

    void operator()(const ColorInput& c) { all(c.value, c.texture, c.node, c.output); }
    void operator()(const FloatInput& f) {
        all(f.value, f.texture, f.channel, f.invert, f.node, f.output);
    }
    void operator()(const NormalInput& n) { all(n.texture, n.scale, n.flip_y, n.node, n.output); }
    void operator()(const NodeValue& v) { all(v.value, v.node, v.output); }
    void operator()(const NodeDesc& n) {
        all(n.type, n.inputs, n.texture, n.color);
        for (const bool given : n.given) (*this)(given);
    }
    // What lies in it, not where it lies: the same scene in another folder is the same.
    void file(const std::string& path) {
        if (path.empty()) return (*this)(path);
        const auto [known, added] = files_.try_emplace(path, 0);
        if (added) known->second = file_hash(path);
        (*this)(known->second);
    }
    void operator()(const TextureTile& t) { all(t.column, t.row), file(t.file); }
    void operator()(const TextureDesc& t) {
        if (t.tiles.empty()) file(t.file);
        all(t.tiles, t.color_space, t.wrap_u, t.wrap_v, t.filter, t.scale, t.offset, t.gain,
            t.bias);
    }
    void operator()(const MaterialDesc& m) {
        (*this)(m.name);
        visit_inputs([&](auto member, const OpenPbrInput&) { (*this)(m.*member); });
        all(m.displacement_scale, m.displacement_offset, m.displacement_space);
        all(m.geometry_thin_walled, m.geometry_normal, m.geometry_coat_normal, m.geometry_tangent,
            m.geometry_coat_tangent, m.bump_in_uv, m.nodes, m.dielectric_priority, m.light_group,
            m.use_vertex_color, m.reflection_map);
    }
    void operator()(const ReflectionMapDesc& r) {
        file(r.file);
        all(r.projection, r.color_space, r.scale, r.rotate_deg, r.position, r.radius, r.box);
    }
    void operator()(const MeshDesc& m) {
        all(m.positions, m.normals, m.uvs, m.colors, m.triangles, m.quads, m.position_index,
            m.normal_index, m.uv_index, m.face_material, m.materials, m.face_object,
            m.object_names);
        const SubdivisionDesc& s = m.subdivision;
        all(s.scheme, s.boundary, s.rate, s.edge_length, s.edge_length_px, s.max_rate);
    }
    void operator()(const SphereDesc& s) { all(s.center, s.radius, s.material); }
    void operator()(const DiscDesc& d) { all(d.center, d.normal, d.radius, d.material); }
    void operator()(const InstanceDesc& i) { all(i.of.kind, i.of.index, i.transforms, i.material); }
    void operator()(const GroupDesc& g) { all(g.members); }
    void operator()(const PointLightDesc& l) { all(l.position, l.intensity); }
    void operator()(const SpotLightDesc& l) {
        all(l.position, l.direction, l.intensity, l.cone_deg, l.blend);
    }
    void operator()(const DistantLightDesc& l) { all(l.direction, l.irradiance, l.angle_deg); }
    void operator()(const QuadLightDesc& l) { all(l.corner, l.edges, l.radiance, l.two_sided); }
    void operator()(const DiscLightDesc& l) {
        all(l.center, l.normal, l.radius, l.radiance, l.two_sided);
    }
    void operator()(const SphereLightDesc& l) { all(l.center, l.radius, l.radiance); }
    void operator()(const LightDesc& l) {
        all(l.name, l.visible, l.light_group, l.shape.index());
        std::visit([&](const auto& s) { (*this)(s); }, l.shape);
    }
    void operator()(const EnvironmentDesc& e) {
        for (const std::string* f : {&e.file, &e.camera, &e.lighting, &e.reflection}) file(*f);
        for (const std::string& face : e.faces) file(face);
        all(e.projection, e.color_space, e.radiance, e.rotate_deg, e.visible, e.light_group);
    }
    void operator()(const SkyDesc::PlaceAndTime& t) {
        all(t.latitude_deg, t.longitude_deg, t.year, t.month, t.day, t.hour);
    }
    void operator()(const SkyDesc& s) {
        all(s.turbidity, s.ground_albedo, s.sun_elevation_deg, s.sun_azimuth_deg, s.when,
            s.sun_angle_deg, s.intensity, s.sun, s.visible, s.light_group);
    }
    void operator()(const CameraDesc& c) {
        all(c.automatic, c.projection, c.position, c.look_at, c.up, c.matrix, c.fov_deg, c.fov_axis,
            c.ortho_height, c.aperture_radius, c.focus_distance);
    }
    void operator()(const FilmDesc& f) {
        all(f.width, f.height, f.filter, f.filter_width_px, f.working_space, f.ao_distance);
    }
    void operator()(const RenderDesc& r) {
        all(r.integrator, r.seed, r.max_depth, r.max_diffuse_depth, r.max_glossy_depth,
            r.max_transmission_depth, r.min_depth);
    }

    std::string hex() const {
        char text[17];
        std::snprintf(text, sizeof text, "%016llx",
                      static_cast<unsigned long long>(XXH3_64bits_digest(state_)));
        return text;
    }

private:
    void bytes(const void* data, std::size_t n) { XXH3_64bits_update(state_, data, n); }
    XXH3_state_t* state_;
    std::map<std::string, std::uint64_t> files_;
};

}  // namespace

std::string scene_hash(const SceneDesc& d) {
    Hasher h;
    h.all(d.camera, d.film, d.render, d.environment, d.sky, d.textures, d.materials, d.meshes,
          d.spheres, d.discs, d.groups, d.instances, d.lights);
    return h.hex();
}

}  // namespace tessera
