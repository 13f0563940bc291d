#include "renderer/cli/output_check.h"

#include <unistd.h>

#include <filesystem>

#include "renderer/api/error.h"

namespace tessera {

void check_output(const std::string& path, const char* option) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    const auto fail = [&](const std::string& why) {
        throw Error(ExitCode::output, path + ": cannot write (" + option + "): " + why);
    };
    if (!fs::is_directory(folder, error)) fail("the folder '" + folder.string() + "' does not exist");
    if (fs::is_directory(path, error)) fail("it is a folder");
    if (access(folder.c_str(), W_OK | X_OK) != 0) fail("the folder '" + folder.string() + "' is not writable");
}

}  // namespace tessera
