#include "renderer/cli/machine.h"

#include <sys/utsname.h>

#include <array>
#include <ctime>
#include <fstream>

namespace tessera {
namespace {

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return "unknown CPU";
}

}  // namespace

Machine this_machine() {
    Machine m;
    utsname names{};
    if (::uname(&names) == 0) {
        m.host = names.nodename;
        m.system = std::string(names.sysname) + " " + names.release + " " + names.machine;
    }
    m.cpu = cpu_name();
    return m;
}

std::string date_and_time() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    std::array<char, 32> text{};
    if (!::gmtime_r(&now, &utc)) return {};
    std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &utc);
    return text.data();
}

}  // namespace tessera
