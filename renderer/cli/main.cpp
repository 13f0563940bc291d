// tessera: the command line. Parses, runs one command, turns errors into messages and exit codes.

#include <unistd.h>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <system_error>

#include "renderer/api/error.h"
#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/core/parallel.h"

namespace {

void check_cpu() {
#ifdef TESSERA_MARCH
    __builtin_cpu_init();
    constexpr std::string_view kMarch = TESSERA_MARCH;
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if ((kMarch == "x86-64-v3" && !v3) || (kMarch == "x86-64-v4" && !v4)) {
        std::fputs("tessera: this build needs a CPU of level " TESSERA_MARCH
                   " (v3: AVX2, v4: AVX-512); configure with -DTESSERA_MARCH=x86-64-v3 or x86-64 "
                   "for this one\n",
                   stderr);
        std::exit(static_cast<int>(tessera::ExitCode::usage));
    }
#endif
}

int report(const tessera::Error& e) {
    tessera::print_err(std::string(e.what()) + "\n");
    return static_cast<int>(e.code());
}

// Reached when memory for a worker thread or inside a library runs out, where no exception can be
// handed on.
[[noreturn]] void on_terminate() {
    int code = static_cast<int>(tessera::ExitCode::bug);
    std::string what = "unknown";
    try {
        if (const std::exception_ptr current = std::current_exception())
            std::rethrow_exception(current);
    } catch (const std::bad_alloc&) {
        code = static_cast<int>(tessera::ExitCode::memory);
    } catch (const std::system_error& e) {
        const bool starved = e.code() == std::errc::resource_unavailable_try_again ||
                             e.code() == std::errc::not_enough_memory;
        if (starved) code = static_cast<int>(tessera::ExitCode::memory);
        what = e.what();
    } catch (const std::exception& e) {
        what = e.what();
    } catch (...) {
    }
    const bool memory = code == static_cast<int>(tessera::ExitCode::memory);
    tessera::print_err(memory ? "tessera: out of memory or threads\n"
                              : "tessera: internal error: " + what + "\n");
    _exit(code);
}

}  // namespace

int main(int argc, char** argv) {
    check_cpu();
    std::set_terminate(on_terminate);
    tessera::open_closed_streams();
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a size limit becomes a failed write, with its message
    tessera::flush_denormals();

    tessera::CommandParser parser(
        "Tessera: an offline path tracer. OBJ scenes in, layered EXR out.",
        std::string("tessera ") + TESSERA_VERSION,
        "Examples:\n"
        "  tessera render bunny.obj -o bunny.exr --preview bunny.png\n"
        "  tessera render scene.toml -o out.exr --spp 256 --set camera.fov_deg=35\n"
        "  tessera info scene.toml\n"
        "Exit codes: 0 done, 1 a bug of ours, 2 usage, 3 scene or asset, 4 output, 5 memory,\n"
        "  10 compare: more than a limit allows, 75 stopped with what there was written, "
        "129/130/143 stopped with nothing saved");
    const tessera::Command app = parser.root();
    tessera::CommandLine line;
    for (int i = 0; i < argc; ++i) line.text += (i ? " " : "") + std::string(argv[i]);
    tessera::add_render(app, line);
    tessera::add_merge(app, line);
    tessera::add_info(app, line);
    tessera::add_bench(app, line);
    tessera::add_exrcheck(app, line);
    tessera::add_flatten(app, line);
    tessera::add_compare(app, line);
    tessera::add_converge(app, line);
    tessera::add_version(app, line);
    tessera::add_schema(app, line);

    try {
        if (const std::optional<int> code = parser.parse(argc, argv)) return *code;
        return line.run ? line.run() : 0;
    } catch (const tessera::Error& e) {
        return report(e);
    } catch (const std::bad_alloc&) {
        return report({tessera::ExitCode::memory, "tessera: out of memory"});
    } catch (const std::exception& e) {
        return report(
            {tessera::ExitCode::bug, std::string("tessera: internal error: ") + e.what()});
    }
}
