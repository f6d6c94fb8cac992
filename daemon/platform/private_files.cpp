#include "daemon/platform/private_files.h"

#include <fmt/format.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {
namespace {

constexpr mode_t kPermissions = 0777, kOfOthers = 0077;

Result<mode_t> mode_of(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return system_failure(path, "cannot be read");
  return info.st_mode & kPermissions;
}

}  // namespace

std::string user_name(uid_t id) {
  const passwd* const entry = ::getpwuid(id);
  return entry != nullptr ? entry->pw_name : std::to_string(id);
}

Status check_is_mine(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return system_failure(path, "cannot be read");
  if (info.st_uid == ::geteuid()) return {};
  return fail(Code::kPermissionDenied,
              fmt::format("{0}: belongs to {1}, but the daemon's files must belong to the user who "
                          "runs it; run this command as {1} (sudo -u {1} ...), or change the owner "
                          "(chown -R {2} {0})",
                          path.string(), user_name(info.st_uid), user_name(::geteuid())));
}

Result<std::optional<mode_t>> set_mode(const std::filesystem::path& path, mode_t mode) {
  HP_ASSIGN_OR_RETURN(const mode_t before, mode_of(path));
  if (before == mode) return std::nullopt;
  // Some file systems refuse, others ignore the new mode: only the mode afterwards counts.
  (void)::chmod(path.c_str(), mode);
  HP_ASSIGN_OR_RETURN(const mode_t after, mode_of(path));
  if ((after & kOfOthers) == 0) return after == before ? std::nullopt : std::optional(before);
  return fail(
      Code::kFailedPrecondition,
      fmt::format("{}: other users of this machine have rights on it (mode {:04o}), and the "
                  "file system does not keep the mode {:04o}; mount it with umask=077, or "
                  "move the state folder to a file system with permissions, such as ext4",
                  path.string(), after, mode));
}

Status check_mode(const std::filesystem::path& path, mode_t mode) {
  HP_ASSIGN_OR_RETURN(const mode_t found, mode_of(path));
  if ((found & kOfOthers) == 0) return {};
  return fail(Code::kFailedPrecondition,
              fmt::format("{0}: other users of this machine have rights on it (mode {1:04o}); "
                          "restart the daemon, which corrects the mode, or run chmod {2:o} {0}",
                          path.string(), found, mode));
}

}  // namespace hydroprint::daemon
