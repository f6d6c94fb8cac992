# Functions that declare targets. All properties of a target are in its declaration:
#
#   hydroprint_library(NAME SOURCES file... [PUBLIC lib...] [PRIVATE lib...] [DEFINES X=Y...]
#                      [PRECOMPILED set] [OPTIMIZED] [GROUPED [ALONE file...]] [POSITION_INDEPENDENT])
#   hydroprint_program(NAME ...)   takes the same arguments
#
# PRECOMPILED: the set of precompiled headers (precompiled_headers.cmake); default: none.
# OPTIMIZED: -O3, for code that computes for seconds; other code uses the optimization of the build type.
# GROUPED: files of the target may be compiled in groups of eight (HYDROPRINT_GROUP_FILES).
# ALONE: files excluded from the groups because their private names collide with those of other files.
# POSITION_INDEPENDENT: for libraries linked into modules; these use no precompiled headers.

# Flags for OPTIMIZED. Not used in sanitizer builds, where speed does not matter, or in Debug builds.
set(HYDROPRINT_OPTIMIZED $<$<NOT:$<CONFIG:Debug>>:-O3>)
if(HYDROPRINT_SANITIZE)
  set(HYDROPRINT_OPTIMIZED "")
endif()

set(HYDROPRINT_TARGET_FLAGS OPTIMIZED GROUPED POSITION_INDEPENDENT)
set(HYDROPRINT_TARGET_VALUES PRECOMPILED)
set(HYDROPRINT_TARGET_LISTS SOURCES PUBLIC PRIVATE DEFINES ALONE)

function(hydroprint_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "${HYDROPRINT_TARGET_FLAGS}" "${HYDROPRINT_TARGET_VALUES}"
    "${HYDROPRINT_TARGET_LISTS}")
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC hydroprint_options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  hydroprint_target_properties(${name} "")
endfunction()

function(hydroprint_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "${HYDROPRINT_TARGET_FLAGS}" "${HYDROPRINT_TARGET_VALUES}"
    "${HYDROPRINT_TARGET_LISTS}")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE hydroprint_options ${arg_PUBLIC} ${arg_PRIVATE})
  hydroprint_target_properties(${name} "")
endfunction()

# Applies the parsed arguments (arg_...) of the calling function to a target. `variant` names the variant of the
# precompiled headers: empty, or _test.
macro(hydroprint_target_properties name variant)
  target_compile_definitions(${name} PRIVATE ${arg_DEFINES})
  set(precompiled "precompiled_${arg_PRECOMPILED}")
  if(arg_OPTIMIZED)
    target_compile_options(${name} PRIVATE ${HYDROPRINT_OPTIMIZED})
    string(APPEND precompiled "_optimized")
  endif()
  if(arg_POSITION_INDEPENDENT)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  if(arg_PRECOMPILED AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM ${precompiled}${variant})
    # GCC refuses a precompiled header that was compiled with definitions that the target does not have.
    target_link_libraries(${name} PRIVATE fmt::fmt)
  endif()
  if(arg_GROUPED AND HYDROPRINT_GROUP_FILES)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON)
    set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    # In grouped files, a class may legitimately have members of types from its file's anonymous namespace.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endmacro()
