#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hydroprint::worker {

/// Receives lines on a file descriptor while a preview is computed. Only the latest line matters,
/// because the user wants to see the object's current pose.
class PreviewRequests {
 public:
  /// Maximum length of a line. A longer line is replaced with an empty one, which is not a valid
  /// request.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 10;

  /// Starts a thread that reads `fd` to its end. The thread is never joined. The caller owns `fd`
  /// and must not close it.
  explicit PreviewRequests(int fd);

  struct Next {
    std::string line;
    std::vector<std::string> passed_over;  ///< earlier lines that next() has not returned
  };
  /// Waits for a line and returns the latest one; nullopt at the end of the input or when `ended`
  /// returns true.
  [[nodiscard]] std::optional<Next> next(const std::function<bool()>& ended);
  /// Returns true if a newer line has arrived.
  [[nodiscard]] bool has_newer() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace hydroprint::worker
