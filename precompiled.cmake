# Halves the time of a build: what most files of a folder include is compiled once (precompiled headers), and where
# templates of libraries take most of the time the files of a target are compiled eight at once (unity builds).
# A file still includes what it needs: tests/tidy and the preset `dev` see each alone (CMAKE_DISABLE_PRECOMPILE_HEADERS).
if(CMAKE_DISABLE_PRECOMPILE_HEADERS OR HYDROPRINT_FUZZ)
  return()
endif()

find_package(Eigen3 CONFIG REQUIRED)
find_package(tl-expected CONFIG REQUIRED)

# hydroprint_precompiled(name HEADERS header... [LIBS target...]): precompiled_NAME, and the same with gtest for tests.
function(hydroprint_precompiled name)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBS" ${ARGN})
  file(CONFIGURE OUTPUT precompiled.cpp CONTENT "")
  add_library(precompiled_${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(precompiled_${name} PRIVATE hydroprint_options tl::expected ${arg_LIBS})
  target_precompile_headers(precompiled_${name} PRIVATE
    <algorithm> <array> <chrono> <cmath> <filesystem> <fstream> <functional> <iostream> <map> <memory> <numbers>
    <optional> <random> <span> <sstream> <string> <string_view> <thread> <utility> <vector> <tl/expected.hpp>
    ${arg_HEADERS})
  if(HYDROPRINT_TESTS AND NOT name MATCHES "_test$")
    find_package(GTest REQUIRED)
    hydroprint_precompiled(${name}_test HEADERS ${arg_HEADERS} <gtest/gtest.h> LIBS ${arg_LIBS} GTest::gtest)
  endif()
endfunction()

# hydroprint_use_precompiled(folder name): has the programs and static libraries of the folder use it, and those below.
# Modules, and what goes into them, do not: their code can be moved (-fPIC), so it is compiled otherwise.
function(hydroprint_use_precompiled folder name)
  cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE place)
  get_directory_property(flags DIRECTORY ${folder} DEFINITION CMAKE_CXX_FLAGS_RELEASE)
  if(CMAKE_BUILD_TYPE STREQUAL "Release" AND flags MATCHES "-O3")
    set(name optimised)
  elseif(place MATCHES "^sim|(daemon/dip|daemon/rest|client/loop)$|^daemon/(people|tls)$")
    set(name sim)  # the last ones: parts of daemon and client that know no network
  elseif(place MATCHES "client/cli$")
    set(name cli)
  elseif(place MATCHES "(daemon|daemon/http|client|tests/daemon/people)$")
    set(name service)
  endif()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(REMOVE_ITEM targets hydroprint_messages hydroprint_proto)  # generated, with flags of its own
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    get_target_property(libs ${target} LINK_LIBRARIES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    get_target_property(is_movable ${target} POSITION_INDEPENDENT_CODE)
    if(NOT type MATCHES "^(EXECUTABLE|STATIC_LIBRARY)$" OR NOT libs OR is_movable OR options MATCHES "-O")
      continue()
    endif()
    if(place MATCHES "^(client|daemon|tests)" OR place MATCHES "^sim/(fit|image|mesh|pipeline|validate|worker)")
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
      # A class may well hold what its own file's anonymous namespace has.
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
    # Whoever knows protobuf and no gRPC is compiled otherwise there than all others: proto/CMakeLists.txt.
    if(HYDROPRINT_SANITIZE STREQUAL "thread" AND place MATCHES "daemon/rest(/rules)?$")
      continue()
    endif()
    if("GTest::gtest" IN_LIST libs)
      target_precompile_headers(${target} REUSE_FROM precompiled_${name}_test)
    else()
      target_precompile_headers(${target} REUSE_FROM precompiled_${name})
    endif()
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(inner ${below})
    hydroprint_use_precompiled(${inner} ${name})
  endforeach()
endfunction()

hydroprint_precompiled(sim HEADERS <Eigen/Core> <Eigen/Geometry> LIBS Eigen3::Eigen)
# GCC optimises what uses precompiled headers as these were, whatever it is asked for: one for each way.
hydroprint_precompiled(optimised HEADERS <Eigen/Core> <Eigen/Geometry> LIBS Eigen3::Eigen)
target_compile_options(precompiled_optimised PRIVATE -O3)
if(HYDROPRINT_DAEMON)
  hydroprint_precompiled(cli HEADERS <CLI/CLI.hpp> <nlohmann/json.hpp>)
  hydroprint_precompiled(service HEADERS <google/protobuf/util/time_util.h> <grpcpp/grpcpp.h> <nlohmann/json.hpp>
    LIBS hydroprint_proto)
endif()
hydroprint_use_precompiled(${CMAKE_SOURCE_DIR} sim)
