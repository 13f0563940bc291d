// tessera: the command line. Parses, runs one command, turns errors into messages and exit codes.

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
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
#include "renderer/core/nearest_name.h"
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

tessera::Error unknown_command(const std::string& word) {
    const std::vector<std::string> known{"render", "merge",    "flatten", "info",
                                         "bench",  "exrcheck", "version"};
    return {tessera::ExitCode::usage,
            "tessera: unknown command '" + word + "'" + tessera::did_you_mean(word, known) +
                "; there are render, merge, flatten, info, bench, exrcheck and version (tessera "
                "--help)"};
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

int main(int argc, char** argv) {
    check_cpu();
    std::set_terminate(on_terminate);
    tessera::open_closed_streams();
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a size limit becomes a failed write, with its message
    tessera::flush_denormals();

    CLI::App app{"Tessera: an offline path tracer. OBJ scenes in, layered EXR out."};
    app.name("tessera");
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("tessera ") + TESSERA_VERSION);
    app.footer(
        "Examples:\n"
        "  tessera render bunny.obj -o bunny.exr --preview bunny.png\n"
        "  tessera render scene.toml -o out.exr --spp 256 --set camera.fov_deg=35\n"
        "  tessera info scene.toml\n"
        "Exit codes: 0 done, 1 a bug of ours, 2 usage, 3 scene or asset, 4 output, 5 memory,\n"
        "  75 stopped with what there was written, 129/130/143 stopped with nothing saved");
    tessera::CommandLine line;
    for (int i = 0; i < argc; ++i) line.text += (i ? " " : "") + std::string(argv[i]);
    tessera::add_render(app, line);
    tessera::add_merge(app, line);
    tessera::add_info(app, line);
    tessera::add_bench(app, line);
    tessera::add_exrcheck(app, line);
    tessera::add_flatten(app, line);
    tessera::add_version(app, line);
    tessera::add_schema(app, line);
    refuse_what_is_no_value(app);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (app.get_subcommands().empty() && !app.remaining().empty())
            return report(unknown_command(app.remaining().front()));
        const int code = app.exit(e);
        return code == 0 ? 0 : static_cast<int>(tessera::ExitCode::usage);
    } catch (const tessera::Error& e) {
        return report(e);
    }
    try {
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
