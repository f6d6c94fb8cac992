#include "sim/base/process/out_folder.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <random>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 24> kArtifacts = {
    "combined.png",      "complete.png", "error.png",       "film.png",      "film_map.exr",
    "film_profile.toml", "landed.ply",   "landed.png",      "mask.png",      "model.glb",
    "plan.json",         "plan.ply",     "placement.pdf",   "predicted.png", "print.pdf",
    "print.png",         "print.tif",    "report.html",     "report.json",   "residuals.csv",
    "residuals.png",     "stretch.png",  "surface_map.ply", "wrinkles.png"};

/// Names before the numbers of pictures, sheets, frames and dips.
constexpr std::array<std::string_view, 7> kNumbered = {"complete-", "film-",    "frame-",   "mask-",
                                                       "print-",    "stretch-", "validate-"};

/// Returns true for report.json and frames.json. Every run writes one of them, so they mark a
/// folder as an artifact folder.
bool is_record(std::string_view name) { return name == "report.json" || name == "frames.json"; }

/// Returns whether a run may write a file with this name.
bool is_artifact_name(std::string_view name) {
  const auto begins = [name](std::string_view start) { return name.starts_with(start); };
  const bool is_numbered = std::any_of(kNumbered.begin(), kNumbered.end(), begins) &&
                           (name.ends_with(".png") || name.ends_with(".tif"));
  return is_record(name) || is_numbered ||
         std::find(kArtifacts.begin(), kArtifacts.end(), name) != kArtifacts.end();
}

constexpr std::string_view kPartial = ".partial-";
constexpr std::size_t kSuffixLength = 6;

Status check_replaceable(const fs::path& dir) {
  std::error_code error;
  const auto status = fs::status(dir, error);
  if (!fs::exists(status)) return {};
  if (!fs::is_directory(status)) {
    return fail(Code::kAlreadyExists, dir.string() + ": is a file. Choose another folder");
  }
  bool has_report = false;
  bool empty = true;
  std::string other_file;
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    empty = false;
    has_report = has_report || is_record(name);
    if (!is_artifact_name(name)) other_file = name;
  }
  if (error) {
    return fail(Code::kPermissionDenied,
                dir.string() + ": cannot be listed. Check its permissions");
  }
  if (!other_file.empty()) {
    return fail(Code::kAlreadyExists,
                dir.string() + ": contains " + other_file +
                    ", which is not an artifact of an earlier run. Choose another folder");
  }
  if (!empty && !has_report) {
    return fail(
        Code::kAlreadyExists,
        dir.string() +
            ": not empty, and has neither report.json nor frames.json. Choose another folder");
  }
  return {};
}

std::string random_suffix() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string out;
  for (std::size_t i = 0; i < kSuffixLength; ++i) out += kLetters[letter(device)];
  return out;
}

tl::unexpected<Error> system_failure(const fs::path& dir, int error) {
  if (error == ENOSPC || error == EDQUOT) {
    return fail(Code::kResourceExhausted,
                dir.string() + ": the disk is full. Free some space or choose another folder",
                ErrorReason::DISK_FULL);
  }
  return fail(Code::kPermissionDenied, dir.string() + ": cannot be written (" +
                                           std::generic_category().message(error) +
                                           "). Choose another folder");
}

/// Syncs a folder, so that after a power cut DIR either has all its files or is as it was before.
void sync_folder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

void remove_quietly(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

bool is_artifact(const std::string& name) {
  return is_artifact_name(name.substr(0, name.find(".part-")));
}

/// Opens a folder and locks it. Returns -1 on failure; errno is ENOENT if the folder is gone and
/// EWOULDBLOCK if another process holds the lock.
int open_locked(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return -1;
  struct stat ours {};
  struct stat there {};
  int error = ::flock(file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
  // The folder may have been removed before it was locked.
  if (error == 0 && (::fstat(file, &ours) != 0 || ::lstat(folder.c_str(), &there) != 0 ||
                     ours.st_ino != there.st_ino)) {
    error = ENOENT;
  }
  if (error == 0) return file;
  ::close(file);
  errno = error;
  return -1;
}

/// Removes partial folders of `dir` whose processes are dead.
void remove_stale(const fs::path& dir) {
  const std::string prefix = dir.filename().string() + std::string(kPartial);
  std::error_code error;
  std::vector<fs::path> stale;
  for (fs::directory_iterator entry(dir.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(prefix) && name.size() == prefix.size() + kSuffixLength) {
      stale.push_back(entry->path());
    }
  }
  for (const fs::path& folder : stale) {
    const int locked = open_locked(folder);
    if (locked < 0) continue;  // in use, or on a file system without locks: keep it
    const bool ours = std::all_of(fs::directory_iterator(folder, error), {}, [](const auto& entry) {
      return is_artifact(entry.path().filename().string());
    });
    if (ours && !error) remove_quietly(folder);
    ::close(locked);
  }
}

Status move_into_place(const fs::path& partial, const fs::path& dir) {
  if (::rename(partial.c_str(), dir.c_str()) == 0) return {};  // DIR did not exist, or was empty
  if (::renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, dir.c_str(), RENAME_EXCHANGE) == 0) {
    remove_quietly(partial);  // holds the earlier run's files now
    return {};
  }
  // Some file systems cannot exchange names.
  const fs::path old = partial.string() + "-old";
  if (::rename(dir.c_str(), old.c_str()) != 0) return system_failure(dir, errno);
  if (::rename(partial.c_str(), dir.c_str()) != 0) {
    const int error = errno;
    ::rename(old.c_str(), dir.c_str());
    return system_failure(dir, error);
  }
  remove_quietly(old);
  return {};
}

}  // namespace

Result<OutFolder> OutFolder::plan(const fs::path& dir) {
  std::error_code error;
  // Follows links, so that the folder itself is replaced and not a link to it.
  fs::path target = fs::weakly_canonical(fs::absolute(dir, error), error);
  if (!target.has_filename()) target = target.parent_path();
  if (error || !target.has_filename()) {
    return fail(Code::kInvalidArgument,
                dir.string() + ": not usable as the output folder. Choose another folder");
  }
  if (!fs::is_directory(target.parent_path(), error)) {
    return fail(Code::kNotFound, target.parent_path().string() +
                                     ": no such folder. Create it or choose another folder");
  }
  if (::access(target.parent_path().c_str(), W_OK | X_OK) != 0) {
    return system_failure(target, errno);
  }
  HP_RETURN_IF_ERROR(check_replaceable(target));
  return OutFolder(std::move(target));
}

OutFolder::OutFolder(fs::path dir)
    : dir_(std::move(dir)), partial_(dir_.string() + std::string(kPartial) + random_suffix()) {}

OutFolder::OutFolder(OutFolder&& other) noexcept
    : dir_(std::move(other.dir_)),
      partial_(std::move(other.partial_)),
      lock_(std::exchange(other.lock_, -1)),
      created_(std::exchange(other.created_, false)) {}

OutFolder::~OutFolder() {
  if (created_) remove_quietly(partial_);
  if (lock_ >= 0) ::close(lock_);
}

Status OutFolder::create() {
  remove_stale(dir_);
  // Until the folder is locked, another process may mistake it for an abandoned one and remove it.
  // In that case, tries again.
  for (int attempt = 0; attempt < 100 && lock_ < 0; ++attempt) {
    if (::mkdir(partial_.c_str(), 0777) != 0 && !(created_ && errno == EEXIST)) {
      return system_failure(dir_, errno);
    }
    created_ = true;
    lock_ = open_locked(partial_);
    // Continues without a lock if the file system does not support locks.
    if (lock_ < 0 && errno != EWOULDBLOCK && errno != ENOENT) break;
    if (lock_ < 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return {};
}

Status OutFolder::commit() {
  HP_RETURN_IF_ERROR(check_replaceable(dir_));
  sync_folder(partial_);
  HP_RETURN_IF_ERROR(move_into_place(partial_, dir_));
  created_ = false;
  sync_folder(dir_.parent_path());
  return {};
}

void OutFolder::abandon() const {
  // A file that is being written may appear between emptying the folder and removing it.
  std::error_code error;
  for (int attempt = 0; attempt < 100; ++attempt) {
    remove_quietly(partial_);
    if (!fs::exists(partial_, error)) return;
  }
}

std::string OutFolder::in_terms_of_dir(std::string message) const {
  const std::string partial = partial_.string();
  for (auto at = message.find(partial); at != std::string::npos; at = message.find(partial)) {
    message.replace(at, partial.size(), dir_.string());
  }
  return message;
}

}  // namespace hydroprint::worker
