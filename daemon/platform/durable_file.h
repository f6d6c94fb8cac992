#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Owns a file descriptor and closes it on destruction.
class UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int fd) : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept;
  ~UniqueFd() { reset(); }

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool valid() const { return fd_ >= 0; }
  /// Gives the descriptor away.
  [[nodiscard]] int release() { return std::exchange(fd_, -1); }
  void reset();

 private:
  int fd_ = -1;
};

/// Returns an Error for the last failed system call: "PATH: WHAT: REASON", with the reason from the
/// system. A full disk is kResourceExhausted, DISK_FULL; anything else is kInternal, STORE_FAILED.
[[nodiscard]] tl::unexpected<Error> system_failure(const std::filesystem::path& path,
                                                   std::string_view what);

/// Opens a file with O_CLOEXEC. A symbolic link is an error.
[[nodiscard]] Result<UniqueFd> open_file(const std::filesystem::path& path, int flags,
                                         unsigned mode = 0600);

/// Writes all bytes at the offset.
[[nodiscard]] Status write_at(const UniqueFd& file, const std::filesystem::path& path,
                              std::string_view bytes, std::int64_t offset);

/// Replaces a file's content. Does not sync, so a power cut may lose the content.
[[nodiscard]] Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// Syncs a file's content, or a folder's entries, to disk.
[[nodiscard]] Status sync_path(const std::filesystem::path& path);

/// Renames a file and syncs the new name to disk.
[[nodiscard]] Status publish(const std::filesystem::path& from, const std::filesystem::path& to);

/// Creates a private folder (0700) and its missing parents, unless it exists.
[[nodiscard]] Status make_folder(const std::filesystem::path& path);

/// Calls `use` with the name of each entry of an open folder, until it returns an error.
/// @param path  the folder's, for messages
/// @return the error of `use`; errors of the folder
[[nodiscard]] Status for_each_entry(const UniqueFd& folder, const std::filesystem::path& path,
                                    const std::function<Status(const std::string& name)>& use);

/// Deletes a file or a folder with its content, if it exists. Follows no link, needs few
/// descriptors for folders of any depth, and makes folders writable that are not. Ignores errors:
/// the next start deletes or sets aside files that remain.
void discard(const std::filesystem::path& path);

/// Reads the first `bytes` bytes of an open file in blocks of 1 MiB, until `use` returns an error.
/// @param path  the file's, for messages
/// @return the error of `use`; errors of the file
[[nodiscard]] Status read_blocks(
    const UniqueFd& file, const std::filesystem::path& path, std::int64_t bytes,
    const std::function<Status(std::string_view block, std::int64_t offset)>& use);

/// Copies the first `bytes` bytes of an open file to the new file `to`.
/// @return kCancelled after a request to stop; the copy is then incomplete
[[nodiscard]] Status copy_bytes(const UniqueFd& from, std::int64_t bytes,
                                const std::filesystem::path& to, const std::stop_token& stop = {});

/// Creates a hard link, or copies the file if the file system cannot link.
/// @return as copy_bytes()
[[nodiscard]] Status link_or_copy(const std::filesystem::path& from,
                                  const std::filesystem::path& to,
                                  const std::stop_token& stop = {});

/// Returns the SHA-256 of a file's content, as 64 lower-case hex digits.
/// @param is_cancelled  asked after each block, if given
/// @return kCancelled if it returned true; errors of the file
[[nodiscard]] Result<std::string> sha256_of_file(const std::filesystem::path& path,
                                                 const std::function<bool()>& is_cancelled = {});

/// Returns kResourceExhausted, DISK_FULL if the disk of `path` has less than `bytes` free.
[[nodiscard]] Status check_free_space(const std::filesystem::path& path, std::int64_t bytes);

}  // namespace hydroprint::daemon
