# What keeps a clean build short; nothing here may change what the renderer computes (docs/decisions/012-build-time.md).

# The standard headers that nearly every file reads are parsed once. Not by clang, whose build thereby finds the file that
# does not include what it uses.
string(COMPARE EQUAL "${CMAKE_CXX_COMPILER_ID}" "GNU" gnu)
option(TESSERA_PCH "Precompile the standard headers" ${gnu})
if(TESSERA_PCH)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
  add_library(tessera_precompiled OBJECT ${CMAKE_BINARY_DIR}/generated/precompiled.cpp)
  target_link_libraries(tessera_precompiled PRIVATE tessera_flags fmt::fmt)
  target_precompile_headers(tessera_precompiled PRIVATE
    <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map>
    <memory> <optional> <set> <span> <sstream> <string> <string_view> <system_error> <tuple> <utility> <variant> <vector>
    <fmt/format.h>)
endif()

function(tessera_precompile)  # ARGN: targets
  if(TESSERA_PCH)
    foreach(target IN LISTS ARGN)
      target_precompile_headers(${target} REUSE_FROM tessera_precompiled)
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache
    endforeach()
  endif()
endfunction()

# Code that runs once per render or reads a few lines of text: optimising it is most of its compile time.
function(tessera_cold)  # ARGN: sources
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -O1)
  endif()
endfunction()
