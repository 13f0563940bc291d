#pragma once
// The entries cryptomatte/KEY/... of a file's header.

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "renderer/image/check/exr_raw.h"
#include "renderer/image/check/exr_rules.h"

namespace tessera {

struct MatteHeader {
    std::string key, name;
    bool named = false;           // the manifest is in the file and is good
    std::set<std::uint32_t> ids;  // its ids
};

/// Finds and checks them all.
std::vector<MatteHeader> read_matte_headers(const RawExr& file, ExrFindings& out);

}  // namespace tessera
