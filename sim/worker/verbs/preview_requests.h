#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hydroprint::worker {

/// Lines that come in on a descriptor while something else is computed. The latest counts: whoever
/// turns an object wants to see where it is now.
class PreviewRequests {
 public:
  /// What is longer arrives as an empty line, which is no request.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 10;

  /// Reads `fd`, which stays the caller's, from now to its end, in a thread that is left to the
  /// end of the process.
  explicit PreviewRequests(int fd);

  struct Next {
    std::string line;
    std::vector<std::string> passed_over;  ///< those before it that were not begun
  };
  /// The latest line, once there is one; none after the last, or once `ended` says so.
  [[nodiscard]] std::optional<Next> next(const std::function<bool()>& ended);
  /// True if a newer one is there.
  [[nodiscard]] bool has_newer() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace hydroprint::worker
