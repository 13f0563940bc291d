#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "renderer/cli/commands.h"
#include "renderer/core/parallel.h"
#include "renderer/geometry/accel.h"

namespace tessera {

void add_version(CLI::App& app, CommandLine& line) {
    CLI::App* sub = app.add_subcommand("version", "Print versions of the program and of what it is built on");
    auto json = std::make_shared<bool>(false);
    sub->add_flag("--json", *json, "As JSON");
    sub->callback([json, &line] {
        line.run = [json] {
            const ThreadLimit limit = available_threads();
            if (*json) {
                const nlohmann::ordered_json j = {{"version", TESSERA_VERSION}, {"embree", Accel::version()},
#ifdef TESSERA_MARCH
                                                  {"march", TESSERA_MARCH},
#endif
                                                  {"threads", limit.threads}, {"threads_because", limit.because}};
                std::printf("%s\n", j.dump(2).c_str());
            } else {
                std::printf("tessera %s\nEmbree %s\nthreads %d (%s)\n", TESSERA_VERSION, Accel::version().c_str(), limit.threads, limit.because.c_str());
            }
            return 0;
        };
    });
}

}  // namespace tessera
