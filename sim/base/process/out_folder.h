#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// An artifact folder DIR that is being written. Files go to DIR.partial-XXXXXX beside it, which is
/// renamed to DIR in the last step. If the program ends earlier, DIR is unchanged. The process
/// holds a lock on its partial folder. A partial folder without a lock belongs to a killed process;
/// the next process for the same DIR removes it.
class OutFolder {
 public:
  /// Rejects a DIR whose parent folder is missing, that is not a folder, or that contains files
  /// other than the artifacts of an earlier run (report.json etc.), which will be replaced.
  [[nodiscard]] static Result<OutFolder> plan(const std::filesystem::path& dir);

  OutFolder(OutFolder&& other) noexcept;
  OutFolder& operator=(OutFolder&&) = delete;
  /// Removes the partial folder unless it was committed.
  ~OutFolder();

  /// Creates the partial folder and removes those of dead processes. Errors, naming DIR:
  /// kResourceExhausted (reason DISK_FULL) or kPermissionDenied.
  [[nodiscard]] Status create();
  /// Renames the partial folder to DIR, replacing an earlier run's folder. Atomic if the file
  /// system can exchange names.
  [[nodiscard]] Status commit();
  /// Removes the partial folder. May be called while another thread still writes into it.
  void abandon() const;

  [[nodiscard]] const std::filesystem::path& dir() const { return dir_; }
  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
  /// Rewrites a message about the partial folder as one about DIR.
  [[nodiscard]] std::string in_terms_of_dir(std::string message) const;

 private:
  explicit OutFolder(std::filesystem::path dir);

  std::filesystem::path dir_;
  std::filesystem::path partial_;
  int lock_ = -1;  ///< file descriptor of the locked partial folder
  bool created_ = false;
};

}  // namespace hydroprint::worker
