#include "daemon/admin/store_check.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <set>

#include "daemon/admin/backup.h"
#include "daemon/admin/progress_meter.h"
#include "daemon/store/job_rows.h"
#include "sim/base/number_text.h"

namespace hydroprint::admin {
namespace {

using daemon::CheckLine;
using Verdict = CheckLine::Verdict;

constexpr int kShown = 20;

/// One comparison of the files of a store with the rows of its database.
class FileCheck {
 public:
  FileCheck(const daemon::Layout& layout, daemon::Database& database,
            const std::function<bool()>& is_interrupted)
      : layout_(layout), database_(database), is_interrupted_(is_interrupted) {}

  Status run(const std::function<void(const CheckLine&)>& add) {
    HP_ASSIGN_OR_RETURN(const auto files, named_files(database_));
    HP_RETURN_IF_ERROR(read_files(files, add));
    if (is_interrupted_()) return {};
    if (faults_ == 0) {
      add({Verdict::kOk, "files",
           fmt::format("{} files of {} are as the database says", files.size(),
                       format_bytes(total_bytes_))});
    } else if (faults_ > kShown) {
      add({Verdict::kFault, "files", fmt::format("{} more are damaged", faults_ - kShown)});
    }
    return find_unknown(files, add);
  }

 private:
  Status read_files(const std::vector<NamedFile>& files,
                    const std::function<void(const CheckLine&)>& add) {
    for (const NamedFile& file : files) total_bytes_ += file.size;
    ProgressMeter meter("check of the files", total_bytes_);
    for (const NamedFile& file : files) {
      const std::string fault = fault_of(file);
      if (is_interrupted_()) return {};
      meter.add(file.size);
      if (fault.empty()) continue;
      // A daemon may have deleted it meanwhile.
      HP_ASSIGN_OR_RETURN(const bool is_still_named, is_named(database_, file));
      if (!is_still_named || ++faults_ > kShown) continue;
      add({Verdict::kFault, "file",
           fmt::format("{}: {}; {}", file.name, fault,
                       file.job == 0 ? "upload the file again, or restore a backup"
                                     : "retry the job, or restore a backup")});
    }
    return {};
  }

  // Returns what is wrong with a file; empty: nothing.
  [[nodiscard]] std::string fault_of(const NamedFile& file) const {
    const auto path = layout_.root / file.name;
    struct stat info {};
    if (::lstat(path.c_str(), &info) != 0) return "missing";
    if (!S_ISREG(info.st_mode)) return "not a regular file";
    if (info.st_size != file.size) {
      return fmt::format("has {} bytes instead of {}", info.st_size, file.size);
    }
    const auto hash = daemon::sha256_of_file(path, is_interrupted_);
    if (!hash) return "cannot be read";
    return *hash == file.sha256 ? "" : "its content has changed";
  }

  // Looks for files without a row. Those of jobs that run are not known yet.
  Status find_unknown(const std::vector<NamedFile>& files,
                      const std::function<void(const CheckLine&)>& add) {
    std::set<std::string> known;
    for (const NamedFile& file : files) known.insert(file.name);
    std::set<std::string> unknown = names_on_disk();
    std::erase_if(unknown, [&](const std::string& name) { return known.contains(name); });
    if (unknown.empty()) return {};
    HP_ASSIGN_OR_RETURN(const auto now, named_files(database_));
    for (const NamedFile& file : now) unknown.erase(file.name);
    HP_ASSIGN_OR_RETURN(const auto executions, daemon::select_executions(database_));
    for (const daemon::Execution& execution : executions) {
      const std::string folder = fmt::format("artifacts/{}/", execution.job);
      std::erase_if(unknown, [&](const std::string& name) { return name.starts_with(folder); });
    }
    if (unknown.empty()) return {};
    add({Verdict::kNote, "files",
         fmt::format("{} are not in the database, such as {}; the daemon moves them to set-aside/ "
                     "when it starts",
                     unknown.size(), *unknown.begin())});
    return {};
  }

  [[nodiscard]] std::set<std::string> names_on_disk() const {
    std::set<std::string> names;
    for (const auto& folder : {layout_.assets(), layout_.artifacts()}) {
      std::error_code ignored;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, ignored)) {
        if (!entry.is_directory(ignored)) {
          names.insert(entry.path().lexically_relative(layout_.root).string());
        }
      }
    }
    return names;
  }

  const daemon::Layout& layout_;
  daemon::Database& database_;
  const std::function<bool()>& is_interrupted_;
  std::int64_t total_bytes_ = 0;
  int faults_ = 0;
};

}  // namespace

void check_store(const daemon::Layout& layout, const std::function<void(const CheckLine&)>& add,
                 const std::function<bool()>& is_interrupted) {
  const auto path = layout.database();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    return add({Verdict::kNote, "database", path.string() + ": does not exist yet"});
  }
  const Status sound = daemon::Database::check(path);
  add(daemon::check_line("database", sound.map([&] { return path.string() + " is not damaged"; })));
  if (!sound) return;
  const auto database = daemon::Database::open_to_read(path);
  const Status done = database ? FileCheck(layout, **database, is_interrupted).run(add)
                               : tl::unexpected(database.error());
  if (!done) add({Verdict::kFault, "files", done.error().message});
}

}  // namespace hydroprint::admin
