#include "daemon/store/state_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>

namespace hydroprint::daemon {

Result<UniqueFd> lock_state(const Layout& layout) {
  HP_RETURN_IF_ERROR(make_folder(layout.root));
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
