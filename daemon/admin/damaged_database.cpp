#include "daemon/admin/damaged_database.h"

#include "daemon/admin/offline_state.h"
#include "daemon/platform/clock.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/set_aside.h"
#include "daemon/store/state_lock.h"

namespace hydroprint::admin {

Result<std::filesystem::path> set_database_aside(const std::filesystem::path& root) {
  daemon::Layout layout;
  HP_ASSIGN_OR_RETURN(layout.root, state_root(root));
  HP_RETURN_IF_ERROR(check_has_database(layout));
  HP_ASSIGN_OR_RETURN(const auto lock, daemon::lock_state(layout));
  const auto database = layout.database();
  if (daemon::check_build(database)) {
    const Status sound = daemon::Database::check(database);
    if (sound) {
      return fail(
          Code::kFailedPrecondition,
          database.string() +
              ": not damaged, so it was not set aside; to start with an empty state folder, "
              "rename this one");
    }
    if (sound.error().reason == ErrorReason::DISK_FULL) return tl::unexpected(sound.error());
  }
  const auto folder = daemon::new_set_aside(layout, daemon::system_clock_ms());
  HP_RETURN_IF_ERROR(daemon::make_folder(folder));
  // The database comes last: without it, a daemon would create a new one and delete the others.
  for (const char* const tail : {"-wal", "-shm", ""}) {
    const std::filesystem::path from = database.string() + tail;
    std::error_code ignored;
    if (!std::filesystem::exists(from, ignored)) continue;
    HP_RETURN_IF_ERROR(daemon::publish(from, folder / from.filename()));
  }
  HP_RETURN_IF_ERROR(daemon::sync_path(layout.root));
  return folder / database.filename();
}

}  // namespace hydroprint::admin
