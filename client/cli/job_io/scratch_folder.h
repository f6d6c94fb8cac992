#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

namespace hydroprint::cli {

/// A new temporary folder, which the destructor deletes.
class ScratchFolder {
 public:
  ScratchFolder() { ::mkdtemp(path_.data()); }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_ = std::filesystem::temp_directory_path() / "hydroprint-XXXXXX";
};

}  // namespace hydroprint::cli
