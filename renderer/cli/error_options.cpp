#include "renderer/cli/error_options.h"

#include <cmath>
#include <cstdlib>

namespace tessera {

void ErrorOptions::add_to(Command& command) {
    const Option target =
        command
            .option("--error", text,
                    "Render until the error is reliably below this: 0.01 or relmse=0.01, "
                    "rmse=0.002; then --spp is the "
                    "most samples, without it 2^20")
            .check([](const std::string& t) {
                return parse_error_target(t)
                           ? std::string()
                           : t + " is no error above 0, as 0.01, relmse=0.01 or rmse=0.002";
            });
    const Option by_cause =
        command.flag("--error-causes", causes,
                     "Say which paths, lights and materials make the error; without it only of "
                     "an estimate that is not reliable");
    command
        .flag("--no-error-estimate", none,
              "Do not say how wrong the picture is: 146 bytes a pixel less; the same picture")
        .excludes(target)
        .excludes(by_cause);
}

std::optional<ErrorTarget> ErrorOptions::target() const {
    return text.empty() ? std::nullopt : parse_error_target(text);
}

std::optional<ErrorTarget> parse_error_target(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string metric = equals == std::string::npos ? "relmse" : text.substr(0, equals);
    const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !(value > 0) || !std::isfinite(value)) return std::nullopt;
    if (metric != "relmse" && metric != "rmse") return std::nullopt;
    return ErrorTarget{metric == "relmse", value};
}

}  // namespace tessera
