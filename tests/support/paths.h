#pragma once

#include <string>
#include <string_view>

/// Paths of this build and its source tree. They are compiled in one generated file (paths.cpp.in),
/// so that test files compile to the same objects in every clone and the compiler cache of one
/// clone helps another.
namespace hydroprint::testing {

/// Path of a program of this build, such as "hydroprint-worker".
[[nodiscard]] std::string program_path(std::string_view name);

/// Path of a file or folder in the build folder, such as "python".
[[nodiscard]] std::string build_path(std::string_view file);

/// Path of a file or folder in the source tree, such as "hardware/profiles/virtual.toml".
[[nodiscard]] std::string source_path(std::string_view file);

/// Path of a file below HYDROPRINT_MODELS_DIR, which may not exist.
[[nodiscard]] std::string model_path(std::string_view file);

/// Path of the drive profile hardware/profiles/NAME.toml.
[[nodiscard]] inline std::string drive_profile_path(std::string_view name) {
  return source_path("hardware/profiles/" + std::string(name) + ".toml");
}

}  // namespace hydroprint::testing
