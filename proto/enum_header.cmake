# enum_header(PROTO ENUM HEADER CLASS): writes a C++ header with the values of an enum of a .proto file, for code that must
# not depend on protobuf. Values keep their names and numbers. The file is written again when the .proto file changes.
function(enum_header proto enum header class)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${proto})
  file(STRINGS ${proto} lines)
  set(values "")
  set(cases "")
  set(names "")
  set(inside FALSE)
  foreach(line IN LISTS lines)
    if(line MATCHES "^ *enum ${enum} {")
      set(inside TRUE)
    elseif(inside AND line MATCHES "^ *}")
      break()
    elseif(inside AND line MATCHES "^ *([A-Z][A-Z0-9_]*) = ([0-9]+);")
      string(APPEND values "  ${CMAKE_MATCH_1} = ${CMAKE_MATCH_2},\n")
      string(APPEND names "  if (name == \"${CMAKE_MATCH_1}\") return value = ${class}::${CMAKE_MATCH_1}, true;\n")
      string(APPEND cases "    case ${class}::${CMAKE_MATCH_1}:\n      return \"${CMAKE_MATCH_1}\";\n")
    endif()
  endforeach()
  if(NOT values)
    message(FATAL_ERROR "${proto} has no enum ${enum}")
  endif()
  get_filename_component(proto_name ${proto} NAME)
  file(CONFIGURE OUTPUT ${header} @ONLY CONTENT "// Generated from ${proto_name}.
#pragma once

#include <string_view>

namespace hydroprint {

enum class ${class} {
@values@};

/// Returns the name of a value in the .proto file; empty for other numbers.
constexpr std::string_view name_of(${class} value) {
  switch (value) {
@cases@  }
  return {};
}

/// Sets a value to the one of this name; false for other names.
constexpr bool parse(std::string_view name, ${class}& value) {
@names@  return false;
}

}  // namespace hydroprint
")
endfunction()
