# Flags every target of ours carries. No -ffast-math; contraction off, so that every kernel gives the same bits.

add_library(tessera_flags INTERFACE)
target_compile_options(tessera_flags INTERFACE
  -ffp-contract=off -fno-math-errno -fno-trapping-math
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Wunused -Woverloaded-virtual -Wdouble-promotion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(tessera_flags INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)  # false alarms on std::string + (GCC bug 105651)
endif()
target_compile_definitions(tessera_flags INTERFACE TESSERA_VERSION="${PROJECT_VERSION}")
if(TESSERA_WERROR)
  target_compile_options(tessera_flags INTERFACE -Werror)
endif()
if(TESSERA_MARCH)
  target_compile_options(tessera_flags INTERFACE -march=${TESSERA_MARCH})
  if(TESSERA_MARCH STREQUAL "x86-64-v4")
    target_compile_options(tessera_flags INTERFACE -mprefer-vector-width=512)  # a block's 16 lanes at once
  endif()
  target_compile_definitions(tessera_flags INTERFACE TESSERA_MARCH="${TESSERA_MARCH}")
endif()
if(TESSERA_SANITIZE)
  target_compile_options(tessera_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # false alarms: the tools tell for real
  target_compile_options(tessera_flags INTERFACE -fsanitize=${TESSERA_SANITIZE} -fno-omit-frame-pointer -g1)
  target_link_options(tessera_flags INTERFACE -fsanitize=${TESSERA_SANITIZE})
  if(TESSERA_SANITIZE MATCHES "undefined")
    target_compile_options(tessera_flags INTERFACE -fno-sanitize-recover=undefined)
  endif()
endif()
