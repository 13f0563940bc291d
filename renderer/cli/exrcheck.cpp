#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/image/check/check_exr.h"

namespace tessera {
namespace {

using nlohmann::ordered_json;

struct CheckOptions {
    std::vector<std::string> files;
    bool json = false, strict = false, rules = false;
};

struct CheckedFile {
    std::string path;
    ExrFindings findings;

    int count(Severity severity) const {
        int n = 0;
        for (const ExrFinding& f : findings) n += text_of(f.rule).severity == severity;
        return n;
    }
};

// What a file says of itself may be no UTF-8.
std::string dump(const ordered_json& j) {
    return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string as_json(const std::vector<CheckedFile>& files) {
    ordered_json out = ordered_json::array();
    for (const CheckedFile& file : files) {
        ordered_json findings = ordered_json::array();
        for (const ExrFinding& f : file.findings) {
            const ExrRuleText& rule = text_of(f.rule);
            findings.push_back({{"rule", rule.id},
                                {"severity", to_string(rule.severity)},
                                {"where", f.where},
                                {"what", f.what},
                                {"text", rule.text},
                                {"remedy", rule.remedy}});
        }
        out.push_back({{"file", file.path},
                       {"errors", file.count(Severity::error)},
                       {"warnings", file.count(Severity::warning)},
                       {"notes", file.count(Severity::note)},
                       {"findings", findings}});
    }
    return dump(ordered_json{{"format", 1}, {"files", out}});
}

std::string as_text(const CheckedFile& file) {
    if (file.findings.empty()) return file.path + ": clean\n";
    std::string out;
    for (std::size_t i = 0; i < file.findings.size(); ++i) {
        const ExrFinding& f = file.findings[i];
        const ExrRuleText& rule = text_of(f.rule);
        out += file.path + ": " + to_string(rule.severity) + ": " + printable(f.where) + ": " +
               printable(f.what) + " [" + rule.id + "]\n";
        const bool last_of_rule =
            i + 1 == file.findings.size() || file.findings[i + 1].rule != f.rule;
        if (last_of_rule) out += std::string("    ") + rule.text + "\n    " + rule.remedy + "\n";
    }
    return out;
}

int run_check(const CheckOptions& options) {
    if (options.rules) {
        print_out(exr_rules_markdown());
        return 0;
    }
    if (options.files.empty())
        throw Error(ExitCode::usage, "exrcheck: no file is given (tessera exrcheck FILE...)");
    bool failed = false;
    std::vector<CheckedFile> files;
    for (const std::string& path : options.files) {
        files.push_back({path, check_exr(path)});
        const CheckedFile& file = files.back();
        failed = failed || file.count(Severity::error) > 0 ||
                 (options.strict && file.count(Severity::warning) > 0);
        if (!options.json) print_out(as_text(file));
    }
    if (options.json) print_out(as_json(files));
    return static_cast<int>(failed ? ExitCode::scene : ExitCode::done);
}

}  // namespace

void add_exrcheck(Command app, CommandLine& line) {
    Command sub = app.add_command(
        "exrcheck", "Check EXR files of any renderer for what compositors stumble over");
    auto o = std::make_shared<CheckOptions>();
    sub.option("files", o->files, "The files");
    sub.flag("--json", o->json, "As JSON");
    sub.flag("--strict", o->strict, "Warnings count as errors");
    sub.flag("--rules", o->rules, "The rules, as a table (docs/exrcheck.md)");
    sub.footer("Exit codes: 0 no errors, 3 a file has errors (or, with --strict, warnings)");
    sub.when_chosen([o, &line] { line.run = [o] { return run_check(*o); }; });
}

}  // namespace tessera
