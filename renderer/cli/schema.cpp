#include "renderer/io/schema.h"

#include <CLI/CLI.hpp>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"

namespace tessera {

void add_schema(CLI::App& app, CommandLine& line) {
    CLI::App* sub = app.add_subcommand(
        "schema", "Print the JSON Schema of scene files (docs/scene.schema.json)");
    sub->group("");  // for those who change the format: not in the help
    sub->callback([&line] {
        line.run = [] {
            print_out(scene_schema_json());
            return 0;
        };
    });
}

}  // namespace tessera
