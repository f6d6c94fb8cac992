# Sets of precompiled headers, which targets select with PRECOMPILED. They halve the build time. Every file still includes
# the headers that it needs: CMAKE_DISABLE_PRECOMPILE_HEADERS (preset `dev`) and tests/tidy compile without them.

# hydroprint_precompiled_headers(SET HEADERS header... [LIBS target...])
# Declares four variants: plain and OPTIMIZED, each also with GoogleTest. GCC ignores the optimization level on the
# command line and uses that of the precompiled header, so every level needs its own header.
function(hydroprint_precompiled_headers set)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBS" ${ARGN})
  hydroprint_precompiled_variant(${set} "" ${ARGN})
  hydroprint_precompiled_variant(${set}_optimized "${HYDROPRINT_OPTIMIZED}" ${ARGN})
  if(HYDROPRINT_TESTS)
    set(test HEADERS ${arg_HEADERS} <gtest/gtest.h> LIBS ${arg_LIBS} GTest::gtest)
    hydroprint_precompiled_variant(${set}_test "" ${test})
    hydroprint_precompiled_variant(${set}_optimized_test "${HYDROPRINT_OPTIMIZED}" ${test})
  endif()
endfunction()

function(hydroprint_precompiled_variant name optimization)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBS" ${ARGN})
  file(CONFIGURE OUTPUT precompiled.cpp CONTENT "")
  add_library(precompiled_${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(precompiled_${name} PRIVATE hydroprint_options fmt::fmt tl::expected ${arg_LIBS})
  target_compile_options(precompiled_${name} PRIVATE ${optimization})
  target_precompile_headers(precompiled_${name} PRIVATE
    <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <iostream> <map> <memory> <numbers>
    <optional> <random> <span> <sstream> <string> <string_view> <thread> <utility> <vector> <fmt/format.h>
    <tl/expected.hpp> ${arg_HEADERS})
endfunction()

find_package(Eigen3 CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(tl-expected CONFIG REQUIRED)
if(HYDROPRINT_TESTS)
  find_package(GTest REQUIRED)
endif()

hydroprint_precompiled_headers(values HEADERS <Eigen/Core> <Eigen/Geometry> LIBS Eigen3::Eigen)
hydroprint_precompiled_headers(worker
  HEADERS <Eigen/Core> <Eigen/Geometry> <google/protobuf/message.h> <nlohmann/json.hpp>
  LIBS Eigen3::Eigen hydroprint_messages)
hydroprint_precompiled_headers(messages HEADERS <google/protobuf/util/time_util.h> <nlohmann/json.hpp>
  LIBS hydroprint_messages)
if(HYDROPRINT_DAEMON)
  hydroprint_precompiled_headers(command_line
    HEADERS <CLI/CLI.hpp> <google/protobuf/message.h> <nlohmann/json.hpp> LIBS hydroprint_messages)
  hydroprint_precompiled_headers(service
    HEADERS <google/protobuf/util/time_util.h> <grpcpp/grpcpp.h> <nlohmann/json.hpp> LIBS hydroprint_proto)
endif()
