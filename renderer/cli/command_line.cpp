#include "renderer/cli/command_line.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "renderer/api/error.h"
#include "renderer/core/nearest_name.h"

namespace tessera {
namespace {

Error unknown_command(const std::string& word) {
    const std::vector<std::string> known{"render",  "merge", "flatten",  "info",
                                         "compare", "bench", "exrcheck", "version"};
    return {ExitCode::usage,
            "tessera: unknown command '" + word + "'" + did_you_mean(word, known) +
                "; there are render, merge, flatten, compare, info, bench, exrcheck and version "
                "(tessera --help)"};
}

// An empty value is most often a script's empty variable: --checkpoint "$FILE" must not be no
// checkpoint. What is no number is within every range, and negative counts wrap around.
void refuse_what_is_no_value(CLI::App& app) {
    const auto is_there = [](const std::string& text) {
        return text.empty() ? "the value is empty" : std::string();
    };
    const auto is_number = [](const std::string& text) {
        return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is no number"
                                                              : std::string();
    };
    const auto is_count = [](const std::string& text) {
        std::uint64_t n = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, n);
        return code == std::errc() && stop == end ? std::string()
                                                  : text + " is not in 0 to 18446744073709551615";
    };
    for (CLI::App* command : app.get_subcommands({})) {
        for (CLI::Option* option : command->get_options()) {
            if (option->get_type_size() > 0) option->check(is_there);
            if (option->get_type_name().starts_with("FLOAT")) option->check(is_number);
            if (option->get_type_name().starts_with("UINT")) option->check(is_count);
        }
    }
}

}  // namespace

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::in(int least, int most) {
    option_->check(CLI::Range(least, most));
    return *this;
}

Option& Option::in(double least, double most) {
    option_->check(CLI::Range(least, most));
    return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
    option_->check(CLI::IsMember(words));
    return *this;
}

Option& Option::check(std::function<std::string(const std::string&)> test) {
    option_->check(std::move(test));
    return *this;
}

Option& Option::one_each() {
    option_->allow_extra_args(false);
    return *this;
}

Option& Option::needs(const Option& other) {
    option_->needs(other.option_);
    return *this;
}

Option& Option::excludes(const Option& other) {
    option_->excludes(other.option_);
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& help) {
    return Command(app_->add_subcommand(name, help));
}

Option Command::option(const std::string& names, std::string& value, const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, int& value, const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, double& value, const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, std::optional<int>& value,
                       const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, std::optional<double>& value,
                       const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, std::optional<std::uint64_t>& value,
                       const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::option(const std::string& names, std::vector<std::string>& value,
                       const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

Option Command::flag(const std::string& names, bool& value, const std::string& help) {
    return Option(app_->add_flag(names, value, help));
}

Option Command::flag(const std::string& names, int& value, const std::string& help) {
    return Option(app_->add_flag(names, value, help));
}

void Command::print_flag(const std::string& names, std::function<void()> print,
                         const std::string& help) {
    const auto print_and_end = [print = std::move(print)] {
        print();
        throw CLI::Success();
    };
    app_->add_flag_callback(names, print_and_end, help)->trigger_on_parse();
}

void Command::last_of_each() {
    for (CLI::Option* o : app_->get_options())
        o->multi_option_policy(o->get_expected_max() > 1 ? CLI::MultiOptionPolicy::TakeAll
                                                         : CLI::MultiOptionPolicy::TakeLast);
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::hide() { app_->group(""); }

void Command::when_chosen(std::function<void()> work) { app_->callback(std::move(work)); }

CommandParser::CommandParser(const std::string& about, const std::string& version,
                             const std::string& footer)
    : app_(std::make_unique<CLI::App>(about)) {
    app_->name("tessera");
    app_->require_subcommand(1);
    app_->set_version_flag("--version", version);
    app_->footer(footer);
}

CommandParser::~CommandParser() = default;

std::optional<int> CommandParser::parse(int argc, char** argv) {
    refuse_what_is_no_value(*app_);
    try {
        app_->parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (app_->get_subcommands().empty() && !app_->remaining().empty())
            throw unknown_command(app_->remaining().front());
        return app_->exit(e) == 0 ? 0 : static_cast<int>(ExitCode::usage);
    }
    return std::nullopt;
}

}  // namespace tessera
