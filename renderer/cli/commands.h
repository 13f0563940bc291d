#pragma once
// One function per subcommand. Each adds itself to the parser and leaves its work in `run`.

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tessera {

/// What main() needs after parsing: the chosen command's work, returning the exit code.
struct CommandLine {
    std::function<int()> run;
    std::string text;  // the whole command line, for the file's header
};

void add_render(CLI::App& app, CommandLine& line);
void add_merge(CLI::App& app, CommandLine& line);
void add_info(CLI::App& app, CommandLine& line);
void add_bench(CLI::App& app, CommandLine& line);
void add_version(CLI::App& app, CommandLine& line);
void add_exrcheck(CLI::App& app, CommandLine& line);
void add_flatten(CLI::App& app, CommandLine& line);
void add_schema(CLI::App& app, CommandLine& line);

}  // namespace tessera
