# The material presets become part of the program: a table of names and texts.
file(GLOB preset_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/materials/presets/*.toml)
list(SORT preset_files)
set(preset_entries "")
foreach(file IN LISTS preset_files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND preset_entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${preset_files})
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/presets.cpp CONTENT [[
#include "renderer/io/presets.h"

namespace tessera {

std::span<const Preset> presets() {
    static constexpr Preset kPresets[] = {
@preset_entries@    };
    return kPresets;
}

}  // namespace tessera
]] @ONLY)
