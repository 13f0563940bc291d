#pragma once
// One function per subcommand. Each adds itself to the parser and leaves its work in `run`.

#include <functional>
#include <string>

#include "renderer/cli/command_line.h"

namespace tessera {

/// What main() needs after parsing: the chosen command's work, returning the exit code.
struct CommandLine {
    std::function<int()> run;
    std::string text;  // the whole command line, for the file's header
};

void add_render(Command app, CommandLine& line);
void add_merge(Command app, CommandLine& line);
void add_info(Command app, CommandLine& line);
void add_bench(Command app, CommandLine& line);
void add_version(Command app, CommandLine& line);
void add_exrcheck(Command app, CommandLine& line);
void add_flatten(Command app, CommandLine& line);
void add_compare(Command app, CommandLine& line);
void add_converge(Command app, CommandLine& line);
void add_schema(Command app, CommandLine& line);

}  // namespace tessera
