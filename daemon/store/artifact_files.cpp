#include "daemon/store/artifact_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <numeric>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/asset.h"
#include "sim/base/sha256.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostArtifacts = 1000;
constexpr std::int64_t kBytesPerMiB = 1 << 20;
constexpr const char* kNotPlain = "something other than regular files with plain names";

/// A file of the output, as it was when the folder was read.
struct OutputFile {
  std::string name;
  struct stat info {};
};

tl::unexpected<Error> unusable(const std::string& what) {
  return fail(
      Code::kInternal,
      "the worker's output contains " + what + "; check that workers.program is hydroprint-worker",
      ErrorReason::WORKER_UNUSABLE);
}

tl::unexpected<Error> too_large(const std::string& what, std::int64_t allowed_bytes) {
  return fail(Code::kResourceExhausted,
              fmt::format("{} larger than {} MiB; lower dpi or raise workers.file_mib", what,
                          allowed_bytes / kBytesPerMiB),
              ErrorReason::OUTPUT_LIMIT);
}

bool is_plain(const struct stat& info) { return S_ISREG(info.st_mode) && info.st_nlink == 1; }

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

Status check_may_continue(const PublishOptions& options) {
  if (options.stop.stop_requested()) return fail(Code::kCancelled, "cancelled");
  if (std::chrono::steady_clock::now() < options.deadline) return {};
  return fail(Code::kResourceExhausted,
              "storing the artifacts took too long; check the disk of the state folder and the "
              "shared folder, or lower dpi",
              ErrorReason::TIME_LIMIT);
}

Status sync_file(const UniqueFd& file, const std::filesystem::path& path) {
  if (::fsync(file.get()) != 0) return system_failure(path, "cannot be flushed to disk");
  return {};
}

// Syncs large files in pieces while they are read, so that the last sync is short and a request to
// stop is noticed. Other errors than those of the disk do not matter, because the last sync
// follows.
Status sync_piece(const UniqueFd& file, const std::filesystem::path& path, std::int64_t end) {
  constexpr std::int64_t kPiece = 64 * kBytesPerMiB;
  constexpr unsigned kAll =
      SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER;
  if (end % kPiece != 0 || ::sync_file_range(file.get(), end - kPiece, kPiece, kAll) == 0 ||
      (errno != EIO && errno != ENOSPC && errno != EDQUOT)) {
    return {};
  }
  return system_failure(path, "cannot be flushed to disk");
}

// Opens a folder below `base` one component after the other, so that none can be a link.
Result<UniqueFd> open_below(const std::filesystem::path& base,
                            const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(UniqueFd at, open_file(base, O_RDONLY | O_DIRECTORY));
  for (const auto& name : folder.lexically_relative(base)) {
    constexpr int kFlags = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    at = UniqueFd(::openat(at.get(), name.c_str(), kFlags));
    if (at.valid()) continue;
    if (errno == ENOENT) return unusable("no artifacts");
    if (errno == ENOTDIR || errno == ELOOP) {
      return unusable("a link or a file in place of its folder");
    }
    return system_failure(folder, "cannot be opened");
  }
  return at;
}

// Reads the folder and checks everything that can be checked without opening a file.
Result<std::vector<OutputFile>> list_output(const UniqueFd& folder,
                                            const std::filesystem::path& path,
                                            const OutputLimits& limits) {
  std::vector<OutputFile> files;
  std::int64_t total = 0;
  const auto add = [&](const std::string& name) -> Status {
    if (files.size() == kMostArtifacts) return unusable("too many files");
    OutputFile file{name};
    const bool is_known =
        ::fstatat(folder.get(), name.c_str(), &file.info, AT_SYMLINK_NOFOLLOW) == 0;
    if (!is_known || !is_plain(file.info) || !check_file_name("artifact", name)) {
      return unusable(kNotPlain);
    }
    if (file.info.st_size > limits.file_bytes) {
      return too_large("the worker's file " + name + " is", limits.file_bytes);
    }
    total += file.info.st_size;
    if (total > limits.total_bytes) {
      return too_large("all files of the worker together are", limits.total_bytes);
    }
    files.push_back(std::move(file));
    return {};
  };
  HP_RETURN_IF_ERROR(for_each_entry(folder, path, add));
  if (files.empty()) return unusable("no artifacts");
  std::sort(files.begin(), files.end(),
            [](const OutputFile& a, const OutputFile& b) { return a.name < b.name; });
  return files;
}

// Opens a file of the output, which may have been exchanged since the folder was read.
Result<UniqueFd> open_output(const UniqueFd& folder, const OutputFile& file) {
  UniqueFd out(
      ::openat(folder.get(), file.name.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
  if (!out.valid() && errno != ELOOP) return system_failure(file.name, "cannot be opened");
  struct stat info {};
  const bool is_unchanged = ::fstat(out.get(), &info) == 0 && is_plain(info) &&
                            is_same(info, file.info) && info.st_size == file.info.st_size;
  if (!is_unchanged) return unusable("files that change after its end");
  return out;
}

// Hashes a file, copies it if requested, and syncs it to disk.
Result<Artifact> take_file(const UniqueFd& folder, const OutputFile& file,
                           const PublishOptions& options) {
  HP_RETURN_IF_ERROR(check_may_continue(options));
  HP_ASSIGN_OR_RETURN(const UniqueFd source, open_output(folder, file));
  const std::filesystem::path path = options.copy / file.name;
  UniqueFd copy;
  if (!options.copy.empty()) {
    HP_ASSIGN_OR_RETURN(copy, open_file(path, O_WRONLY | O_CREAT | O_EXCL));
  }
  const UniqueFd& kept = copy.valid() ? copy : source;
  Sha256 hash;
  const auto take = [&](std::string_view block, std::int64_t offset) -> Status {
    HP_RETURN_IF_ERROR(check_may_continue(options));
    hash.add(block);
    if (copy.valid()) HP_RETURN_IF_ERROR(write_at(copy, path, block, offset));
    return sync_piece(kept, path, offset + static_cast<std::int64_t>(block.size()));
  };
  HP_RETURN_IF_ERROR(read_blocks(source, path, file.info.st_size, take));
  HP_RETURN_IF_ERROR(sync_file(kept, path));
  return Artifact{file.name, file.info.st_size, hash.finish(), media_type(file.name)};
}

// Prepares the folder of the copy, on a disk that has space for it: a sparse output needs more
// there.
Status make_copy_folder(const std::filesystem::path& folder, const std::vector<OutputFile>& files) {
  const auto add = [](std::int64_t sum, const OutputFile& file) { return sum + file.info.st_size; };
  discard(folder);
  HP_RETURN_IF_ERROR(make_folder(folder));
  return check_free_space(folder,
                          std::accumulate(files.begin(), files.end(), std::int64_t{0}, add));
}

// Moves the folder whose files were checked, and no other, to `to`.
Status move_checked(const UniqueFd& parent, const UniqueFd& folder,
                    const std::filesystem::path& from, const std::filesystem::path& to) {
  struct stat checked {};
  struct stat moved {};
  HP_RETURN_IF_ERROR(sync_file(folder, from));
  if (::renameat(parent.get(), from.filename().c_str(), AT_FDCWD, to.c_str()) != 0 ||
      ::fstat(folder.get(), &checked) != 0 || ::lstat(to.c_str(), &moved) != 0) {
    return system_failure(to, "cannot be created by renaming a folder");
  }
  if (is_same(checked, moved)) return sync_path(to.parent_path());
  discard(to);
  return unusable("a folder that changes after its end");
}

}  // namespace

std::chrono::seconds publishing_time(const OutputLimits& limits) {
  return std::chrono::seconds(60 + limits.total_bytes / (20 * kBytesPerMiB));
}

std::string media_type(const std::string& name) {
  static constexpr std::array<std::array<const char*, 2>, 12> kTypes{{
      {".png", "image/png"},
      {".pdf", "application/pdf"},
      {".json", "application/json"},
      {".html", "text/html"},
      {".ply", "model/ply"},
      {".exr", "image/x-exr"},
      {".tif", "image/tiff"},
      {".tiff", "image/tiff"},
      {".csv", "text/csv"},
      {".txt", "text/plain"},
      {".toml", "application/toml"},
      {".obj", "model/obj"},
  }};
  for (const auto& [extension, type] : kTypes) {
    if (name.ends_with(extension)) return type;
  }
  return "application/octet-stream";
}

Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                      const std::filesystem::path& folder, const std::stop_token& stop) {
  discard(folder);
  HP_RETURN_IF_ERROR(make_folder(folder));
  for (const InputFile& input : inputs) {
    const auto asset = layout.asset(input.sha256);
    if (!std::filesystem::exists(asset)) {
      return fail(Code::kFailedPrecondition,
                  input.name + ": assets/" + input.sha256 + " is missing; upload the file again",
                  ErrorReason::ASSET_MISSING);
    }
    HP_RETURN_IF_ERROR(make_folder((folder / input.name).parent_path()));
    HP_RETURN_IF_ERROR(link_or_copy(asset, folder / input.name, stop));
    HP_ASSIGN_OR_RETURN(const std::string hash,
                        sha256_of_file(folder / input.name, [&] { return stop.stop_requested(); }));
    if (hash != input.sha256) return asset_damaged(input);
  }
  return {};
}

Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                const std::filesystem::path& to,
                                                const PublishOptions& options) {
  const auto above = from.parent_path();
  const auto& within = options.within.empty() ? above : options.within;
  HP_ASSIGN_OR_RETURN(const UniqueFd parent, open_below(within, above));
  HP_ASSIGN_OR_RETURN(const UniqueFd folder, open_below(within, from));
  HP_ASSIGN_OR_RETURN(const auto files, list_output(folder, from, options.limits));
  const bool is_copied = !options.copy.empty();
  if (is_copied) HP_RETURN_IF_ERROR(make_copy_folder(options.copy, files));
  std::vector<Artifact> artifacts;
  for (const OutputFile& file : files) {
    HP_ASSIGN_OR_RETURN(Artifact artifact, take_file(folder, file, options));
    artifacts.push_back(std::move(artifact));
  }
  discard(to);
  if (!is_copied) {
    HP_RETURN_IF_ERROR(move_checked(parent, folder, from, to));
    return artifacts;
  }
  HP_RETURN_IF_ERROR(sync_path(options.copy));
  HP_RETURN_IF_ERROR(publish(options.copy, to));
  return artifacts;
}

}  // namespace hydroprint::daemon
