#include "renderer/io/obj.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/support/obj_files.h"

namespace tessera::test {
namespace {

// Sum of the faces' areas, and how many faces there are.
double area(const MeshDesc& mesh) {
    const auto corner = [&](std::size_t i, int axis) {
        return mesh
            .positions[std::size_t(mesh.position_index[i]) * 3 + static_cast<std::size_t>(axis)];
    };
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
        std::array<double, 3> u{}, v{};
        for (int k = 0; k < 3; ++k) {
            u[static_cast<std::size_t>(k)] = corner(b, k) - corner(a, k);
            v[static_cast<std::size_t>(k)] = corner(c, k) - corner(a, k);
        }
        return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                u[0] * v[1] - u[1] * v[0]);
    };
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles; ++t) sum += triangle(3 * t, 3 * t + 1, 3 * t + 2);
    for (std::size_t q = 0; q < mesh.quads; ++q) {
        const std::size_t at = std::size_t(mesh.triangles) * 3 + 4 * q;
        sum += triangle(at, at + 1, at + 3) + triangle(at + 2, at + 3, at + 1);
    }
    return sum;
}

std::uint32_t faces(const LoadedObj& loaded) { return loaded.mesh.triangles + loaded.mesh.quads; }

}  // namespace

TEST_CASE("obj: a plain square is one quad with a default material and no warning") {
    const LoadedObj got = load_text(kSquare + "f 1 2 3 4\n");
    CHECK(got.error == "");
    CHECK(got.mesh.quads == 1);
    CHECK(got.mesh.triangles == 0);
    CHECK(area(got.mesh) == doctest::Approx(1));
    CHECK(got.material().specular_weight.value == 0);
    CHECK(got.mesh.normals.empty());
    CHECK(got.mesh.uvs.empty());
    CHECK(got.warnings.empty());
    CHECK(got.mesh.object_names == std::vector<std::string>{"m"});
}

TEST_CASE("obj: a byte order mark does not cost the first vertex") {
    const LoadedObj got = load_text("\xEF\xBB\xBF" + kSquare + "f 1 2 3 4\n");
    CHECK(got.mesh.quads == 1);
    CHECK(got.mesh.positions[3] == 1);
}

TEST_CASE("obj: UTF-16 with a mark is read in both byte orders") {
    for (const bool big : {true, false}) {
        std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
        for (const char c : kSquare + "f 1 2 3 4\n") {
            wide += big ? std::string({'\0', c}) : std::string({c, '\0'});
        }
        CHECK(load_text(wide).mesh.quads == 1);
    }
}

TEST_CASE("obj: lines end in LF, CRLF or CR, and the last may end in nothing") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char c : kSquare + "f 1 2 3 4") text += c == '\n' ? end : std::string(1, c);
        const LoadedObj got = load_text(text + end + "f 1 2 9");
        CHECK(got.mesh.quads == 1);
        CHECK(got.warned("m.obj:6: broken face"));
    }
}

TEST_CASE("obj: a backslash joins lines, and line numbers still count them") {
    const LoadedObj got = load_text(kSquare + "f 1 2 \\\n 3 4\nf 1 2 0\n");
    CHECK(got.mesh.quads == 1);
    CHECK(got.warned("m.obj:7: broken face"));
    CHECK(load_text(kSquare + "f 1 2 3\\").mesh.triangles == 1);
}

TEST_CASE("obj: a comment may follow numbers") {
    const LoadedObj got = load_text(kSquare + "f 1 2 3 # first\nf 1 3 4# second\n");
    CHECK(got.mesh.triangles == 2);
    CHECK(got.warnings.empty());
}

TEST_CASE("obj: index 0 drops the face with its line") {
    const LoadedObj got = load_text(kSquare + "f 0 1 2\nf 1 2 3\n");
    CHECK(got.mesh.triangles == 1);
    CHECK(got.warned("m.obj:5: broken face: indices count from 1"));
}

TEST_CASE("obj: a decimal comma is refused with its line") {
    const LoadedObj got = load_text("v 0,5 1,25 0\n" + kSquare + "f 1 2 3\n");
    CHECK(got.error.find("m.obj:1: decimal comma in '0,5'") != std::string::npos);
}

TEST_CASE(
    "obj: a vertex that is no finite number drops its faces only, and the rest keep their "
    "indices") {
    for (const std::string bad :
         {"nan 0 0", "inf 0 0", "0x10 0 0", "1e400 0 0", "1e16 0 0", "1 2", "x y z", ""}) {
        CAPTURE(bad);
        const LoadedObj got = load_text("v " + bad + "\n" + kSquare + "f 1 2 3\nf 2 3 4 5\n");
        CHECK(got.mesh.triangles == 0);
        CHECK(got.mesh.quads == 1);
        CHECK(got.mesh.positions.size() == 12);
        CHECK(area(got.mesh) == doctest::Approx(1));
        CHECK(got.warned("m.obj:1: vertex is not"));
        CHECK(got.warned("m.obj:6: broken face"));
    }
}

TEST_CASE("obj: number formats of the wild are read") {
    const LoadedObj got =
        load_text("v .5 -.5 +2.\nv 1E2 1e-002 1e+1\nv 0 00001.5 5000000.125\nf 1 2 3\n");
    const std::vector<double> expected{.5, -.5, 2, 100, .01, 10, 0, 1.5, 5000000.125};
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(got.mesh.positions.at(i) == doctest::Approx(expected[i]).epsilon(1e-15));
}

TEST_CASE(
    "obj: an index past the end drops the face, even when it comes in 64 bits or wraps in 32") {
    for (const std::string bad : {"5", "-5", "4294967297", "2147483648", "99999999999999999999999",
                                  "-9223372036854775809"}) {
        CAPTURE(bad);
        const LoadedObj got = load_text(kSquare + "f 1 2 " + bad + "\nf 1 2 3\n");
        CHECK(got.mesh.triangles == 1);
        CHECK(got.warned("m.obj:5: broken face"));
    }
}

TEST_CASE("obj: a uv or normal index past the end is ignored and the face kept") {
    const LoadedObj got = load_text(kSquare + "vt 0 0\nf 1/1/4 2/99999999999/1 3/7/1\n");
    CHECK(got.mesh.triangles == 1);
    CHECK(got.mesh.normals.empty());
    CHECK(got.warned("m.obj:6: face names a vt or vn"));
}

TEST_CASE("obj: broken faces are dropped and told") {
    const LoadedObj got = load_text(
        kSquare + "f\nf 1\nf 1 2\nf / / /\nf a b c\nf 1 2 x\nf 1.5 2 3\nf 1/2/3/4 2 3\nf 1 2 3\n");
    CHECK(got.mesh.triangles == 1);
    CHECK(got.warned("m.obj:5: face of fewer than three"));
    CHECK(got.warned("m.obj:8: broken face: corners must be"));
}

TEST_CASE("obj: what is broken is refused with its line unless one is lenient") {
    const auto refused = [](const std::string& text, const std::string& where) {
        const std::string error = refusal(kSquare + "f 1 2 3\n" + text);
        CAPTURE(error);
        CHECK(error.find(where) != std::string::npos);
        CHECK(error.find("--lenient") != std::string::npos);
    };
    refused("f 1 2 9\n", "m.obj:6: broken face: it uses a vertex that is not in the file");
    refused("f 0 1 2\n", "m.obj:6: broken face: indices count from 1");
    refused("f a b c\n", "m.obj:6: broken face: corners must be");
    refused("v nan 0 0\nf 1 2 5\n",
            "m.obj:7: broken face: its vertex is not three finite "
            "numbers below 1e15: vertex 5 in line 6");
    refused("vn inf 0 0\n", "m.obj:6: broken vn");
    refused("vt nan\n", "m.obj:6: broken vt");
    refused("v 1 2 3 nan 0 0\n", "m.obj:6: broken vertex colour");
    CHECK(refusal("mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n",
                  {{"m.mtl", "newmtl a\nKd nan 0 0\n"}})
              .find("m.mtl:2: broken material statement: not a finite number in 'Kd'") !=
          std::string::npos);
}

TEST_CASE("obj: what can be replaced or is not used is no reason to refuse a file") {
    CHECK(refusal(kSquare + "v nan 0 0\nf 1 2 3\n") == "");
    CHECK(refusal(kSquare + "f 1/1/1 2/2/2 3/3/3\n") == "");
    CHECK(refusal(kSquare + "f 1 2 3\nf 1 1 2\nf 1 2\n") == "");
}

TEST_CASE("obj: relative indices count back from the line they stand on") {
    const LoadedObj got = load_text(kSquare + "f -4 -3 -2 -1\nv 9 9 9\n");
    CHECK(got.mesh.quads == 1);
    CHECK(got.mesh.positions.size() == 12);
    CHECK(area(got.mesh) == doctest::Approx(1));
}

TEST_CASE("obj: faces may come before the vertices they name") {
    CHECK(load_text("f 1 2 3 4\n" + kSquare).mesh.quads == 1);
}

TEST_CASE("obj: a polygon of more than 255 corners is split whole") {
    std::string text;
    std::string face = "f";
    constexpr int kCorners = 300;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * 3.14159265358979323846 * i / kCorners;
        text +=
            "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    const LoadedObj got = load_text(text + face + "\n");
    CHECK(got.mesh.triangles == kCorners - 2);
    // Coordinates have six decimals: the area is right to about 1e-5.
    CHECK(
        area(got.mesh) ==
        doctest::Approx(0.5 * kCorners * std::sin(2 * 3.14159265358979 / kCorners)).epsilon(1e-5));
}

TEST_CASE("obj: a concave quad is split along the diagonal inside it") {
    // An arrow head: the diagonal from the tip to the notch is the longer one.
    const std::string arrow = "v 0 0 0\nv 10 -0.5 0\nv 8 0 0\nv 10 0.5 0\n";
    for (const std::string order : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
        CAPTURE(order);
        const LoadedObj got = load_text(arrow + order + "\n");
        CHECK(got.mesh.quads == 1);
        CHECK(area(got.mesh) == doctest::Approx(4));  // two triangles of 8 x 0.5 / 2
    }
}

TEST_CASE("obj: faces without area are dropped and counted") {
    const LoadedObj got =
        load_text(kSquare + "v 2 0 0\nf 1 2 5\nf 1 1 2\nf 1 2 1 2\nf 1 2 3 3\nf 1 2 3 4\n");
    CHECK(got.mesh.triangles == 1);  // 'f 1 2 3 3' is a triangle
    CHECK(got.mesh.quads == 1);
    CHECK(got.noted("3 faces without area dropped"));
}

TEST_CASE("obj: w is no colour, six values are one, and uncoloured vertices are white") {
    const LoadedObj plain = load_text("v 0 0 0 0.5\nv 1 0 0 0.5\nv 0 1 0 0.5\nf 1 2 3\n");
    CHECK(plain.mesh.colors.empty());
    CHECK_FALSE(plain.material().use_vertex_color);
    const LoadedObj got = load_text("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 0.25\nv 9 9 9\nf 1 2 3\n");
    CHECK(got.mesh.colors == std::vector<float>{1, 0, 0, 1, 1, 1, 0, 0, 0.25f});
    CHECK(got.material().use_vertex_color);
    const LoadedObj bytes = load_text("v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    CHECK(bytes.mesh.colors[0] == 1);
    const LoadedObj bad = load_text("v 0 0 0 nan 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    CHECK(bad.mesh.colors[0] == 1);
    CHECK(bad.warned("m.obj:1: broken vertex colour"));
}

TEST_CASE("obj: given normals are normalised, and those without a direction are computed") {
    const LoadedObj got =
        load_text(kSquare + "vn 0 0 5\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    REQUIRE(got.mesh.normals.size() >= 6);
    for (std::size_t i = 0; i < got.mesh.normals.size(); i += 3)
        CHECK(got.mesh.normals[i + 2] == doctest::Approx(1));
    CHECK(got.mesh.normal_index.size() == 6);
}

TEST_CASE("obj: a smoothing group shares normals, another and 's off' do not") {
    // Two squares at a right angle over the edge 1-2.
    const std::string fold = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 0 0 1\n";
    const auto normal_z = [](const LoadedObj& got, std::size_t corner) {
        const MeshDesc& mesh = got.mesh;
        const auto index = mesh.normal_index.empty() ? mesh.position_index : mesh.normal_index;
        return mesh.normals.at(std::size_t(index.at(corner)) * 3 + 2);
    };
    const LoadedObj smooth = load_text(fold + "s 1\nf 1 2 3 4\nf 2 1 6 5\n");
    CHECK(normal_z(smooth, 0) == doctest::Approx(std::sqrt(0.5)));  // at the fold: half way
    CHECK(normal_z(smooth, 2) == doctest::Approx(1));
    const LoadedObj two = load_text(fold + "s 1\nf 1 2 3 4\ns 2\nf 2 1 6 5\n");
    CHECK(normal_z(two, 0) == doctest::Approx(1));
    const LoadedObj mixed = load_text(fold + "s 1\nf 1 2 3 4\ns off\nf 2 1 6 5\n");
    CHECK(normal_z(mixed, 0) == doctest::Approx(1));
    CHECK(std::abs(normal_z(mixed, 4)) < 1e-6);  // the flat face has its own
    CHECK(load_text(fold + "f 1 2 3 4\nf 2 1 6 5\n").mesh.normals.empty());
    CHECK(load_text(fold + "s off\nf 1 2 3 4\n").mesh.normals.empty());
}

TEST_CASE(
    "obj: index arrays that repeat the positions' are left out, uvs of faces without are zero") {
    const std::string uvs = "vt 0.25 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    const LoadedObj same = load_text(kSquare + uvs + "f 1/1 2/2 3/3 4/4\n");
    CHECK(same.mesh.uv_index.empty());
    CHECK(same.mesh.uvs.size() == 8);
    const LoadedObj partly = load_text(kSquare + uvs + "f 1/1 2/2 3/3\nf 1 3 4\n");
    REQUIRE(partly.mesh.uv_index.size() == 6);
    const std::size_t missing = partly.mesh.uv_index[3];
    CHECK(partly.mesh.uvs[2 * missing] == 0);
    CHECK(partly.mesh.uvs[2 * missing + 1] == 0);
    CHECK(partly.mesh.uvs[0] == 0.25f);
}

TEST_CASE("obj: objects are named by 'o', else by all words of 'g', else by the file") {
    const LoadedObj got = load_text(kSquare + "f 1 2 3\ng g1 g2\nf 1 2 3\no A\ng B\nf 1 2 3\n");
    CHECK(got.mesh.object_names == std::vector<std::string>{"m", "g1 g2", "A"});
    CHECK(got.mesh.face_object == std::vector<std::uint32_t>{0, 1, 2});
}

TEST_CASE("obj: faces are numbered triangles first, and keep their material and object") {
    const LoadedObj got = load_text(kSquare + "usemtl q\nf 1 2 3 4\nusemtl t\nf 1 2 3\n",
                                    {{"m.mtl", "newmtl q\nKd 1 0 0\nnewmtl t\nKd 0 1 0\n"}});
    CHECK(got.mesh.face_material == std::vector<std::uint32_t>{1, 0});
}

TEST_CASE("obj: lines and points are counted, unknown statements told once") {
    const LoadedObj got = load_text(kSquare + "l 1 2\np 1\nvw 1 2\nt x\nf 1 2 3\n");
    CHECK(got.mesh.triangles == 1);
    CHECK(got.noted("2 point or line elements ignored"));
    CHECK(got.noted("m.obj:7: 2 lines not understood, the first starts with 'vw'"));
}

TEST_CASE("obj: a file in order without anything to render is a warning and an empty mesh") {
    for (const std::string& text :
         {kSquare + "l 1 2\n", kSquare + "f 1 2 2\n", std::string("usemtl a\n")}) {
        const LoadedObj got = load_text(text);
        CHECK(got.error == "");
        CHECK(faces(got) == 0);
        CHECK_FALSE(got.warnings.empty());
    }
}

TEST_CASE("obj: a file that gives no face is an error that names it") {
    std::string junk;
    for (int i = 0; i < 5000; ++i) junk += static_cast<char>((i * 7919) >> 3);
    for (const std::string& text :
         {std::string(), std::string("# nothing\n"), junk, kSquare, kSquare + "f 1 2 9\n"})
        CHECK(load_text(text).error.find("m.obj: no") != std::string::npos);
    const ObjFiles files;
    CHECK(load_file(files, "gone.obj").error.find("cannot be read") != std::string::npos);
    CHECK(load_file(files, ".").error.find("not a regular file") != std::string::npos);
}

TEST_CASE("obj: a face of 100 000 corners in a zigzag ends soon") {
    std::string text;
    std::string face = "f";
    for (int i = 0; i < 100000; ++i) {
        text += "v " + std::to_string(i % 2 == 0 ? i : 100000 - i) + " " +
                std::to_string((i * 7919) % 1000) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    CHECK(load_text(text + face + "\n").error == "");
}

TEST_CASE("obj: a million broken lines give a short report") {
    std::string text = kSquare + "f 1 2 3\n";
    for (int i = 0; i < 20000; ++i)
        text += "f 1 2 0\nusemtl m" + std::to_string(i) + "\nmtllib l" + std::to_string(i % 50) +
                ".mtl\nf 1 2 3\n";
    const LoadedObj got = load_text(text);
    CHECK(got.error == "");
    CHECK(got.warnings.size() < 40);
    CHECK(got.warned("19997 more: broken face"));
}

TEST_CASE("obj: every odd scene loads, every bad one is refused") {
    const std::filesystem::path tests = std::filesystem::path(TESSERA_SOURCE_DIR) / "tests";
    int odd = 0;
    int bad = 0;
    for (const std::string folder : {"odd_scenes", "bad_scenes"}) {
        for (const auto& entry : std::filesystem::directory_iterator(tests / folder)) {
            if (entry.path().extension() != ".obj") continue;
            CAPTURE(entry.path().string());
            const LoadedObj got = load_path(entry.path().string(), Strictness::normal);
            const bool is_odd = folder == "odd_scenes";
            CHECK(got.error.empty() == is_odd);
            ++(is_odd ? odd : bad);
        }
    }
    CHECK(odd >= 6);
    CHECK(bad >= 7);
}

}  // namespace tessera::test
