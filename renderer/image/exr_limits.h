#pragma once

namespace tessera {

/// Makes OpenEXR refuse windows over 2^20 pixels a side, in the whole process: its tables are sized
/// by the header alone, so a few damaged bytes would take gigabytes. Called before any EXR is
/// opened.
void limit_exr_windows();

}  // namespace tessera
