#pragma once
// What can be told from headers alone.

#include "renderer/image/check/exr_raw.h"
#include "renderer/image/check/exr_rules.h"

namespace tessera {

std::string where_channel(const RawChannel& channel);

void check_windows(const RawExr& file, ExrFindings& out);
void check_storage(const RawExr& file, ExrFindings& out);  // types, codecs, colour
void check_names(const RawExr& file, ExrFindings& out);

}  // namespace tessera
