#include "renderer/io/mtl.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "renderer/io/mtl_material.h"
#include "tests/support/obj_files.h"

namespace tessera::test {
namespace {

// One material 'a' of the given statements, on a square.
LoadedObj with_mtl(const std::string& statements) {
    return load_text("mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3 4\n",
                     {{"m.mtl", "newmtl a\n" + statements}});
}

const TextureDesc& texture(const LoadedObj& got, int index) {
    return got.scene.textures.at(static_cast<std::size_t>(index));
}

std::string file_name(const LoadedObj& got, int index) {
    return std::filesystem::path(texture(got, index).file).filename().string();
}

}  // namespace

TEST_CASE("mtl: a name with spaces is one name on both sides, without its comment") {
    const LoadedObj got = load_text(
        "mtllib m.mtl\n" + kSquare +
            "usemtl  a b \nf 1 2 3\nusemtl c#d # why\nf 1 2 3\nusemtl Material #25\nf 1 2 3\n",
        {{"m.mtl",
          "\tnewmtl a b\nKd 1 0 0\nnewmtl c#d # x\nKd 0 1 0\nnewmtl Material #25\nKd 0 0 1\n"}});
    CHECK(got.warnings.empty());
    CHECK(got.material(0).base_color.value == Float3{1, 0, 0});
    CHECK(got.material(1).base_color.value == Float3{0, 1, 0});
    CHECK(got.material(2).base_color.value == Float3{0, 0, 1});
}

TEST_CASE("mtl: a byte order mark does not cost the first name") {
    const LoadedObj got = load_text("mtllib m.mtl\nusemtl a\n" + kSquare + "f 1 2 3\n",
                                    {{"m.mtl", "\xEF\xBB\xBFnewmtl a\nKd 1 0 0\n"}});
    CHECK(got.material().base_color.value == Float3{1, 0, 0});
}

TEST_CASE("mtl: mtllib names one file with spaces, several files, or a file with escaped blanks") {
    const std::string rest = "\nusemtl a\n" + kSquare + "f 1 2 3\n";
    const std::string red = "newmtl a\nKd 1 0 0\n";
    CHECK(load_text("mtllib my mat.mtl" + rest, {{"my mat.mtl", red}}).warnings.empty());
    CHECK(load_text("mtllib my\\ mat.mtl none.mtl" + rest, {{"my mat.mtl", red}})
              .material()
              .base_color.value[1] == 0);
    CHECK(load_text("mtllib \"my mat.mtl\"" + rest, {{"my mat.mtl", red}}).warnings.empty());
    const LoadedObj three = load_text("mtllib x.mtl y.mtl z.mtl" + rest, {{"z.mtl", red}});
    CHECK(three.material().base_color.value == Float3{1, 0, 0});
    CHECK(three.warned("m.obj:1: mtllib 'x.mtl' not found"));
}

TEST_CASE("mtl: a backslash is a slash, another letter case is found with a note") {
    const std::string rest = "\nusemtl a\n" + kSquare + "f 1 2 3\n";
    const std::string red = "newmtl a\nKd 1 0 0\nmap_Kd tex\\deep\\My File.png\n";
    const LoadedObj got = load_text("mtllib sub\\X.MTL" + rest,
                                    {{"sub/x.mtl", red}, {"sub/tex/deep/my file.png", "-"}});
    CHECK(got.material().base_color.value == Float3{1, 0, 0});
    CHECK(got.noted("found as 'sub/x.mtl' (letter case differs)"));
    CHECK(
        texture(got, got.material().base_color.texture).file.ends_with("sub/tex/deep/my file.png"));
}

TEST_CASE("mtl: usemtl may come before mtllib") {
    const LoadedObj got = load_text("usemtl a\n" + kSquare + "f 1 2 3\nmtllib m.mtl\n",
                                    {{"m.mtl", "newmtl a\nKd 1 0 0\n"}});
    CHECK(got.material().base_color.value == Float3{1, 0, 0});
}

TEST_CASE("mtl: a material nobody defines is grey and told once with its line") {
    const LoadedObj got =
        load_text(kSquare + "usemtl x\nf 1 2 3\nusemtl y\nf 1 2 3\nusemtl x\nf 1 2 3\n");
    CHECK(got.mesh.materials.size() == 2);
    CHECK(got.material().name == "x");
    CHECK(got.material().base_color.value == Float3{0.8f, 0.8f, 0.8f});
    CHECK(got.warned("m.obj:5: no mtllib defines the material, grey is used: 'x'"));
    CHECK(got.warnings.size() == 2);
}

TEST_CASE("mtl: a library outside the scene's folder is refused") {
    const LoadedObj got =
        load_text("mtllib ../../../../../../../../../../etc/passwd\n" + kSquare + "f 1 2 3\n");
    CHECK(got.error.find("m.obj:1: mtllib") != std::string::npos);
    CHECK(got.error.find("outside the scene's folders") != std::string::npos);
}

TEST_CASE("mtl: a library may be named twice, name the OBJ, or define a name twice") {
    const LoadedObj got = load_text("mtllib m.mtl m.mtl m.obj\nusemtl a\n" + kSquare + "f 1 2 3\n",
                                    {{"m.mtl", "newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\n"}});
    CHECK(got.material().base_color.value == Float3{1, 0, 0});
    CHECK(got.warned("m.mtl:3: material is defined twice"));
    CHECK(got.warned("mtllib names the OBJ itself"));
}

TEST_CASE("mtl: one value is grey") {
    CHECK(with_mtl("Kd 0.5\n").material().base_color.value == Float3{0.5f, 0.5f, 0.5f});
    const LoadedObj lamp = with_mtl("Ke 5\n");
    CHECK(lamp.material().emission_luminance.value == 5 * kLumensPerWatt);
    CHECK(lamp.material().emission_color.value == Float3{1, 1, 1});
}

TEST_CASE("mtl: xyz colours are converted, spectral ones reported") {
    const Float3 white = with_mtl("Kd xyz 0.9505 1 1.089\n").material().base_color.value;
    for (const float channel : white)
        CHECK(channel == doctest::Approx(1).epsilon(1e-3));  // D65 to 4 figures
    CHECK(with_mtl("Kd spectral f.rfl 1\n").warned("m.mtl:2: spectral"));
}

TEST_CASE("mtl: d wins over Tr in either order, Tr alone is 1 - d") {
    for (const std::string both : {"d 0.25\nTr 0.5\n", "Tr 0.5\nd 0.25\n"}) {
        const LoadedObj got = with_mtl(both);
        CHECK(got.material().geometry_opacity.value == 0.25f);
        CHECK(got.warned("both d and Tr given"));
    }
    CHECK(with_mtl("Tr 0.25\n").material().geometry_opacity.value == 0.75f);
    CHECK(with_mtl("Tr 1\n").noted("Tr 1 makes it invisible"));
    CHECK(with_mtl("d -halo 0.5\n").material().geometry_opacity.value == 0.5f);
}

TEST_CASE("mtl: texture options are read or skipped by their number of values") {
    const LoadedObj got = with_mtl(
        "map_Kd -s 2 3 1 -o .5 0 0 -mm 0.1 2 -clamp on -colorspace sRGB -t 0.1 -boost 2 -texres 64 "
        "-blendu off -cc on -type sphere -bm 2 -weird 1 on tex\\dir\\my file.png # c\n");
    const TextureDesc& t = texture(got, got.material().base_color.texture);
    CHECK(t.file.ends_with("/tex/dir/my file.png"));
    CHECK(t.scale == Float2{2, 3});
    CHECK(t.offset == Float2{0.5f, 0});
    CHECK(t.bias == 0.1f);
    CHECK(t.gain == 2);
    CHECK(t.wrap_u == Wrap::clamp);
    CHECK(t.color_space == "");
    CHECK(t.loc.line == 2);
    CHECK(got.warned("unknown texture option, ignored: '-weird'"));
    CHECK(got.material().base_color.value == Float3{1, 1, 1});
}

TEST_CASE("mtl: an option with too few values does not eat the file name") {
    const LoadedObj one = with_mtl("map_Kd -s 2 a.png\n");
    CHECK(file_name(one, 0) == "a.png");
    CHECK(texture(one, 0).scale == Float2{2, 1});
    const LoadedObj digits = with_mtl("map_Kd -o 1 2 3 4\n");
    CHECK(file_name(digits, 0) == "4");
    CHECK(texture(digits, 0).offset == Float2{1, 2});
}

TEST_CASE("mtl: keys are read in any letter case") {
    const LoadedObj got =
        with_mtl("kd 1 0 0\nmap_kd a.png\nMAP_OPACITY b.png\nmap_kn c.png\nmap_pr d.png\n");
    const MaterialDesc& m = got.material();
    CHECK(file_name(got, m.base_color.texture) == "a.png");
    CHECK(file_name(got, m.geometry_opacity.texture) == "b.png");
    CHECK(file_name(got, m.geometry_normal.texture) == "c.png");
    CHECK(file_name(got, m.specular_roughness.texture) == "d.png");
    CHECK(got.warnings.empty());
}

TEST_CASE("mtl: what is not understood or not supported is told once with its line") {
    const LoadedObj got = with_mtl("Km 1\nmap_Pc a.png\nPcr 0.1\nbump height.png\nKm 2\n");
    CHECK(got.warned("m.mtl:2: unknown material statement, ignored: 'Km'"));
    CHECK(got.warned("m.mtl:3: not supported yet, ignored: 'map_Pc'"));
    CHECK(got.warnings.size() == 2);
    CHECK(got.material().coat_roughness.value == 0.1f);
}

TEST_CASE(
    "mtl: a height map bumps by hundredths of the texture's width, unless there are normals") {
    const LoadedObj got = with_mtl("map_Bump -bm 2 height.png\n");
    CHECK(file_name(got, got.material().bump.texture) == "height.png");
    CHECK(got.material().bump.value == 0.02f);
    CHECK(got.material().bump_in_uv);
    const LoadedObj both = with_mtl("map_Bump height.png\nnorm normals.png\n");
    CHECK(both.material().bump.texture == -1);
    CHECK(both.material().geometry_normal.texture == 0);
}

TEST_CASE("mtl: a bump map named like a normal map is one, with a note") {
    const LoadedObj got = with_mtl("map_Bump -bm 0.5 wall_Normal.png\n");
    CHECK(got.material().geometry_normal.texture == 0);
    CHECK(got.material().geometry_normal.scale == 0.5f);
    CHECK(got.noted("taken for a normal map"));
}

TEST_CASE("mtl: without Ks and PBR keys a material is Lambertian") {
    for (const std::string text : {"Kd 1 0 0\n", "Ks 0 0 0\nNs 10\n", "Ks 1 1 1\nillum 1\n"})
        CHECK(with_mtl(text).material().specular_weight.value == 0);
    CHECK(with_mtl("Pr 0.4\n").material().specular_weight.value == 1);
}

TEST_CASE("mtl: Ks and Ns become a dielectric, Pr wins over Ns") {
    const MaterialDesc m = with_mtl("Ks 0.25 0.125 0.25\nNs 30\nNi 1.33\n").material();
    CHECK(m.specular_weight.value == 0.5f);
    CHECK(m.specular_color.value == Float3{1, 0.5f, 1});
    CHECK(m.specular_ior.value == 1.33f);
    CHECK(m.specular_roughness.value == doctest::Approx(std::sqrt(0.25)));  // alpha = sqrt(2 / 32)
    CHECK(with_mtl("Ks 1\nNs 30\nPr 0.7\n").material().specular_roughness.value == 0.7f);
    CHECK(with_mtl("Ks 1\nNi 1\n").material().specular_ior.value == 1.5f);
    CHECK(roughness_from_phong(0) == 1);
}

TEST_CASE("mtl: PBR values and maps multiply, a map alone counts as 1") {
    const LoadedObj got =
        with_mtl("Pr 0.5\nPm 0.25\nmap_Pr r.png\nmap_Pm -imfchan b m.png\naniso 0.5\n");
    const MaterialDesc& m = got.material();
    CHECK(m.specular_roughness.value == 0.5f);
    CHECK(m.base_metalness.value == 0.25f);
    CHECK(m.base_metalness.channel == Channel::b);
    CHECK(m.specular_roughness_anisotropy.value == 0.5f);
    CHECK(m.specular_weight.value == 1);
    CHECK(with_mtl("map_Pr r.png\n").material().specular_roughness.value == 1);
}

TEST_CASE("mtl: illum 3 and 5 are mirrors of colour Ks") {
    const MaterialDesc m = with_mtl("Kd 0.1 0.1 0.1\nKs 0.9 0.8 0.7\nillum 3\n").material();
    CHECK(m.base_metalness.value == 1);
    CHECK(m.base_color.value == Float3{0.9f, 0.8f, 0.7f});
    CHECK(m.specular_roughness.value == 0);
    CHECK(with_mtl("illum 5\nNs 1000\n").material().specular_roughness.value == 0);
}

TEST_CASE("mtl: illum 4, 6, 7 and 9 are glass, unless Ni bends nothing") {
    for (const std::string illum : {"4", "6", "7", "9"}) {
        const MaterialDesc m =
            with_mtl("illum " + illum + "\nNi 1.4\nTf 0.9 1 0.9\nd 0.1\n").material();
        CHECK(m.transmission_weight.value == 1);
        CHECK(m.transmission_color.value == Float3{0.9f, 1, 0.9f});
        CHECK(m.specular_ior.value == 1.4f);
        CHECK(m.specular_roughness.value == 0);
        CHECK(m.geometry_opacity.value == 1);
    }
    const MaterialDesc thin = with_mtl("illum 4\nNi 1\nd 0.25\n").material();
    CHECK(thin.transmission_weight.value == 0);
    CHECK(thin.geometry_opacity.value == 0.25f);
    CHECK(with_mtl("illum 4\nNi 1\n").material().geometry_opacity.value == 1);
    CHECK(with_mtl("illum 2\nNi 1.5\nd 0.25\n").material().geometry_opacity.value == 0.25f);
}

TEST_CASE("mtl: Ke is radiance; a map alone counts as 1") {
    const MaterialDesc m = with_mtl("Ke 4 8 2\n").material();
    CHECK(m.emission_luminance.value == 8 * kLumensPerWatt);
    CHECK(m.emission_color.value == Float3{0.5f, 1, 0.25f});
    CHECK(with_mtl("map_Ke e.png\n").material().emission_luminance.value == kLumensPerWatt);
    CHECK(with_mtl("Ke 0 0 0\nmap_Ke e.png\n").noted("Ke 0 would hide map_Ke"));
}

TEST_CASE("mtl: a lamp with Ka and no Ke gets a hint, other Ka is silent") {
    const std::string obj = "mtllib m.mtl\nusemtl Ceiling_Light\n" + kSquare + "f 1 2 3\n";
    CHECK(load_text(obj, {{"m.mtl", "newmtl Ceiling_Light\nKa 20 20 20\n"}})
              .warned("m.mtl:2: Ka is not emission; use Ke"));
    CHECK(with_mtl("Ka 1 1 1\n").warnings.empty());
}

TEST_CASE("mtl: a map_d that is the map_Kd file means its alpha") {
    const LoadedObj got = with_mtl("map_Kd a.png\nmap_d a.png\n");
    CHECK(got.material().geometry_opacity.texture == got.material().base_color.texture);
    CHECK(got.material().geometry_opacity.channel == Channel::a);
    CHECK(got.scene.textures.size() == 1);
    CHECK(with_mtl("map_d a.png\n").material().geometry_opacity.channel == Channel::automatic);
    CHECK(with_mtl("map_Tr a.png\n").material().geometry_opacity.invert);
}

TEST_CASE("mtl: impossible values are clamped or ignored, with the line") {
    const LoadedObj got =
        with_mtl("Kd 5 -1 nan\nKs 9\nNs -10\nNi 0\nPr -1\nPm 40\nillum 99\nKe 1e38\nd -2\n");
    const MaterialDesc& m = got.material();
    CHECK(m.base_color.value == Float3{0.8f, 0.8f, 0.8f});
    CHECK(m.specular_color.value == Float3{1, 1, 1});
    CHECK(m.specular_ior.value == 1.5f);
    CHECK(m.specular_roughness.value == 0);
    CHECK(m.base_metalness.value == 1);
    CHECK(m.emission_luminance.value == 0);
    CHECK(m.geometry_opacity.value == 0);
    CHECK(got.warned("m.mtl:2: broken material statement: not a finite number in"));
    CHECK(got.warned("m.mtl:3: value clamped: material 'a': Ks is 9, must be in [0, 1]"));
}

TEST_CASE("mtl: a missing texture stays with its name, one outside is refused") {
    const LoadedObj got = with_mtl("map_Kd no/such.png\n");
    CHECK(got.error == "");
    CHECK(texture(got, got.material().base_color.texture).file.ends_with("/no/such.png"));
    CHECK(with_mtl("map_Kd /etc/passwd\n")
              .error.find("m.mtl:2: texture '/etc/passwd' lies outside") != std::string::npos);
}

TEST_CASE("mtl: vertex colours are used where there is no map_Kd") {
    const std::string colored =
        "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf "
        "1 2 3\n";
    const LoadedObj got =
        load_text(colored, {{"m.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nmap_Kd a.png\n"}});
    CHECK(got.material(0).use_vertex_color);
    CHECK_FALSE(got.material(1).use_vertex_color);
}

TEST_CASE("mtl: materials carry the place of their newmtl, and only used ones are made") {
    const LoadedObj got =
        load_text("mtllib m.mtl\nusemtl b\n" + kSquare + "f 1 2 3\n",
                  {{"m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\n\nnewmtl b\nKd 1 1 1\n"}});
    CHECK(got.scene.materials.size() == 1);
    CHECK(got.scene.textures.empty());
    CHECK(got.material().loc.line == 5);
    CHECK(got.material().loc.file->ends_with("m.mtl"));
    CHECK(got.scene.files.size() == 2);
}

}  // namespace tessera::test
