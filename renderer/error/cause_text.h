#pragma once

#include <string>

#include "renderer/api/picture_error.h"

namespace tessera {

/// "61 % of the error: caustic of light 'bulb' by way of 'lens' on 'floor'"
std::string to_text(const ErrorCause& cause);

}  // namespace tessera
