#include "renderer/io/schema.h"

#include <memory>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/film/pass_docs.h"
#include "renderer/io/node_docs.h"

namespace tessera {

void add_schema(Command app, CommandLine& line) {
    Command sub =
        app.add_command("schema", "Print the JSON Schema of scene files (docs/scene.schema.json)");
    sub.hide();  // for those who change the format: not in the help
    const auto nodes = std::make_shared<bool>(false);
    sub.flag("--nodes", *nodes, "The list of nodes in its place (docs/nodes.md)");
    const auto passes = std::make_shared<bool>(false);
    sub.flag("--passes", *passes, "The tables of passes (docs/passes.md)");
    sub.when_chosen([&line, nodes, passes] {
        line.run = [nodes, passes] {
            print_out(*passes  ? passes_markdown()
                      : *nodes ? nodes_markdown()
                               : scene_schema_json());
            return 0;
        };
    });
}

}  // namespace tessera
