#pragma once

namespace tessera {

/// Of all threads of this process, since it began.
double process_cpu_seconds() noexcept;

}  // namespace tessera
