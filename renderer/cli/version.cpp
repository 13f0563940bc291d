#include <memory>
#include <nlohmann/json.hpp>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/core/parallel.h"
#include "renderer/geometry/accel.h"

namespace tessera {

void add_version(Command app, CommandLine& line) {
    Command sub =
        app.add_command("version", "Print versions of the program and of what it is built on");
    auto json = std::make_shared<bool>(false);
    sub.flag("--json", *json, "As JSON");
    sub.when_chosen([json, &line] {
        line.run = [json] {
            const ThreadLimit limit = available_threads();
            if (*json) {
                const nlohmann::ordered_json j = {{"version", TESSERA_VERSION},
                                                  {"embree", Accel::version()},
#ifdef TESSERA_MARCH
                                                  {"march", TESSERA_MARCH},
#endif
                                                  {"threads", limit.threads},
                                                  {"threads_because", limit.because}};
                print_out(j.dump(2) + "\n");
            } else {
                print_out(std::string("tessera ") + TESSERA_VERSION + "\nEmbree " +
                          Accel::version() + "\nthreads " + std::to_string(limit.threads) + " (" +
                          limit.because + ")\n");
            }
            return 0;
        };
    });
}

}  // namespace tessera
