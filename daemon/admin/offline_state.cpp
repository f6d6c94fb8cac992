#include "daemon/admin/offline_state.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "daemon/auth/audit_log.h"
#include "daemon/config/config.h"
#include "daemon/platform/private_files.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/state_lock.h"

namespace hydroprint::admin {

Result<std::filesystem::path> state_root(const std::filesystem::path& root) {
  if (root.empty()) return daemon::default_state_dir();
  return std::filesystem::absolute(root).lexically_normal();
}

Status check_has_database(const daemon::Layout& layout) {
  std::error_code ignored;
  if (std::filesystem::exists(layout.database(), ignored)) return {};
  return fail(
      Code::kNotFound,
      layout.root.string() +
          ": not a state folder of hydroprintd, or not readable by this user; name the right "
          "folder with --state-dir, and run this command as the daemon's user");
}

Result<State> open_state(const std::filesystem::path& root) {
  State state;
  HP_ASSIGN_OR_RETURN(state.layout.root, state_root(root));
  HP_RETURN_IF_ERROR(check_has_database(state.layout));
  HP_RETURN_IF_ERROR(daemon::check_is_mine(state.layout.root));
  HP_RETURN_IF_ERROR(daemon::check_build(state.layout.database()));
  HP_RETURN_IF_ERROR(daemon::check_restored(state.layout));
  auto lock = daemon::lock_state(state.layout);
  if (!lock && lock.error().code != Code::kFailedPrecondition) {
    return tl::unexpected(std::move(lock).error());
  }
  if (lock) state.lock = std::move(*lock);
  const auto path = state.layout.database();
  // A daemon that runs has checked the database.
  HP_ASSIGN_OR_RETURN(state.database, state.daemon_runs() ? daemon::Database::open(path, "")
                                                          : daemon::open_store(path));
  return state;
}

std::string operator_name() {
  const char* const before = std::getenv("SUDO_USER");
  return before != nullptr && *before != '\0' ? before : daemon::user_name(::getuid());
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
