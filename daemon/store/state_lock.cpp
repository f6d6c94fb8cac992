#include "daemon/store/state_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>

#include "daemon/platform/log.h"
#include "daemon/platform/private_files.h"

namespace hydroprint::daemon {

Result<UniqueFd> lock_state(const Layout& layout) {
  HP_RETURN_IF_ERROR(make_folder(layout.root));
  HP_RETURN_IF_ERROR(check_is_mine(layout.root));
  HP_ASSIGN_OR_RETURN(UniqueFd file, open_file(layout.lock(), O_RDWR | O_CREAT));
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    std::string holder = "?";
    std::ifstream(layout.lock()) >> holder;
    return fail(Code::kFailedPrecondition, layout.root.string() +
                                               ": another hydroprintd (process " + holder +
                                               ") uses this state folder; stop that process or "
                                               "choose another folder with --state-dir");
  }
  const std::string pid = fmt::format("{}\n", ::getpid());
  if (::ftruncate(file.get(), 0) != 0) return system_failure(layout.lock(), "cannot be written");
  HP_RETURN_IF_ERROR(write_at(file, layout.lock(), pid, 0));
  return file;
}

std::vector<PrivatePath> private_paths(const Layout& layout) {
  std::vector<PrivatePath> all{{layout.root, 0700}, {layout.lock(), 0600}};
  for (const char* const tail : {"", "-wal", "-shm"}) {
    all.push_back({layout.database().string() + tail, 0600});
  }
  for (const auto& folder : {layout.assets(), layout.uploads(), layout.runs(), layout.restoring(),
                             layout.set_aside(), layout.dips(), layout.artifacts()}) {
    all.push_back({folder, 0700});
  }
  std::error_code ignored;
  std::erase_if(
      all, [&](const PrivatePath& each) { return !std::filesystem::exists(each.path, ignored); });
  return all;
}

Status correct_modes(const Layout& layout) {
  for (const PrivatePath& each : private_paths(layout)) {
    HP_RETURN_IF_ERROR(check_is_mine(each.path));
    HP_ASSIGN_OR_RETURN(const auto before, set_mode(each.path, each.mode));
    if (!before) continue;
    log(LogLevel::kWarning, "mode_corrected",
        {{"path", each.path.string()},
         {"before", fmt::format("{:04o}", *before)},
         {"now", fmt::format("{:04o}", each.mode)},
         {"message",
          "other users of this machine may have read or changed this; if nobody changed the mode "
          "on purpose, look for the program that did"}});
  }
  return {};
}

Status check_restored(const Layout& layout) {
  std::error_code ignored;
  if (!std::filesystem::exists(layout.unrestored(), ignored)) return {};
  return fail(Code::kFailedPrecondition,
              layout.root.string() +
                  ": the restore of a backup into this folder was not finished; run hydroprint "
                  "admin restore again",
              ErrorReason::RESTORE_UNFINISHED);
}

}  // namespace hydroprint::daemon
