#include "daemon/admin/offline_state.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "daemon/auth/audit_log.h"
#include "daemon/config/config.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/state_lock.h"

namespace hydroprint::admin {
namespace {

std::string user_name(uid_t id) {
  const passwd* const entry = ::getpwuid(id);
  return entry != nullptr ? entry->pw_name : std::to_string(id);
}

}  // namespace

Result<std::filesystem::path> state_root(const std::filesystem::path& root) {
  if (root.empty()) return daemon::default_state_dir();
  return std::filesystem::absolute(root).lexically_normal();
}

Status check_is_mine(const std::filesystem::path& folder) {
  struct stat info {};
  if (::stat(folder.c_str(), &info) != 0) return daemon::system_failure(folder, "cannot be read");
  if (info.st_uid == ::geteuid()) return {};
  return fail(Code::kPermissionDenied,
              fmt::format("{0}: belongs to {1}, whose daemon must be able to use all files in it; "
                          "run this command as that user (sudo -u {1} ...)",
                          folder.string(), user_name(info.st_uid)));
}

Result<State> open_state(const std::filesystem::path& root) {
  State state;
  HP_ASSIGN_OR_RETURN(state.layout.root, state_root(root));
  std::error_code ignored;
  if (!std::filesystem::exists(state.layout.database(), ignored)) {
    return fail(
        Code::kNotFound,
        state.layout.root.string() +
            ": not a state folder of hydroprintd, or not readable by this user; name the right "
            "folder with --state-dir, and run this command as the daemon's user");
  }
  HP_RETURN_IF_ERROR(check_is_mine(state.layout.root));
  HP_RETURN_IF_ERROR(daemon::check_build(state.layout.database()));
  HP_RETURN_IF_ERROR(daemon::check_restored(state.layout));
  auto lock = daemon::lock_state(state.layout);
  if (!lock && lock.error().code != Code::kFailedPrecondition) {
    return tl::unexpected(std::move(lock).error());
  }
  if (lock) state.lock = std::move(*lock);
  HP_ASSIGN_OR_RETURN(state.database, daemon::open_store(state.layout.database()));
  return state;
}

std::string operator_name() {
  const char* const before = std::getenv("SUDO_USER");
  return before != nullptr && *before != '\0' ? before : user_name(::getuid());
}

Status note(daemon::Database& database, const std::string& what, const std::string& object) {
  auth::AuditLog audit(database, daemon::system_clock_ms);
  auth::AuditEntry entry;
  entry.via = "command line";
  entry.what = "hydroprint admin " + what;
  entry.object = object;
  entry.outcome = "OK";
  entry.detail = fmt::format("by {} on the daemon's machine", operator_name());
  audit.note(std::move(entry));
  auth::AuditFilter none;
  none.limit = 1;
  HP_RETURN_IF_ERROR(audit.list(none));  // writes the entry, and fails if it cannot
  return {};
}

}  // namespace hydroprint::admin
