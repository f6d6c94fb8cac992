#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::v1 {
class InputFile;
}

namespace hydroprint::worker {

/// Finds the files that a spec names.
class InputFolder {
 public:
  /// @param folder     base of relative names; empty: the working directory
  /// @param pose_file  the file that the spec's pose was read from; empty: not from a file
  explicit InputFolder(const std::filesystem::path& folder, std::filesystem::path pose_file = {});

  /// Path of a file; empty if the spec does not name one.
  [[nodiscard]] std::filesystem::path path(const v1::InputFile& file) const;
  /// Path of a required file. Fails with fail_field() if the spec does not name one.
  [[nodiscard]] Result<std::filesystem::path> required(const std::string& field,
                                                       const v1::InputFile& file) const;
  /// Returns a film for film::parse_outline(). Fails with fail_field() if it is not valid; the file
  /// of a polygon is not opened yet.
  [[nodiscard]] Result<std::string> film(const std::string& text) const;

  [[nodiscard]] const std::filesystem::path& pose_file() const { return pose_file_; }

 private:
  [[nodiscard]] std::filesystem::path resolve(const std::string& name) const;

  std::filesystem::path folder_, pose_file_;
};

}  // namespace hydroprint::worker
