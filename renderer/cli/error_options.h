#pragma once
// --error, --error-causes and --no-error-estimate.

#include <optional>
#include <string>

#include "renderer/api/picture_error.h"
#include "renderer/cli/command_line.h"

namespace tessera {

struct ErrorOptions {
    std::string text;  // of --error
    bool none = false, causes = false;

    void add_to(Command& command);
    std::optional<ErrorTarget> target() const;
};

/// "0.01", "relmse=0.01", "rmse=0.002"; nothing if it is none of these or not above 0.
std::optional<ErrorTarget> parse_error_target(const std::string& text);

}  // namespace tessera
