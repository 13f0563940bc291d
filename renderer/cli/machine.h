#pragma once
// Where and when something was measured.

#include <string>

namespace tessera {

struct Machine {
    std::string host, cpu, system;  // "Linux 6.1.0 x86_64"
};

Machine this_machine();

/// "2026-11-23 06:12 UTC"
std::string date_and_time();

}  // namespace tessera
