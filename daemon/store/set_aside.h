#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "daemon/store/state_layout.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Returns the path of a folder `set-aside/TIME/` that does not exist yet.
[[nodiscard]] std::filesystem::path new_set_aside(const Layout& layout, std::int64_t now_ms);

/// Sets aside files that the database does not know. Most are left over from a crash, but if the
/// database was lost or replaced by an older copy, they are users' results. They are therefore not
/// deleted. The destructor logs how many files were moved, and where.
class SetAside {
 public:
  explicit SetAside(const Layout& layout, std::int64_t now_ms);
  ~SetAside();
  SetAside(const SetAside&) = delete;
  SetAside& operator=(const SetAside&) = delete;

  /// Moves a file or folder of the state folder to `set-aside/TIME/`, under the same relative path.
  /// Empty folders are deleted.
  [[nodiscard]] Status move(const std::filesystem::path& path);

 private:
  const Layout& layout_;
  std::filesystem::path folder_;
  int count_ = 0;
};

}  // namespace hydroprint::daemon
