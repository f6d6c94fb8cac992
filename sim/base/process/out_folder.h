#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// The artifact folder DIR in the making: files are written to DIR.partial-XXXXXX beside it, which
/// takes DIR's name as the last step. Whatever ends the program before that, DIR is as it was. Its
/// process holds a lock on the partial folder, by which the next one for the same DIR knows what a
/// process that was killed left behind.
class OutFolder {
 public:
  /// Refuses a DIR whose parent folder is missing, that is no folder, or that holds anything but
  /// artifacts of an earlier run (a report.json and its fellows), which will be replaced.
  [[nodiscard]] static Result<OutFolder> plan(const std::filesystem::path& dir);

  OutFolder(OutFolder&& other) noexcept;
  OutFolder& operator=(OutFolder&&) = delete;
  /// Removes the partial folder unless it was committed.
  ~OutFolder();

  /// Makes the partial folder, and removes those that processes now dead left. Refuses with
  /// kResourceExhausted (reason DISK_FULL) or kPermissionDenied, naming DIR.
  [[nodiscard]] Status create();
  /// Gives the partial folder DIR's name, replacing an earlier run's at once.
  [[nodiscard]] Status commit();
  /// Removes the partial folder; may be called while another thread still writes into it.
  void abandon() const;

  [[nodiscard]] const std::filesystem::path& dir() const { return dir_; }
  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
  /// A message about the partial folder told as one about DIR.
  [[nodiscard]] std::string in_terms_of_dir(std::string message) const;

 private:
  explicit OutFolder(std::filesystem::path dir);
  [[nodiscard]] bool lock();

  std::filesystem::path dir_;
  std::filesystem::path partial_;
  int lock_ = -1;  ///< the partial folder, open and locked
  bool created_ = false;
};

}  // namespace hydroprint::worker
