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

/// A tar archive that is being written; only its user may read it. What is not finished is deleted.
class ArchiveWriter {
 public:
  /// The file is written under another name and gets its own when it is finished.
  /// @return kAlreadyExists if it is there
  [[nodiscard]] static Result<std::unique_ptr<ArchiveWriter>> create(
      const std::filesystem::path& path);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Adds what a file holds, `size` bytes of it; its SHA-256, hex.
  /// @param taken  is told of bytes as they go
  /// @return kDataLoss if there are fewer: then zeros stand for them
  [[nodiscard]] Result<std::string> add(const std::string& name, const daemon::UniqueFd& file,
                                        std::int64_t size,
                                        const std::function<void(std::int64_t)>& taken);
  [[nodiscard]] Status add(const std::string& name, std::string_view content);
  /// All of it is on disk, under its name, when this returns.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit ArchiveWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What an archive holds next.
struct ArchiveEntry {
  std::string name;
  std::int64_t size = 0;
  bool is_file = false;  ///< and no folder, link or device
};

/// An archive that is read from its beginning to its end. A file that is none, or is cut off, is
/// kInvalidArgument.
class ArchiveReader {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ArchiveReader>> open(
      const std::filesystem::path& path);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  /// None at the end.
  [[nodiscard]] Result<std::optional<ArchiveEntry>> next();
  /// The content of the entry that next() told of, by pieces; ends with the first error.
  [[nodiscard]] Status read(const std::function<Status(std::string_view)>& piece);

 private:
  struct Impl;
  explicit ArchiveReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::admin
