#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/converge/report.h"
#include "renderer/converge/text.h"
#include "tests/support/converge_records.h"

using namespace tessera;
using nlohmann::json;

namespace {

const std::string kHostile = "</script><b>\"x\", 'y' & z";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

int count(const std::string& text, const std::string& word) {
    int n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++n;
    return n;
}

}  // namespace

TEST_CASE("report text: base64 is that of RFC 4648, section 10") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("fooba") == "Zm9vYmE=");
    CHECK(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("report text: what is escaped cannot be markup, nor break a line of CSV") {
    CHECK(escaped("<a b=\"c\">&'") == "&lt;a b=&quot;c&quot;&gt;&amp;&#39;");
    CHECK(escaped("a\x01\x7f\n") == "a?\x7f\n");
    CHECK(escaped("caf\xe9") == "café");  // no UTF-8: Latin-1
    CHECK(inside_script("{\"a\": \"</script>\"}") == "{\"a\": \"\\u003c/script>\"}");
    CHECK(csv_field("plain") == "plain");
    CHECK(csv_field("a,b") == "\"a,b\"");
    CHECK(csv_field("say \"x\"\n") == "\"say \"\"x\"\"\n\"");
}

TEST_CASE("report text: numbers have three figures and times a unit") {
    CHECK(three_figures(0) == "0");
    CHECK(three_figures(0.0012345) == "0.00123");
    CHECK(three_figures(12.345) == "12.3");
    CHECK(three_figures(1234.5) == "1234");
    CHECK(three_figures(1.2345e-7) == "1.23e-07");
    CHECK(three_figures(std::nan("")) == "-");
    CHECK(duration(4440) == "74 min");
    CHECK(duration(0.0123) == "12.3 ms");
    CHECK(duration(59.96) == "60 s");
    CHECK(with_prefix(12345678) == "12.3 M");
}

TEST_CASE("report: JSON has every number that went in, null for what is unknown") {
    ConvergeReport report = report_of("box");
    report.scenes[0].runs[0].curve[0].cpu_s.reset();
    report.scenes[0].runs[0].curve[0].relmse->high = std::numeric_limits<double>::infinity();
    report.scenes[0].runs[1].curve[0].truth->flip = std::nan("");
    const json j = json::parse(report_json(report));
    CHECK(j["format"] == 1);
    CHECK(j["limits"]["time"].is_null());
    const json& scene = j["scenes"][0];
    CHECK(scene["resolution"] == json{32, 16});
    CHECK(scene["runs"][0]["curve"].size() == 5);
    const json& first = scene["runs"][0]["curve"][0];
    CHECK(first["spp"] == 4);
    CHECK(first["cpu"].is_null());
    CHECK(first["estimate"]["relmse"]["value"] == 2.0);
    CHECK(first["estimate"]["relmse"]["high"].is_null());
    CHECK(first["error"]["relmse"] == 2.1);
    CHECK(scene["runs"][1]["curve"][0]["error"]["flip"].is_null());
    CHECK(scene["series"][1]["slope"]["wall"]["value"].get<double>() == doctest::Approx(-1));
    CHECK(scene["series"][1]["error"]["relmse"]["low"].is_null());
    CHECK(scene["history"][0]["wall"] == 4440);
    CHECK(scene["reference"]["relmse"].is_null());
}

TEST_CASE("report: CSV has a line a point, each with as many fields as the head") {
    ConvergeReport report = report_of("plain");
    report.scenes[0].runs[0].curve[0] = ConvergePoint{};
    const std::vector<std::string> lines = lines_of(report_csv(report));
    REQUIRE(lines.size() == 1 + 2 * 5);
    for (const std::string& line : lines) {
        CAPTURE(line);
        CHECK(count(line, ",") == count(lines[0], ","));
    }
    CHECK(lines[2] ==
          "plain,a=1,,0,8,0.08,0.16,8000,67108864,0.25,0.2,0.3125,1,0.8,1.25,true,0.2625,1.05,0."
          "0625");
    report = report_of(kHostile);
    CHECK(lines_of(report_csv(report))[1].starts_with("\"</script><b>\"\"x\"\", 'y' & z\",a=1,"));
}

TEST_CASE("report: a hostile name stays a name in the page, and in the JSON within it") {
    const ConvergeReport report = report_of(kHostile);
    const std::string html = report_html(report);
    CHECK(html.find("<b>") == std::string::npos);
    CHECK(count(html, "</script>") == 2);  // the JSON's and the script's
    CHECK(html.find("&lt;/script&gt;&lt;b&gt;") != std::string::npos);
    const std::string begin = "<script type=\"application/json\" id=\"report\">";
    const std::size_t at = html.find(begin) + begin.size();
    const json j = json::parse(html.substr(at, html.find("</script>", at) - at));
    CHECK(j == json::parse(report_json(report)));
    CHECK(j["scenes"][0]["name"] == kHostile);
}

TEST_CASE("report: the page needs no other file and no network") {
    const std::string html = report_html(report_of("box"));
    // The name of SVG's elements is no address that anything is loaded from.
    CHECK(count(html, "http") ==
          count(html, "http-equiv") + count(html, "http://www.w3.org/2000/svg"));
    CHECK(count(html, "src=\"") == count(html, "src=\"data:"));
    CHECK(html.find("<link rel=\"icon\" href=\"data:,\">") != std::string::npos);
    CHECK(count(html, "url(") == 0);
    CHECK(count(html, "@import") == 0);
}

TEST_CASE("report: the table's cells carry the numbers of the JSON") {
    const ConvergeReport report = report_of("box");
    const std::string html = report_html(report);
    const json series = json::parse(report_json(report))["scenes"][0]["series"];
    for (const json& s : series) {
        const std::size_t row = html.find("<tr data-series=\"" + s["label"].get<std::string>());
        REQUIRE(row != std::string::npos);
        const std::string key = "data-key=\"relmse\" data-value=\"";
        const std::size_t at = html.find(key, row) + key.size();
        CHECK(std::stod(html.substr(at)) == s["error"]["relmse"]["value"].get<double>());
    }
    CHECK(html.find("74 min") != std::string::npos);
    // The columns stand below their heads.
    const std::size_t row = html.find("<tr data-series=");
    const std::string cells = html.substr(row, html.find("</tr>", row) - row);
    std::size_t head = 0, cell = 0;
    for (const ErrorKind kind : kErrorKinds) {
        head = html.find(std::string("<th>") + title_of(kind), head);
        cell = cells.find(std::string("data-key=\"") + key_of(kind), cell);
        REQUIRE(head != std::string::npos);
        REQUIRE(cell != std::string::npos);
    }
}

TEST_CASE("report: without a reference there are no columns of true errors") {
    ConvergeReport report = report_of("box");
    report.scenes[0].reference.reset();
    for (ConvergeRun& run : report.scenes[0].runs)
        for (ConvergePoint& p : run.curve) p.truth.reset();
    const std::string html = report_html(report);
    CHECK(html.find("<th>FLIP</th>") == std::string::npos);
    CHECK(html.find("data-kind=\"flip\"") == std::string::npos);
    CHECK(html.find("data-key=\"estimate\"") != std::string::npos);
}

TEST_CASE("report: a scene without a single run, and none at all, are pages too") {
    ConvergeReport report = report_of("box");
    report.scenes[0].runs.clear();
    report.failures = {"box <failed>"};
    CHECK(report_html(report).find("box &lt;failed&gt;") != std::string::npos);
    CHECK(json::parse(report_json(report))["scenes"][0]["series"].empty());
    report.scenes.clear();
    CHECK(report_html(report).find("</html>") != std::string::npos);
    CHECK(lines_of(report_csv(report)).size() == 1);
}
