#include "renderer/io/params.h"

#include <doctest/doctest.h>

#include <limits>

#include "renderer/core/nearest_name.h"
#include "renderer/io/scene_parse.h"

using namespace tessera;

namespace {

enum class Mode : std::uint8_t { slow, fast };

struct Thing {
    double angle_deg = 40;
    int count = 3;
    Double3 at{1, 2, 3};
    Float3 tint{1, 1, 1};
    Mode mode = Mode::slow;
    bool lit = false;
    std::string label;
    Matrix34 matrix = kIdentity34;
};

const KeySet<Thing>& thing_keys() {
    static const KeySet<Thing> keys{
        {"thing",
         {
             key("angle_deg", &Thing::angle_deg, "",
                 {.low = 0, .high = 180, .open_low = true, .open_high = true}),
             key("count", &Thing::count, "", {.low = 1, .high = 10}),
             key("at", &Thing::at, ""),
             key("tint", &Thing::tint, "", kUnitClamped),
             choice("mode", &Thing::mode, {"slow", "fast"}, ""),
             key("lit", &Thing::lit, ""),
             key("label", &Thing::label, "").must(),
             key("matrix", &Thing::matrix, ""),
         }}};
    return keys;
}

struct Outcome {
    Thing thing;
    Problems problems;
};

Outcome read(const std::string& text) {
    Outcome outcome;
    const Value table = parse_toml(text, "t.toml");
    read_keys(table, thing_keys(), outcome.thing, {outcome.problems, "thing"});
    return outcome;
}

/// The only problem of one line beside a label.
std::string problem_of(const std::string& line) {
    const Outcome outcome = read("label = 'x'\n" + line);
    REQUIRE(outcome.problems.errors().size() == 1);
    return outcome.problems.errors()[0];
}

}  // namespace

TEST_CASE("params: every kind of value reaches its member") {
    const Outcome outcome = read(R"(
        angle_deg = 90
        count = 7
        at = [1.5, -2, 0]
        tint = 0.25
        mode = "fast"
        lit = true
        label = "é"
        matrix = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]]
    )");
    CHECK(outcome.problems.errors().empty());
    CHECK(outcome.thing.angle_deg == 90);
    CHECK(outcome.thing.count == 7);
    CHECK(outcome.thing.at == Double3{1.5, -2, 0});
    CHECK(outcome.thing.tint == Float3{0.25f, 0.25f, 0.25f});
    CHECK(outcome.thing.mode == Mode::fast);
    CHECK(outcome.thing.lit);
    CHECK(outcome.thing.label == "é");
    CHECK(outcome.thing.matrix == Matrix34{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
}

TEST_CASE("params: what is not written keeps its default") {
    const Outcome outcome = read("label = 'x'");
    CHECK(outcome.problems.errors().empty());
    CHECK(outcome.thing.angle_deg == 40);
    CHECK(outcome.thing.at == Double3{1, 2, 3});
}

TEST_CASE("params: a misfit is located and says what was found and what was expected") {
    CHECK(problem_of("angle_deg = 190") ==
          "t.toml:2:1: thing: angle_deg is 190, must be in (0, 180)");
    CHECK(problem_of("angle_deg = 180.0") ==
          "t.toml:2:1: thing: angle_deg is 180.0, must be in (0, 180)");
    CHECK(problem_of("angle_deg = 'wide'") ==
          "t.toml:2:1: thing: angle_deg is 'wide', must be a number");
    CHECK(problem_of("count = 2.0") == "t.toml:2:1: thing: count is 2.0, must be a whole number");
    CHECK(problem_of("count = 0") == "t.toml:2:1: thing: count is 0, must be in [1, 10]");
    CHECK(problem_of("at = [1, 2]") ==
          "t.toml:2:1: thing: at is an array of 2, must be 3 numbers in brackets");
    CHECK(problem_of("at = [1, true, 2]") == "t.toml:2:10: thing: at[1] is true, must be a number");
    CHECK(problem_of("mode = 'medium'") ==
          "t.toml:2:1: thing: mode is 'medium', must be 'slow' or 'fast'");
    CHECK(problem_of("lit = 1") == "t.toml:2:1: thing: lit is 1, must be true or false");
    CHECK(problem_of("matrix = [[1, 0, 0, 0]]") ==
          "t.toml:2:1: thing: matrix is an array of 1, must be 3 rows of 4 numbers in brackets");
    CHECK(problem_of("matrix = [[1, 0, 0, 0], [0, 1, 0, 0], 3]") ==
          "t.toml:2:39: thing: matrix is 3, must be 3 rows of 4 numbers in brackets");
    CHECK(problem_of("mode = 1979-05-27") ==
          "t.toml:2:1: thing: mode is a date or time, must be 'slow' or 'fast'");
}

TEST_CASE("params: nan, infinity and numbers beyond reach are refused") {
    CHECK(problem_of("at = [nan, 0, 0]") == "t.toml:2:7: thing: at[0] is nan, must be finite");
    CHECK(problem_of("at = [0, 0, -inf]") == "t.toml:2:13: thing: at[2] is -inf, must be finite");
    CHECK(problem_of("at = [0, 1e300, 0]") ==
          "t.toml:2:10: thing: at[1] is 1e+300, must be between -1e12 and 1e12");
    CHECK(problem_of("count = 9223372036854775807").find("must be in [1, 10]") !=
          std::string::npos);
}

TEST_CASE("params: a clamped colour is a warning and lands on the edge") {
    const Outcome outcome = read("label = 'x'\ntint = [1.5, 0.5, -1]");
    CHECK(outcome.problems.errors().empty());
    REQUIRE(outcome.problems.warnings().size() == 2);
    CHECK(outcome.problems.warnings()[0] == "t.toml:2:9: thing: tint[0] is 1.5, clamped to [0, 1]");
    CHECK(outcome.thing.tint == Float3{1, 0.5f, 0});
}

TEST_CASE("params: a misfit leaves the member as it was") {
    const Outcome outcome = read("label = 'x'\nat = [7, 7, 'x']\nangle_deg = -1");
    CHECK(outcome.problems.errors().size() == 2);
    CHECK(outcome.thing.at == Double3{1, 2, 3});
    CHECK(outcome.thing.angle_deg == 40);
}

TEST_CASE("params: an unknown key is an error with the nearest name") {
    CHECK(problem_of("cuont = 3") ==
          "t.toml:2:1: thing: unknown key 'cuont' (did you mean 'count'?)");
    CHECK(problem_of("angle = 3") ==
          "t.toml:2:1: thing: unknown key 'angle' (did you mean 'angle_deg'?)");
    CHECK(problem_of("zebra = 3") == "t.toml:2:1: thing: unknown key 'zebra'");
}

TEST_CASE("params: a missing key is named at its table") {
    const Outcome outcome = read("count = 3");
    REQUIRE(outcome.problems.errors().size() == 1);
    CHECK(outcome.problems.errors()[0] == "t.toml:1:1: thing: key 'label' is missing");
}

TEST_CASE("nearest name: swaps, cuts at '_' and letter case count as near, strangers do not") {
    const std::vector<std::string> names{"base_color", "specular_roughness", "specular_ior", "spp"};
    CHECK(nearest_name("ruoghness", names) == "specular_roughness");
    CHECK(nearest_name("Base_Colour", names) == "base_color");
    CHECK(nearest_name("ior", names) == "specular_ior");
    CHECK(nearest_name("sp", names).empty());
    CHECK(nearest_name("elephant", names).empty());
    CHECK(nearest_name("", names).empty());
    CHECK(nearest_name(std::string(100000, 'a'), names).empty());
}

TEST_CASE(
    "nearest name: the edit distance counts a swap of neighbours once and stops at its limit") {
    CHECK(edit_distance("roughness", "ruoghness", 9) == 1);
    CHECK(edit_distance("kitten", "sitting", 9) == 3);
    CHECK(edit_distance("", "abc", 9) == 3);
    CHECK(edit_distance("abcdef", "uvwxyz", 2) == 2);
}

TEST_CASE("toml: a syntax error is located") {
    const auto message = [](const std::string& text) {
        try {
            parse_toml(text, "t.toml");
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::scene);
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK(message("a = 1\nb = ").starts_with("t.toml:2:"));
    CHECK(message("[camera\n").starts_with("t.toml:1:"));
    CHECK(message("a = 1\n[b]\n[= 3]\nc = 1") == "t.toml:3: this line is no valid TOML");
    CHECK(message("[=") == "t.toml:1: this line is no valid TOML");
    CHECK(message("a = 1\na = 2").starts_with("t.toml:2:"));
    CHECK(message(std::string("a = \"\xff\"")).starts_with("t.toml:1:"));
}

TEST_CASE("toml: deep nesting of every kind is refused before it can exhaust the stack") {
    const auto repeated = [](const std::string& part, int count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += part;
        return text;
    };
    constexpr int kDeep = 200000;
    for (const std::string& text :
         {"x = " + repeated("[", kDeep), "x = " + repeated("{a=", kDeep),
          repeated("a.", kDeep) + "a = 1", "[" + repeated("a.", kDeep) + "a]",
          "[" + repeated("\"a\" . ", kDeep) + "a]"}) {
        CHECK_THROWS_WITH_AS(parse_toml(text, "t.toml"), "t.toml:1:1: nested deeper than 32 levels",
                             Error);
    }
}

TEST_CASE("toml: brackets and dots inside strings and comments are no nesting") {
    const std::string brackets(100, '[');
    const std::string dots(100, '.');
    const Value root = parse_toml("a = \"" + brackets + "\\\"" + dots + "\" # " + brackets +
                                      "\nb = '''" + dots + "\n'" + brackets + "'''\nc = '" + dots +
                                      "'\nd = \"\"\"\n" + brackets + "\"\"\"\n",
                                  "t.toml");
    CHECK(root.table()->size() == 4);
}
