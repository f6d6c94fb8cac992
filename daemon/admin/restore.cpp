#include "daemon/admin/restore.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>
#include <set>

#include "daemon/admin/archive.h"
#include "daemon/admin/progress_meter.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/state_lock.h"
#include "sim/base/checked_json.h"
#include "sim/base/sha256.h"
#include "sim/base/utf8.h"

namespace hydroprint::admin {
namespace {

constexpr std::int64_t kLargestManifest = 1 << 16;

// Returns the names that a restore replaces in the state folder: everything except the lock and the
// files that were set aside.
const std::vector<std::string>& kept_names() {
  static const std::vector<std::string> all{
      "assets", "artifacts",     "uploads",           "runs",
      "dips",   "hydroprint.db", "hydroprint.db-wal", "hydroprint.db-shm"};
  return all;
}

// Accepts only names that named_files() can return, so no path can lead out of the folder.
bool is_name_of_ours(const std::string& name) {
  if (name == kDatabaseName || name == kManifestName) return true;
  if (name.starts_with("assets/")) {
    return name.size() == 7 + 2 + 1 + 62 && name[9] == '/' &&
           daemon::is_sha256(name.substr(7, 2) + name.substr(10));
  }
  if (!name.starts_with("artifacts/")) return false;
  const auto slash = name.find('/', 10);
  return slash != std::string::npos && daemon::parse_number(name.substr(10, slash - 10)) > 0 &&
         daemon::check_file_name("name", name.substr(slash + 1)).has_value();
}

/// An archive unpacked to a folder, which is deleted with this object unless it was moved away.
class Unpacked {
 public:
  Unpacked(std::filesystem::path file, std::filesystem::path folder)
      : file_(std::move(file)), folder_(std::move(folder)) {}
  ~Unpacked() { daemon::discard(folder_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  Result<Contents> run() {
    daemon::discard(folder_);  // left by an interrupted restore
    HP_RETURN_IF_ERROR(daemon::make_folder(folder_));
    HP_RETURN_IF_ERROR(unpack());
    HP_RETURN_IF_ERROR(check_manifest());
    return check_database();
  }

 private:
  tl::unexpected<Error> refused(const std::string& what) const {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: {}. Nothing was restored", file_.string(), what));
  }

  Status unpack() {
    std::error_code error;
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file_, error));
    HP_ASSIGN_OR_RETURN(const auto in, ArchiveReader::open(file_));
    HP_RETURN_IF_ERROR(daemon::check_free_space(folder_, error ? 0 : size));
    ProgressMeter meter("restore", error ? 0 : size);
    for (;;) {
      HP_ASSIGN_OR_RETURN(const auto entry, in->next());
      if (!entry) return {};
      if (!entry->is_file || !is_name_of_ours(entry->name) || hashes_.contains(entry->name)) {
        return refused(fmt::format("contains \"{:.100}\", which is not part of a backup",
                                   one_line(entry->name)));
      }
      HP_RETURN_IF_ERROR(unpack_one(*in, *entry, meter));
    }
  }

  Status unpack_one(ArchiveReader& in, const ArchiveEntry& entry, ProgressMeter& meter) {
    const auto path = folder_ / entry.name;
    HP_RETURN_IF_ERROR(daemon::make_folder(path.parent_path()));
    const bool is_database = entry.name == kDatabaseName;
    HP_ASSIGN_OR_RETURN(const auto out, daemon::open_file(path, O_WRONLY | O_CREAT | O_EXCL,
                                                          is_database ? 0600 : 0400));
    Sha256 hash;
    std::int64_t offset = 0;
    const Status read = in.read([&](std::string_view bytes) -> Status {
      HP_RETURN_IF_ERROR(daemon::write_at(out, path, bytes, offset));
      hash.add(bytes);
      offset += static_cast<std::int64_t>(bytes.size());
      meter.add(static_cast<std::int64_t>(bytes.size()));
      return {};
    });
    HP_RETURN_IF_ERROR(read);
    if (::fsync(out.get()) != 0) return daemon::system_failure(path, "cannot be flushed to disk");
    hashes_[entry.name] = hash.finish();
    return {};
  }

  // The manifest comes last, so its presence proves that the archive is complete.
  Status check_manifest() {
    const auto path = folder_ / kManifestName;
    if (!hashes_.contains(kManifestName) || !hashes_.contains(kDatabaseName)) {
      return refused("not a complete backup");
    }
    std::string text(static_cast<std::size_t>(kLargestManifest), '\0');
    HP_ASSIGN_OR_RETURN(const auto in, daemon::open_file(path, O_RDONLY));
    const ssize_t count = ::read(in.get(), text.data(), text.size());
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    const auto manifest = parse_json(text).value_or(nlohmann::json());
    if (!manifest.is_object() || manifest.value("format", nlohmann::json()) != kBackupFormat) {
      return refused(
          "its manifest has an unknown format; use the version of hydroprintd that made the "
          "backup");
    }
    if (manifest.value("database_sha256", nlohmann::json()) != hashes_[kDatabaseName]) {
      return refused("damaged: the database does not match its hash");
    }
    daemon::discard(path);
    hashes_.erase(kManifestName);
    return {};
  }

  Result<Contents> check_database() {
    const auto path = folder_ / kDatabaseName;
    if (!daemon::check_build(path)) {
      return fail(Code::kFailedPrecondition,
                  file_.string() +
                      ": was made by another build of hydroprint; restore it with that "
                      "build. Nothing was restored",
                  ErrorReason::STORE_DIFFERS);
    }
    const Status sound = daemon::Database::check(path);
    if (!sound && sound.error().reason == ErrorReason::DISK_FULL)
      return tl::unexpected(sound.error());
    if (!sound) return refused("damaged: its database is not sound");
    HP_ASSIGN_OR_RETURN(const auto database, daemon::Database::open(path, ""));
    Contents contents;
    HP_ASSIGN_OR_RETURN(const auto files, named_files(*database));
    std::set<std::string> named{kDatabaseName};
    for (const NamedFile& file : files) {
      const auto found = hashes_.find(file.name);
      if (found == hashes_.end() || found->second != file.sha256) {
        return refused(fmt::format("damaged: {} does not match its hash", one_line(file.name)));
      }
      named.insert(file.name);
      ++contents.files;
      contents.bytes += file.size;
    }
    HP_ASSIGN_OR_RETURN(contents.jobs, count_jobs(*database));
    HP_RETURN_IF_ERROR(note(*database, "restore", ""));
    for (const auto& [name, hash] : hashes_) {
      if (!named.contains(name)) daemon::discard(folder_ / name);  // deleted during the backup
    }
    return contents;
  }

  std::filesystem::path file_, folder_;
  std::map<std::string, std::string> hashes_;  // hash of each file, by name
};

// Returns whether the folder is empty, apart from the lock and the remains of an interrupted
// restore.
bool is_empty(const daemon::Layout& layout) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(layout.root, error)) {
    if (entry.path() != layout.lock() && entry.path() != layout.restoring()) return false;
  }
  return !error;
}

// This is the only step that cannot be undone. No daemon starts while the marker exists.
Status replace(const daemon::Layout& layout) {
  const auto mark = layout.unrestored();
  {
    HP_ASSIGN_OR_RETURN(const auto file, daemon::open_file(mark, O_WRONLY | O_CREAT));
    HP_RETURN_IF_ERROR(daemon::sync_path(layout.root));
  }
  for (const std::string& name : kept_names()) daemon::discard(layout.root / name);
  for (const std::string& name : kept_names()) {
    const auto from = layout.restoring() / name;
    std::error_code ignored;
    if (std::filesystem::exists(from, ignored)) {
      HP_RETURN_IF_ERROR(daemon::publish(from, layout.root / name));
    }
  }
  if (::unlink(mark.c_str()) != 0) return daemon::system_failure(mark, "cannot be deleted");
  return daemon::sync_path(layout.root);
}

}  // namespace

Result<Contents> restore(const std::filesystem::path& root, const std::filesystem::path& file,
                         bool replaces) {
  daemon::Layout layout;
  HP_ASSIGN_OR_RETURN(layout.root, state_root(root));
  std::error_code ignored;
  HP_ASSIGN_OR_RETURN(const auto lock, daemon::lock_state(layout));
  const bool was_begun = std::filesystem::exists(layout.unrestored(), ignored);
  if (!replaces && !was_begun && !is_empty(layout)) {
    return fail(Code::kFailedPrecondition,
                layout.root.string() +
                    ": not empty; name another folder, or add --replace to delete its content");
  }
  Unpacked unpacked(std::filesystem::absolute(file), layout.restoring());
  HP_ASSIGN_OR_RETURN(Contents contents, unpacked.run());
  HP_RETURN_IF_ERROR(replace(layout));
  return contents;
}

}  // namespace hydroprint::admin
