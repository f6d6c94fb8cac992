#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/platform/durable_file.h"
#include "sim/base/result.h"

namespace hydroprint::admin {

/// Writes a tar archive that only its owner can read. An unfinished archive is deleted.
class ArchiveWriter {
 public:
  /// Creates the file under a temporary name; finish() renames it.
  /// @return kAlreadyExists if the file exists
  [[nodiscard]] static Result<std::unique_ptr<ArchiveWriter>> create(
      const std::filesystem::path& path);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Adds `size` bytes of a file and returns their SHA-256 in hex.
  /// @param taken  called after each piece with its number of bytes
  /// @return kDataLoss if the file is shorter; the rest of the entry is then filled with zeros
  [[nodiscard]] Result<std::string> add(const std::string& name, const daemon::UniqueFd& file,
                                        std::int64_t size,
                                        const std::function<void(std::int64_t)>& taken);
  [[nodiscard]] Status add(const std::string& name, std::string_view content);
  /// Syncs the archive to disk and renames it.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit ArchiveWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The header of the next entry in an archive.
struct ArchiveEntry {
  std::string name;
  std::int64_t size = 0;
  bool is_file = false;  ///< a regular file: not a folder, link or device
};

/// Reads an archive from beginning to end. Returns kInvalidArgument if the file is not an archive
/// or is truncated.
class ArchiveReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ArchiveReader>> open(
      const std::filesystem::path& path);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  /// Returns the header of the next entry; nullopt at the end.
  [[nodiscard]] Result<std::optional<ArchiveEntry>> next();
  /// Reads the content of the current entry in pieces; stops at the first error.
  [[nodiscard]] Status read(const std::function<Status(std::string_view)>& piece);

 private:
  struct Impl;
  explicit ArchiveReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::admin
