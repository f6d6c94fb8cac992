# Compile options of all targets. Optimization and hardening are chosen by the packager or the preset
# (CMAKE_BUILD_TYPE, CMAKE_CXX_FLAGS); nothing here changes these variables.

option(HYDROPRINT_TESTS "Build the tests" ON)
option(HYDROPRINT_BENCH "Build the benchmarks" ON)
option(HYDROPRINT_DAEMON "Build the daemon and the client (needs gRPC)" ON)
option(HYDROPRINT_FUZZ "Build the fuzzers instead of the tests (needs clang)" OFF)
option(HYDROPRINT_WERROR "Treat warnings of GCC 12 as errors; other compilers have other warnings" OFF)
option(HYDROPRINT_ASSERTS "Keep the assertions of the libraries' headers (leave NDEBUG undefined)" OFF)
option(HYDROPRINT_GROUP_FILES "Compile several files at once in targets declared GROUPED" OFF)
set(HYDROPRINT_SANITIZE "" CACHE STRING "Sanitizers for the project's own code: address;undefined, or thread")

add_library(hydroprint_options INTERFACE)
target_include_directories(hydroprint_options INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/generated)
target_compile_options(hydroprint_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  # Gives identical results on every machine.
  -ffp-contract=off
  # GCC 12 reports overlaps in std::string's operator+ that do not exist (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(HYDROPRINT_WERROR AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
  # GCC 12 reports overruns in std::string's operator+ that do not exist (its bug 105329).
  target_compile_options(hydroprint_options INTERFACE -Werror
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=array-bounds>)
endif()
if(HYDROPRINT_ASSERTS)
  target_compile_options(hydroprint_options INTERFACE -UNDEBUG)
else()
  target_compile_options(hydroprint_options INTERFACE -DNDEBUG)
endif()

if(HYDROPRINT_SANITIZE)
  list(JOIN HYDROPRINT_SANITIZE "," sanitizers)
  target_compile_options(hydroprint_options INTERFACE
    -fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if("undefined" IN_LIST HYDROPRINT_SANITIZE)
    # AddressSanitizer finds the same errors as these checks, which take a third of the compile time.
    target_compile_options(hydroprint_options INTERFACE -fno-sanitize=null,object-size,vptr)
  endif()
  target_link_options(hydroprint_options INTERFACE -fsanitize=${sanitizers})
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # ccache needs these settings to recognize precompiled headers by their contents.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
