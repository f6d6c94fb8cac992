#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// A file descriptor that is closed with its owner.
class UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int fd) : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept;
  ~UniqueFd() { reset(); }

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool valid() const { return fd_ >= 0; }
  void reset();

 private:
  int fd_ = -1;
};

/// An Error for the last failed system call: "path: what: reason of the system"; a full disk is
/// kResourceExhausted, DISK_FULL, everything else kInternal, STORE_FAILED.
[[nodiscard]] tl::unexpected<Error> system_failure(const std::filesystem::path& path,
                                                   std::string_view what);

/// Opens with O_CLOEXEC and never through a symbolic link.
[[nodiscard]] Result<UniqueFd> open_file(const std::filesystem::path& path, int flags,
                                         unsigned mode = 0600);

/// Writes all bytes at the offset.
[[nodiscard]] Status write_at(const UniqueFd& file, const std::filesystem::path& path,
                              std::string_view bytes, std::int64_t offset);

/// Replaces a file's content; it may be lost in a power cut.
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes what was written to a file, or the names in a folder, survive a power cut.
[[nodiscard]] Status sync_path(const std::filesystem::path& path);

/// Renames and makes the new name survive a power cut.
[[nodiscard]] Status publish(const std::filesystem::path& from, const std::filesystem::path& to);

/// Makes a folder of one's own (0700) with its parents; one that is there already is fine.
[[nodiscard]] Status make_folder(const std::filesystem::path& path);

/// Deletes a file or folder with all it holds; absence is fine, failures are left to the next
/// start.
void discard(const std::filesystem::path& path);

/// Gives a file a second name, or copies it where the file system cannot.
[[nodiscard]] Status link_or_copy(const std::filesystem::path& from,
                                  const std::filesystem::path& to);

/// SHA-256 of a file's content as 64 lower-case hex digits.
[[nodiscard]] Result<std::string> sha256_of_file(const std::filesystem::path& path);

/// Refuses (kResourceExhausted, DISK_FULL) if fewer than `bytes` are free where `path` is.
[[nodiscard]] Status check_free_space(const std::filesystem::path& path, std::int64_t bytes);

}  // namespace hydroprint::daemon
