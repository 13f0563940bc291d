#pragma once
// A scene as plain data: what a loader, a test, a script or a host program fills.
//
// Lengths in scene units (1 = 1 m), colours linear in the working space, angles in degrees where
// the name says _deg. Objects refer to each other by index into the vectors of SceneDesc; -1 is
// "none".

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/api/error.h"

namespace tessera {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Double3 = std::array<double, 3>;

/// Affine map, 3 rows of 4, row-major, column vectors: p' = M p.
using Matrix34 = std::array<double, 12>;
inline constexpr Matrix34 kIdentity34{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

// ---- images and materials
// -------------------------------------------------------------------------

enum class Wrap : std::uint8_t { repeat, clamp, mirror, black };

/// How texels become a value. closest and bilinear read the finest level, whatever the footprint;
/// bicubic is a cubic B-spline within levels; stochastic is one texel, drawn by trilinear's
/// weights.
enum class TextureFilter : std::uint8_t { trilinear, closest, bilinear, bicubic, stochastic };

/// One image of a <UDIM> set: that of the unit square of uv whose lower corner is (column, row).
struct TextureTile {
    int column = 0, row = 0;
    std::string file;  // resolved path
};

/// One image read as a texture. Equal entries are shared by index.
struct TextureDesc {
    std::string file;                // resolved path; of a set of tiles its pattern, for messages
    std::vector<TextureTile> tiles;  // of a <UDIM> set; wrap does nothing
    std::string color_space;         // OCIO name; "" = by use: sRGB for colours, raw for data
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::trilinear;
    Float2 scale{1, 1};  // uv' = uv * scale + offset
    Float2 offset{0, 0};
    float gain = 1;  // value' = value * gain + bias (MTL -mm)
    float bias = 0;
    SourceLoc loc;
};

/// Which channel a scalar input reads from a texture.
enum class Channel : std::uint8_t { automatic, r, g, b, a, luminance };

/// A colour: a constant, or the product of the constant and a texture.
struct ColorInput {
    Float3 value{0, 0, 0};
    int texture = -1;
    int node = -1, output = 0;  // of the material's nodes, in place of a texture
    bool varies() const { return texture >= 0 || node >= 0; }
    bool operator==(const ColorInput&) const = default;
};

/// A scalar: a constant, or the product of the constant and one channel of a texture.
struct FloatInput {
    float value = 0;
    int texture = -1;
    Channel channel = Channel::automatic;
    bool invert = false;  // 1 - texture, before the product
    int node = -1, output = 0;
    bool varies() const { return texture >= 0 || node >= 0; }
    bool operator==(const FloatInput&) const = default;
};

/// A normal: a tangent-space map (x along u, y along v), or an output of a node in the world's
/// space.
struct NormalInput {
    int texture = -1;
    float scale = 1;
    bool flip_y = false;  // a map with its green downward, as DirectX has them
    int node = -1, output = 0;
    bool given() const { return texture >= 0 || node >= 0; }
    bool operator==(const NormalInput&) const = default;
};

/// What an input of a node is given: a value (a number stands in all three places), or an output of
/// another node: 0 the main one, k the k-th of those beside it.
struct NodeValue {
    Float3 value{0, 0, 0};
    int node = -1, output = 0;
    bool operator==(const NodeValue&) const = default;
};

/// A node of a material's graph; kNodes[type] of node_table.h says what it is. Nodes do not go in
/// circles. inputs stand in the table's order; one without a value of its own is not `given`.
struct NodeDesc {
    std::string name;
    SourceLoc loc;
    int type = 0;
    std::vector<NodeValue> inputs;
    std::vector<bool> given;
    int texture = -1;   // of an image
    bool color = true;  // the image is one of colours, not of data
};

/// How a picture shows all directions; automatic: by its shape.
enum class EnvironmentMap : std::uint8_t {
    automatic,
    latlong,
    cube_cross_horizontal,
    cube_cross_vertical,
    cube_strip,
    mirror_ball,
    angular,
};

/// What a material mirrors in place of the scene: a picture of all directions, taken near by.
struct ReflectionMapDesc {
    SourceLoc loc;     // of file, if it is written
    std::string file;  // resolved path
    EnvironmentMap projection = EnvironmentMap::automatic;
    std::string color_space;  // "" = linear working space
    double scale = 1;
    double rotate_deg = 0;  // about +y
    /// Where it was taken, and the walls that it shows: a sphere about that point or a box between
    /// two corners. Without walls they are infinitely far.
    Double3 position{0, 0, 0};
    double radius = 0;
    std::optional<std::array<Double3, 2>> box;
};

/// Of vector displacement: tangent along u, across it, normal; or the object's axes.
enum class DisplacementSpace : std::uint8_t { tangent, object };

/// OpenPBR Surface 1.1 with its own names, units and defaults.
struct MaterialDesc {
    std::string name;
    SourceLoc loc;

    FloatInput base_weight{1};
    ColorInput base_color{{0.8f, 0.8f, 0.8f}};
    FloatInput base_diffuse_roughness{0};
    FloatInput base_metalness{0};

    FloatInput specular_weight{1};
    ColorInput specular_color{{1, 1, 1}};
    FloatInput specular_roughness{0.3f};
    FloatInput specular_roughness_anisotropy{0};
    FloatInput specular_ior{1.5f};

    FloatInput transmission_weight{0};
    ColorInput transmission_color{{1, 1, 1}};
    FloatInput transmission_depth{0};  // scene units
    ColorInput transmission_scatter{{0, 0, 0}};
    FloatInput transmission_scatter_anisotropy{0};
    FloatInput transmission_dispersion_scale{0};
    FloatInput transmission_dispersion_abbe_number{20};

    FloatInput subsurface_weight{0};
    ColorInput subsurface_color{{0.8f, 0.8f, 0.8f}};
    FloatInput subsurface_radius{1};  // scene units
    ColorInput subsurface_radius_scale{{1, 0.5f, 0.25f}};
    FloatInput subsurface_scatter_anisotropy{0};

    FloatInput coat_weight{0};
    ColorInput coat_color{{1, 1, 1}};
    FloatInput coat_roughness{0};
    FloatInput coat_roughness_anisotropy{0};
    FloatInput coat_ior{1.6f};
    FloatInput coat_darkening{1};

    FloatInput fuzz_weight{0};
    ColorInput fuzz_color{{1, 1, 1}};
    FloatInput fuzz_roughness{0.5f};

    FloatInput thin_film_weight{0};
    FloatInput thin_film_thickness{0.5f};  // micrometres
    FloatInput thin_film_ior{1.4f};

    FloatInput emission_luminance{0};  // cd/m^2 (nits); kLumensPerWatt makes it radiance
    ColorInput emission_color{{1, 1, 1}};

    FloatInput geometry_opacity{1};
    bool geometry_thin_walled = false;
    NormalInput geometry_normal;
    NormalInput geometry_coat_normal;   // none: the surface's, unmapped
    NormalInput geometry_tangent;       // a node's; none: along u
    NormalInput geometry_coat_tangent;  // none: the surface's
    FloatInput bump{0};                 // height over the surface, in the object's units
    bool bump_in_uv = false;            // or in widths of the texture, as MTL files have it

    std::vector<NodeDesc> nodes;  // what inputs refer to

    // Moves the surface, of meshes that are subdivided, by scale * displacement + offset along its
    // normal and by scale * vector_displacement; scene units.
    FloatInput displacement{0};
    float displacement_scale = 1;
    float displacement_offset = 0;
    ColorInput vector_displacement{{0, 0, 0}};
    DisplacementSpace displacement_space = DisplacementSpace::tangent;
    SourceLoc displacement_loc;  // of a key of it; without a file: loc

    int dielectric_priority = 0;    // of nested glass the higher number fills the overlap
    std::string light_group;        // of what it emits
    bool use_vertex_color = false;  // base_color is multiplied by the mesh's vertex colours
    std::optional<ReflectionMapDesc> reflection_map;
};

/// Luminous efficacy of white light, equal energy over the visible band: what turns nits into the
/// radiance of our lights. Ward, "The RADIANCE Lighting Simulation and Rendering System", 1994.
inline constexpr float kLumensPerWatt = 179.0f;

// ---- shapes
// ---------------------------------------------------------------------------------------

/// linear: cut up, but of the same shape.
enum class Subdivision : std::uint8_t { none, linear, catmull_clark };
/// What becomes of a surface's open edges: smooth curves that end in its corners, smooth all
/// around, or straight as they are.
enum class SubdivisionBoundary : std::uint8_t { pin_corners, smooth, pin };

/// Into how many pieces a mesh is cut before it is displaced. Every edge is cut by its own rate:
/// `rate` if it is not 0, else by its length and `edge_length` if that is not 0, else by its length
/// in the picture.
struct SubdivisionDesc {
    SourceLoc loc;
    Subdivision scheme = Subdivision::none;
    SubdivisionBoundary boundary = SubdivisionBoundary::pin_corners;
    int rate = 0;
    double edge_length = 0;     // scene units
    double edge_length_px = 2;  // pixels of the full frame, at the nearest instance
    int max_rate = 256;
    int max_triangles = 20'000'000;
};

/// Triangles and quads. Faces are numbered triangles first, then quads, each in file order.
/// Index arrays hold 3 entries per triangle, then 4 per quad. An empty normal_index or uv_index
/// means "as position_index"; empty normals or uvs mean there are none.
struct MeshDesc {
    std::string name;
    SourceLoc loc;
    std::vector<double> positions;  // x y z
    std::vector<float> normals;     // x y z, unit length
    std::vector<float> uvs;         // u v, v upward
    std::vector<float> colors;      // r g b per position, linear
    std::uint32_t triangles = 0;
    std::uint32_t quads = 0;
    std::vector<std::uint32_t> position_index;
    std::vector<std::uint32_t> normal_index;
    std::vector<std::uint32_t> uv_index;
    std::vector<std::uint32_t> face_material;  // slot per face; empty: slot 0 for all
    std::vector<int> materials;                // slot -> SceneDesc::materials
    std::vector<std::uint32_t> face_object;    // per face -> object_names; empty: 0 for all
    std::vector<std::string> object_names;     // OBJ 'o', else 'g', else the file's stem
    SubdivisionDesc subdivision;
};

struct SphereDesc {
    std::string name;
    SourceLoc loc;
    Double3 center{0, 0, 0};
    double radius = 1;
    int material = -1;
};

struct DiscDesc {
    std::string name;
    SourceLoc loc;
    Double3 center{0, 0, 0};
    Double3 normal{0, 1, 0};
    double radius = 1;
    int material = -1;
};

enum class ShapeKind : std::uint8_t { mesh, sphere, disc, group };

struct ShapeRef {
    ShapeKind kind = ShapeKind::mesh;
    int index = -1;
};

/// One shape or group placed once or many times.
struct InstanceDesc {
    std::string name;
    SourceLoc loc;
    ShapeRef of;
    std::vector<Matrix34> transforms{kIdentity34};
    int material = -1;  // replaces every material of the shape when set
};

/// Instances under a name, to be instanced together. Groups may nest; a cycle is an error.
struct GroupDesc {
    std::string name;
    SourceLoc loc;
    std::vector<InstanceDesc> members;
};

// ---- lights
// ---------------------------------------------------------------------------------------

struct PointLightDesc {
    Double3 position{0, 0, 0};
    Float3 intensity{1, 1, 1};  // W/sr
};

struct SpotLightDesc {
    Double3 position{0, 0, 0};
    Double3 direction{0, -1, 0};
    Float3 intensity{1, 1, 1};  // W/sr on the axis
    double cone_deg = 30;       // half angle where light ends
    double blend = 0.2;         // share of the cone over which it fades, 0 = hard edge
};

struct DistantLightDesc {
    Double3 direction{0, -1, 0};  // the way the light travels
    Float3 irradiance{1, 1, 1};   // W/m^2 on a surface facing the light
    double angle_deg = 0;         // angular diameter; the sun's is 0.533
};

struct QuadLightDesc {  // emits along edges[0] x edges[1]
    Double3 corner{0, 0, 0};
    std::array<Double3, 2> edges{{{1, 0, 0}, {0, 0, 1}}};
    Float3 radiance{1, 1, 1};  // W/m^2/sr
    bool two_sided = false;
};

struct DiscLightDesc {
    Double3 center{0, 0, 0};
    Double3 normal{0, -1, 0};
    double radius = 1;
    Float3 radiance{1, 1, 1};
    bool two_sided = false;
};

struct SphereLightDesc {
    Double3 center{0, 0, 0};
    double radius = 1;
    Float3 radiance{1, 1, 1};
};

struct LightDesc {
    std::string name;
    SourceLoc loc;
    bool visible = true;  // to camera rays; area lights only
    std::string light_group;
    std::variant<PointLightDesc, SpotLightDesc, DistantLightDesc, QuadLightDesc, DiscLightDesc,
                 SphereLightDesc>
        shape;
};

/// Light from all around. With a file: lat-long, y up, u = 0.5 looks along -z at rotate_deg 0.
struct EnvironmentDesc {
    SourceLoc loc;
    std::string file;  // resolved path; "" = constant
    std::vector<std::string>
        faces;  // in its place: six files, +x -x +y -y +z -z as seen from inside
    std::string camera, lighting, reflection;  // in its place for one kind of ray; "" = none
    EnvironmentMap projection = EnvironmentMap::automatic;
    std::string color_space;   // "" = linear working space
    Float3 radiance{1, 1, 1};  // constant, or the factor on the image
    double rotate_deg = 0;     // about +y
    bool visible = true;       // to camera rays
    std::string light_group;
    /// Of the keys; without a file: loc.
    SourceLoc file_loc, faces_loc, camera_loc, lighting_loc, reflection_loc;
};

/// Whether it reads any picture.
inline bool has_image(const EnvironmentDesc& e) {
    return !(e.file.empty() && e.faces.empty() && e.camera.empty() && e.lighting.empty() &&
             e.reflection.empty());
}

/// A clear sky and its sun, computed. North is -z, east +x.
struct SkyDesc {
    SourceLoc loc;
    double turbidity = 3;  // 1.8 the clearest air, 10 thick haze
    Float3 ground_albedo{0.2f, 0.2f, 0.2f};
    double sun_elevation_deg = 45;
    double sun_azimuth_deg = 135;  // from north by east
    /// In their place: where and when, UTC.
    struct PlaceAndTime {
        double latitude_deg = 0, longitude_deg = 0;
        int year = 2000, month = 1, day = 1;
        double hour = 12;
    };
    std::optional<PlaceAndTime> when;
    double sun_angle_deg = 0.533;  // across
    float intensity = 1;
    bool sun = true;      // with its disc
    bool visible = true;  // to camera rays
    std::string light_group;
};

// ---- camera, film, settings
// -----------------------------------------------------------------------

/// latlong and cube show all directions around the position; the world's axes are those of the map.
enum class Projection : std::uint8_t { perspective, orthographic, latlong, cube };
enum class FovAxis : std::uint8_t { vertical, horizontal };

struct CameraDesc {
    SourceLoc loc;
    bool automatic =
        true;  // frame the scene from a three-quarter view; the placement below is ignored
    Projection projection = Projection::perspective;
    Double3 position{0, 0, 5};
    Double3 look_at{0, 0, 0};
    Double3 up{0, 1, 0};
    std::optional<Matrix34>
        matrix;  // camera to world (x right, y up, looks along -z); replaces the three above
    double fov_deg = 40;
    FovAxis fov_axis = FovAxis::vertical;
    double ortho_height = 2;     // scene units, orthographic only
    double aperture_radius = 0;  // thin lens, scene units; 0 = pinhole
    double focus_distance = 0;   // 0 = distance to look_at
};

enum class PixelFilter : std::uint8_t { box, triangle, gaussian, blackman_harris };

/// Pixels x0 <= x < x1, y0 <= y < y1; y downward.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const noexcept { return x1 - x0; }
    int height() const noexcept { return y1 - y0; }
    bool operator==(const PixelWindow&) const = default;
};

struct FilmDesc {
    SourceLoc loc;
    int width = 960;
    int height = 540;
    std::optional<PixelWindow> crop;
    double overscan = 0;  // share of width and height rendered beyond each edge; a crop goes before
    int overscan_px = 0;  // the same in pixels
    PixelFilter filter = PixelFilter::blackman_harris;
    double filter_width_px = 3;                // full width of the support
    std::string working_space = "lin_rec709";  // or "acescg"
    std::vector<std::string> aovs;             // beyond beauty; empty = Z, N, P, albedo
    SourceLoc aovs_loc;
    double ao_distance = 0;  // how far ambient occlusion looks, scene units; 0 = without end
};

/// split: a file per layer.
enum class ExrLayout : std::uint8_t { single, multipart, split };
enum class ExrCompression : std::uint8_t { none, zips, zip, piz, dwaa, dwab };

/// How a picture lies on the disk.
struct OutputDesc {
    ExrLayout exr = ExrLayout::single;
    ExrCompression compression = ExrCompression::zip;  // of colour; data is never lossy
    double dwa_level = 45;                             // dwaa, dwab: more is smaller and coarser
    bool all_float = false;
    std::string deep;                     // a deep file too, beside the picture; "": none
    bool crop_pad = false;                // the whole frame, black where nothing was rendered
    bool deterministic_metadata = false;  // no date, host, time, command in the header
};

enum class Integrator : std::uint8_t { path, whitted };

struct RenderDesc {
    SourceLoc loc;
    Integrator integrator = Integrator::path;
    int spp = 64;
    std::uint64_t seed = 0;
    int max_depth = 12;  // bounces in all
    int max_diffuse_depth = 5;
    int max_glossy_depth = 8;
    int max_transmission_depth = 12;
    int min_depth = 1;  // no Russian roulette before this many bounces
    int frame = 1;      // of image sequences
};

inline bool shows_all_directions(Projection p) {
    return p == Projection::latlong || p == Projection::cube;
}
/// The resolution of such a picture where none is asked for: 2:1, or six squares side by side.
inline void set_map_size(Projection p, FilmDesc& film) {
    film.width = p == Projection::cube ? 1536 : 1024;
    film.height = p == Projection::cube ? 256 : 512;
    film.crop.reset();
}

struct SceneDesc {
    std::string path;  // the file that was asked for
    CameraDesc camera;
    FilmDesc film;
    OutputDesc output;
    RenderDesc render;
    std::optional<EnvironmentDesc> environment;
    std::optional<SkyDesc> sky;
    std::vector<TextureDesc> textures;
    std::vector<MaterialDesc> materials;
    std::vector<MeshDesc> meshes;
    std::vector<SphereDesc> spheres;
    std::vector<DiscDesc> discs;
    std::vector<GroupDesc> groups;
    std::vector<InstanceDesc> instances;
    std::vector<LightDesc> lights;
    std::vector<std::string> files;     // every file read, for the scene hash and 'info'
    std::vector<std::string> warnings;  // located, one line each
    std::vector<std::string> notes;     // what was done in the user's place
};

/// Bytes that textures may take unless BuildOptions say otherwise. A constant, not a share of the
/// machine's memory: where a texture is read from can show in the picture's last bits.
inline constexpr std::int64_t kTextureMemory = std::int64_t(4) << 30;

struct LoadOptions {
    Strictness strictness = Strictness::normal;
    bool allow_external_assets = false;  // assets outside the scene's folders
    std::vector<std::string> set;  // "camera.fov_deg=35", applied in order over the scene file
};

/// Reads an .obj or .toml scene. Throws Error (ExitCode::scene or usage) with file:line:column.
SceneDesc load_scene(const std::string& path, const LoadOptions& options = {});

}  // namespace tessera
