#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::v1 {
class InputFile;
}

namespace hydroprint::worker {

/// Resolves the files named in a spec.
class InputFolder {
 public:
  /// @param folder     base of relative names; empty: the working directory
  /// @param pose_file  the file from which the spec's pose was read; empty: not from a file
  explicit InputFolder(const std::filesystem::path& folder, std::filesystem::path pose_file = {});

  /// Returns the path of a file; empty if the spec does not name one.
  [[nodiscard]] std::filesystem::path path(const v1::InputFile& file) const;
  /// Returns the path of a required file, or fail_field() if the spec does not name one.
  [[nodiscard]] Result<std::filesystem::path> required(const std::string& field,
                                                       const v1::InputFile& file) const;
  /// Returns `text` for film::parse_outline(), with the path of a polygon's file resolved. Returns
  /// fail_field() if `text` is not valid. Does not open the polygon's file.
  [[nodiscard]] Result<std::string> film(const std::string& text) const;

  [[nodiscard]] const std::filesystem::path& pose_file() const { return pose_file_; }

 private:
  [[nodiscard]] std::filesystem::path resolve(const std::string& name) const;

  std::filesystem::path folder_, pose_file_;
};

}  // namespace hydroprint::worker
