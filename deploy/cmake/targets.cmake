# Functions that declare targets. All properties of a target are in its declaration:
#
#   hydroprint_library(NAME SOURCES file... [PUBLIC lib...] [PRIVATE lib...] [DEFINES X=Y...]
#                      [PRECOMPILED set] [OPTIMIZED] [GROUPED [ALONE file...]] [POSITION_INDEPENDENT])
#   hydroprint_program(NAME ...)   takes the same arguments
#
# PRECOMPILED: the set of precompiled headers (precompiled_headers.cmake); default: none.
# OPTIMIZED: -O3, for code that computes for seconds; other code uses the optimization of the build type.
# GROUPED: files of the target may be compiled in groups of HYDROPRINT_GROUP_SIZE (HYDROPRINT_GROUP_FILES). A group is a
# generated file that includes its files relative to the source tree. CMake's UNITY_BUILD includes them by absolute path,
# so the compiler cache of one clone would not help another.
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
    hydroprint_group_files(${name} ALONE ${arg_ALONE})
    # In grouped files, a class may legitimately have members of types from its file's anonymous namespace.
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endmacro()

set(HYDROPRINT_GROUP_SIZE 8)

# hydroprint_group_files(TARGET ALONE file...): replaces the target's sources by group files, except for ALONE, generated
# files, and files with compile options of their own.
function(hydroprint_group_files target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "ALONE")
  get_target_property(sources ${target} SOURCES)
  set(grouped "")
  set(single "")
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE OUTPUT_VARIABLE file)
    cmake_path(IS_PREFIX CMAKE_BINARY_DIR ${file} is_generated)
    if(options OR is_generated OR source IN_LIST arg_ALONE)
      list(APPEND single ${source})
    else()
      list(APPEND grouped ${file})
    endif()
  endforeach()
  list(LENGTH grouped count)
  set(first 0)
  while(first LESS count)
    list(SUBLIST grouped ${first} ${HYDROPRINT_GROUP_SIZE} group)
    set(content "")
    foreach(file ${group})
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
      string(APPEND content "#include \"${file}\"\n")
    endforeach()
    set(path ${CMAKE_CURRENT_BINARY_DIR}/${target}_from_${first}.cpp)
    file(CONFIGURE OUTPUT ${path} CONTENT "${content}")
    list(APPEND single ${path})
    math(EXPR first "${first} + ${HYDROPRINT_GROUP_SIZE}")
  endwhile()
  set_property(TARGET ${target} PROPERTY SOURCES ${single})
endfunction()
