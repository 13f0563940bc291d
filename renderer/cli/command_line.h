#pragma once
// The words of the command line: commands and their options, parsed by CLI11, which takes seconds
// to compile and therefore stays in command_line.cpp.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class Option;
}  // namespace CLI

namespace tessera {

/// An option that was added; its functions narrow what it takes.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    Option& required();
    Option& in(int least, int most);
    Option& in(double least, double most);
    Option& one_of(const std::vector<std::string>& words);
    /// test: what is wrong with a text, empty if nothing is.
    Option& check(std::function<std::string(const std::string&)> test);
    /// Of a list: each time it is given it takes one value, not all that follow.
    Option& one_each();
    Option& needs(const Option& other);
    Option& excludes(const Option& other);

private:
    CLI::Option* option_;
};

/// One command, or the program itself. The values must outlive the parsing.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    Command add_command(const std::string& name, const std::string& help);
    Option option(const std::string& names, std::string& value, const std::string& help);
    Option option(const std::string& names, int& value, const std::string& help);
    Option option(const std::string& names, double& value, const std::string& help);
    Option option(const std::string& names, std::optional<int>& value, const std::string& help);
    Option option(const std::string& names, std::optional<double>& value, const std::string& help);
    Option option(const std::string& names, std::optional<std::uint64_t>& value,
                  const std::string& help);
    Option option(const std::string& names, std::vector<std::string>& value,
                  const std::string& help);
    Option flag(const std::string& names, bool& value, const std::string& help);
    /// Counts how often it is given.
    Option flag(const std::string& names, int& value, const std::string& help);
    /// Prints a text and ends the program as --help does.
    void print_flag(const std::string& names, std::function<void()> print, const std::string& help);
    /// Of an option given twice the last counts; lists take all.
    void last_of_each();
    void footer(const std::string& text);
    /// Leaves the command out of the help.
    void hide();
    void when_chosen(std::function<void()> work);

private:
    CLI::App* app_;
};

class CommandParser {  // of the whole line
public:
    /// version: the answer to --version; footer ends the help.
    CommandParser(const std::string& about, const std::string& version, const std::string& footer);
    ~CommandParser();
    CommandParser(const CommandParser&) = delete;
    CommandParser& operator=(const CommandParser&) = delete;

    Command root() { return Command(app_.get()); }
    /// The exit code if there is nothing more to do: help was asked for, or the words are wrong
    /// (empty values always are), which is said. Throws Error(usage) for an unknown command.
    std::optional<int> parse(int argc, char** argv);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace tessera
