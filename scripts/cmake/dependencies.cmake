# Where each library comes from. A good CMake config is preferred; Debian 12's configs of OpenImageIO and
# OpenColorIO are broken (they name files that are not shipped), so pkg-config is the fallback there.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

# Embree 4 if it is there, else 3; renderer/geometry/embree.h hides the difference.
add_library(tessera_embree INTERFACE)
find_package(embree 4 QUIET)
if(embree_FOUND)
  target_compile_definitions(tessera_embree INTERFACE TESSERA_EMBREE=4)
else()
  find_package(embree 3 REQUIRED)
  target_compile_definitions(tessera_embree INTERFACE TESSERA_EMBREE=3)
endif()
target_link_libraries(tessera_embree INTERFACE embree)
message(STATUS "Embree ${embree_VERSION}")

# A pkg-config module as an interface library.
function(tessera_pkg target module)
  pkg_check_modules(${target}_pc REQUIRED IMPORTED_TARGET ${module})
  target_link_libraries(${target} INTERFACE PkgConfig::${target}_pc)
endfunction()

# Debian 12's OpenImageIOConfig.cmake fails hard instead of saying "not found", so pkg-config comes first.
add_library(tessera_oiio INTERFACE)
pkg_check_modules(oiio_probe QUIET OpenImageIO)
if(oiio_probe_FOUND)
  tessera_pkg(tessera_oiio OpenImageIO)
else()
  find_package(OpenImageIO REQUIRED)
  target_link_libraries(tessera_oiio INTERFACE OpenImageIO::OpenImageIO)
endif()

add_library(tessera_ocio INTERFACE)
pkg_check_modules(ocio_probe QUIET OpenColorIO)
if(ocio_probe_FOUND)
  tessera_pkg(tessera_ocio OpenColorIO)
else()
  find_package(OpenColorIO REQUIRED)
  target_link_libraries(tessera_ocio INTERFACE OpenColorIO::OpenColorIO)
endif()

# The double-precision build: positions at 5 000 000 m keep their millimetres.
add_library(tinyobjloader_double INTERFACE)
tessera_pkg(tinyobjloader_double tinyobjloader_double)
target_compile_definitions(tinyobjloader_double INTERFACE TINYOBJLOADER_USE_DOUBLE)

# Header only, no CMake config needed.
find_path(TOMLPP_INCLUDE toml++/toml.h REQUIRED)
find_path(DOCTEST_INCLUDE doctest/doctest.h)

add_library(tessera_xxhash INTERFACE)
tessera_pkg(tessera_xxhash libxxhash)

add_library(tessera_pugixml INTERFACE)
tessera_pkg(tessera_pugixml pugixml)

# Plots as PNG; OpenImageIO's libraries load it anyway. Its -pthread would spoil the precompiled header.
add_library(tessera_rsvg INTERFACE)
pkg_check_modules(tessera_rsvg_pc REQUIRED librsvg-2.0)
target_include_directories(tessera_rsvg SYSTEM INTERFACE ${tessera_rsvg_pc_INCLUDE_DIRS})
target_link_libraries(tessera_rsvg INTERFACE ${tessera_rsvg_pc_LINK_LIBRARIES})
