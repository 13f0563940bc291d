#include "renderer/error/cause_text.h"

#include <fmt/format.h>

namespace tessera {

std::string to_text(const ErrorCause& c) {
    const auto quoted = [](const char* before, const std::string& name) {
        return name.empty() ? std::string() : fmt::format(" {} '{}'", before, name);
    };
    return fmt::format("{:.0f} % of the error: {}{}{}{}", 100 * c.share, c.paths,
                       quoted("of light", c.light), quoted("by way of", c.through),
                       quoted("on", c.seen));
}

}  // namespace tessera
