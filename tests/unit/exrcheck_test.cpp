#include "renderer/image/check/check_exr.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "renderer/api/image.h"
#include "renderer/core/murmur3.h"
#include "tests/support/exr_bytes.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr auto kFloat = ExrBytes::real;

ExrBytes::Values constant(float v) {
    return [v](int, int) { return v; };
}
/// v at one pixel, 0.5 elsewhere.
ExrBytes::Values once(float v) {
    return [v](int x, int y) { return x == 3 && y == 2 ? v : 0.5f; };
}

void add(ExrBytes& file, const std::string& layer, const std::string& tokens, float v,
         ExrBytes::Type type = ExrBytes::half) {
    for (const char token : tokens) {
        ExrBytes::Channel& c = file.channel(layer + "." + token);
        c.type = type;
        c.value = constant(v);
    }
}

std::string text_of_floats(std::initializer_list<float> values) {
    std::string out(values.size() * sizeof(float), '\0');
    std::memcpy(out.data(), values.begin(), out.size());
    return out;
}

/// A picture without a fault.
ExrBytes clean() {
    ExrBytes file;
    file.parts.emplace_back();
    for (const char* name : {"R", "G", "B", "A"}) file.channel(name);
    ExrBytes::Channel& z = file.channel("Z");
    z.type = kFloat;
    z.value = constant(7);
    file.part().attributes.push_back(
        {"chromaticities", "chromaticities",
         text_of_floats({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f})});
    return file;
}

/// With a Cryptomatte of one object, "torus", that covers half of each pixel.
ExrBytes with_matte() {
    ExrBytes file = clean();
    add(file, "CryptoObject00", "RGBA", 0, kFloat);
    file.channel("CryptoObject00.R").value =
        constant(std::bit_cast<float>(cryptomatte_id("torus")));
    file.channel("CryptoObject00.G").value = constant(0.5f);
    const std::string key = "cryptomatte/3ae39a5/";
    file.attribute(key + "name", "CryptoObject");
    file.attribute(key + "hash", "MurmurHash3_32");
    file.attribute(key + "conversion", "uint32_to_float32");
    file.attribute(key + "manifest", R"({"torus":"f19c73fd"})");
    return file;
}

/// With all passes of light, which sum to beauty's 0.5.
ExrBytes with_passes() {
    ExrBytes file = clean();
    for (const char* pass : {"diffuse_direct", "diffuse_indirect", "specular", "background"})
        add(file, pass, "RGB", 0.125f);
    add(file, "emission", "RGB", 0);
    return file;
}

ExrFindings check(const std::string& bytes) {
    const TempFolder folder;
    write_anew(folder / "a.exr", bytes);
    return check_exr(folder / "a.exr");
}

std::set<std::string> rules_of(const ExrFindings& findings) {
    std::set<std::string> ids;
    for (const ExrFinding& f : findings) ids.insert(text_of(f.rule).id);
    return ids;
}

void set_attribute(ExrBytes& file, const std::string& end, const std::string& text) {
    for (ExrBytes::Attribute& a : file.part().attributes)
        if (a.name.ends_with(end)) a.bytes = text;
}

struct Spoilt {
    std::function<ExrBytes()> from = clean;
    std::function<void(ExrBytes&)> spoil;
    std::set<std::string> with = {};  // further rules that it breaks
};

void second_part(ExrBytes& f) {
    f.parts.push_back(f.parts[0]);
    f.parts[0].name = "beauty";
    f.parts[1].name = "N";
    f.parts[1].channels.clear();
    for (const char* c : {"N.X", "N.Y", "N.Z"}) {
        f.channel(c, 1).type = kFloat;
        f.channel(c, 1).value = constant(c[2] == 'Z' ? 1.0f : 0.0f);
    }
}

/// One fault of each rule that a header or pixels can break.
const std::map<std::string, Spoilt>& faults() {
    static const std::map<std::string, Spoilt> all{
        {"bad-window", {clean, [](ExrBytes& f) { f.part().x1 = -4; }}},
        {"window-outside-frame", {clean, [](ExrBytes& f) { f.part().x0 = 20, f.part().x1 = 28; }}},
        {"window-offset", {clean, [](ExrBytes& f) { f.part().x0 = -2; }}},
        {"unequal-parts",
         {clean, [](ExrBytes& f) { second_part(f), f.parts[1].y1 = 3; }, {"window-offset"}}},
        {"bare-names-in-parts",
         {clean,
          [](ExrBytes& f) {
              second_part(f);
              for (ExrBytes::Channel& c : f.parts[1].channels) c.name = c.name.substr(2);
          }}},
        {"magenta-layer", {clean, [](ExrBytes& f) { add(f, "motion", "XY", 1, kFloat); }}},
        {"unknown-token", {clean, [](ExrBytes& f) { f.channel("id.ID").type = kFloat; }}},
        {"long-name", {clean, [](ExrBytes& f) { add(f, std::string(30, 'n'), "RGB", 1); }}},
        {"many-dots", {clean, [](ExrBytes& f) { add(f, "a.b.c", "RGB", 1); }}},
        {"stereo-name", {clean, [](ExrBytes& f) { add(f, "key_left", "RGB", 1); }}},
        {"leading-digit", {clean, [](ExrBytes& f) { add(f, "2nd", "RGB", 1); }}},
        {"name-clash",
         {clean, [](ExrBytes& f) { add(f, "a-b", "RGB", 1), add(f, "a_b", "RGB", 1); }}},
        {"half-data", {clean, [](ExrBytes& f) { f.channel("Z").type = ExrBytes::half; }}},
        {"lossy-data", {clean, [](ExrBytes& f) { f.part().compression = 8; }}},
        {"integer-id", {clean, [](ExrBytes& f) { f.channel("id.X").type = ExrBytes::integer; }}},
        {"no-chromaticities", {clean, [](ExrBytes& f) { f.part().attributes.clear(); }}},
        {"aces-flag",
         {clean,
          [](ExrBytes& f) {
              f.part().attributes.push_back({"acesImageContainerFlag", "int", {1, 0, 0, 0}});
          }}},
        {"nan", {clean, [](ExrBytes& f) { f.channel("G").value = once(std::nanf("")); }}},
        {"infinite", {clean, [](ExrBytes& f) { f.channel("G").value = once(kInf); }}},
        {"infinite-depth", {clean, [](ExrBytes& f) { f.channel("Z").value = once(kInf); }}},
        {"infinite-lossy",
         {clean,
          [](ExrBytes& f) {
              std::erase_if(f.part().channels, [](const auto& c) { return c.name == "Z"; });
              f.part().compression = 9;
              f.channel("G").value = once(kInf);
          },
          {"infinite"}}},
        {"negative-colour", {clean, [](ExrBytes& f) { f.channel("B").value = once(-0.1f); }}},
        {"half-limit", {clean, [](ExrBytes& f) { f.channel("B").value = once(65504); }}},
        {"alpha-range", {clean, [](ExrBytes& f) { f.channel("A").value = once(1.1f); }}},
        {"light-without-alpha", {clean, [](ExrBytes& f) { f.channel("A").value = once(0); }}},
        {"normal-length", {clean, [](ExrBytes& f) { add(f, "N", "XYZ", 0.3f, kFloat); }}},
        {"matte-storage",
         {with_matte, [](ExrBytes& f) { f.channel("CryptoObject00.A").type = ExrBytes::half; }}},
        {"matte-metadata", {with_matte, [](ExrBytes& f) { set_attribute(f, "/hash", "md5"); }}},
        {"matte-key",
         {with_matte,
          [](ExrBytes& f) {
              for (ExrBytes::Attribute& a : f.part().attributes)
                  if (a.name.starts_with("crypto")) a.name.replace(12, 7, "1234567");
          }}},
        {"matte-manifest",
         {with_matte, [](ExrBytes& f) { set_attribute(f, "manifest", "{\"torus\":}"); }}},
        {"matte-names",
         {with_matte,
          [](ExrBytes& f) {
              set_attribute(f, "manifest", R"({"torus":"f19c73fd","cube":"00000001"})");
          }}},
        {"matte-layers",
         {with_matte, [](ExrBytes& f) { add(f, "CryptoAsset00", "RGBA", 0, kFloat); }}},
        {"matte-coverage",
         {with_matte, [](ExrBytes& f) { f.channel("CryptoObject00.G").value = once(1.1f); }}},
        {"matte-ids", {with_matte, [](ExrBytes& f) { set_attribute(f, "manifest", "{}"); }}},
        {"sum-of-passes",
         {with_passes, [](ExrBytes& f) { f.channel("emission.G").value = once(0.01f); }}},
        {"sum-of-lights",
         {clean,
          [](ExrBytes& f) {
              add(f, "RGBA_key", "RGB", 0.25f);
              add(f, "RGBA_fill", "RGB", 0.2f);
          }}},
    };
    return all;
}

}  // namespace

TEST_CASE("murmur: names hash to the specification's vectors") {
    CHECK(murmur3("torus") == 4053562365u);
    CHECK(murmur3("равнина") == 2518896926u);
    CHECK(murmur3("bunny") == 0x13851a76u);
    CHECK(murmur3("") == 0);
}

TEST_CASE("exrcheck: a good file is clean") {
    CHECK(rules_of(check(clean().bytes())).empty());
    CHECK(rules_of(check(with_matte().bytes())).empty());
    CHECK(rules_of(check(with_passes().bytes())).empty());
    ExrBytes parts = clean();
    second_part(parts);
    CHECK(rules_of(check(parts.bytes())).empty());
}

TEST_CASE("exrcheck: each fault is found, and nothing else") {
    for (const auto& entry : faults()) {
        const std::string id = entry.first;
        const auto& fault = entry.second;
        CAPTURE(id);
        ExrBytes file = fault.from();
        fault.spoil(file);
        std::set<std::string> wanted = fault.with;
        wanted.insert(id);
        CHECK(rules_of(check(file.bytes())) == wanted);
    }
}

TEST_CASE("exrcheck: a lone channel A is no alpha") {
    ExrBytes file = clean();
    add(file, "sample_count", "A", 64, kFloat);
    CHECK(rules_of(check(file.bytes())).empty());
    add(file, "glow", "RGBA", 1.1f);
    CHECK(rules_of(check(file.bytes())) == std::set<std::string>{"alpha-range"});
}

TEST_CASE("exrcheck: every rule has a test") {
    std::set<std::string> tested{"unreadable", "truncated", "damaged-pixels", "not-looked-at",
                                 "deep"};  // in the cases below
    for (const auto& [id, fault] : faults()) tested.insert(id);
    std::set<std::string> all;
    for (const ExrRuleText& rule : exr_rules()) {
        CHECK(all.insert(rule.id).second);
        CHECK(std::string(rule.text).ends_with("."));
        CHECK(std::string(rule.remedy).ends_with("."));
    }
    CHECK(tested == all);
}

TEST_CASE("exrcheck: docs/exrcheck.md holds the table of the rules") {
    std::ifstream in(TESSERA_SOURCE_DIR "/docs/exrcheck.md");
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    CHECK(page.find(exr_rules_markdown()) != std::string::npos);
}

TEST_CASE("exrcheck: a file cut anywhere is truncated or unreadable") {
    const std::string whole = clean().bytes();
    for (std::size_t size = 0; size < whole.size(); size += 7) {
        CAPTURE(size);
        const std::set<std::string> rules = rules_of(check(whole.substr(0, size)));
        const bool told = rules.contains("unreadable") || rules.contains("truncated") ||
                          rules.contains("damaged-pixels");
        CHECK(told);
    }
    CHECK(rules_of(check("text")) == std::set<std::string>{"unreadable"});
    CHECK(rules_of(check_exr("/nowhere/a.exr")) == std::set<std::string>{"unreadable"});
}

TEST_CASE("exrcheck: a file that lacks its last byte is truncated") {
    const std::string whole = clean().bytes();
    CHECK(rules_of(check(whole.substr(0, whole.size() - 1))).contains("truncated"));
    ExrBytes parts = clean();
    second_part(parts);
    const std::string two = parts.bytes();
    CHECK(rules_of(check(two.substr(0, two.size() - 1))).contains("truncated"));
}

TEST_CASE("exrcheck: a chunk that says nonsense is damage") {
    std::string bytes = clean().bytes();
    const std::size_t chunk = 8 + 8 * (4 * 2 + 4);  // of one line: y, size, pixels
    bytes[bytes.size() - 2 * chunk + 4] = 100;      // size of the last line but one
    CHECK(rules_of(check(bytes)) == std::set<std::string>{"damaged-pixels"});
}

TEST_CASE("exrcheck: what claims to be huge is not believed") {
    ExrBytes file = clean();
    std::string bytes = file.bytes();
    const std::size_t at = bytes.find("dataWindow") + 11 + 6 + 4;
    const int far = (1 << 24) - 2;
    std::memcpy(bytes.data() + at + 8, &far, sizeof far);
    std::memcpy(bytes.data() + at + 12, &far, sizeof far);
    const std::set<std::string> rules = rules_of(check(bytes));
    CHECK(rules.contains("truncated"));
    CHECK(rules.contains("not-looked-at"));
}

TEST_CASE("exrcheck: deep parts are named, not looked into") {
    ExrBytes file = clean();
    std::string bytes = file.bytes();
    bytes[5] = static_cast<char>(bytes[5] | 0x08);
    CHECK(rules_of(check(bytes)).contains("deep"));
}

TEST_CASE("exrcheck: no damage to any byte crashes or hangs it") {
    const std::string whole = with_matte().bytes();
    const TempFolder folder;
    std::uint32_t state = 5;
    for (int trial = 0; trial < 1500; ++trial) {
        std::string bytes = whole;
        for (int k = 0; k < 1 + trial % 4; ++k) {
            state = state * 1664525u + 1013904223u;
            // Mostly the header and the table, where the power is.
            const std::size_t range = trial % 5 == 0 ? bytes.size() : bytes.size() / 2;
            bytes[(state >> 8) % range] = static_cast<char>(state >> 3);
        }
        write_anew(folder / "a.exr", bytes);
        for (const ExrFinding& f : check_exr(folder / "a.exr")) REQUIRE_FALSE(f.where.empty());
    }
}

TEST_CASE("exrcheck: what Tessera writes is clean in every layout") {
    const TempFolder folder;
    LayeredImage image;
    image.width = 8, image.height = 4;
    image.window = {0, 0, 8, 4};
    image.layers = {{"", {"R", "G", "B", "A"}, LayerKind::color, std::vector<float>(128, 0.5f)},
                    {"", {"Z"}, LayerKind::data, std::vector<float>(32, 3.0f)},
                    {"N", {"X", "Y", "Z"}, LayerKind::data, std::vector<float>(96, 0.57735f)},
                    {"albedo", {"R", "G", "B"}, LayerKind::color, std::vector<float>(96, 0.5f)}};
    for (const ExrLayout layout : {ExrLayout::single, ExrLayout::multipart, ExrLayout::split}) {
        WriteOptions options;
        options.layout = layout;
        if (layout != ExrLayout::single) options.compression = ExrCompression::dwaa;
        for (const std::string& path : write_exr(image, folder / "a.exr", options).files) {
            CAPTURE(path);
            CHECK(rules_of(check_exr(path)).empty());
        }
    }
}
