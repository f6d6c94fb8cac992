#include "daemon/workers/slurm/settings.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "daemon/config/slurm_config.h"
#include "daemon/platform/durable_file.h"
#include "daemon/platform/private_files.h"

namespace hydroprint::daemon::slurm {
namespace {

tl::unexpected<Error> unsafe(const std::filesystem::path& folder, const std::string& fault,
                             const std::string& remedy) {
  return fail(Code::kFailedPrecondition,
              fmt::format("{}: {}, so others could change the job scripts, which run as the "
                          "daemon's user; {}",
                          folder.string(), fault, remedy));
}

// Otherwise anybody could put another folder in the place of the installation's.
Status check_shared_folder(const std::filesystem::path& folder) {
  struct stat info {};
  if (::stat(folder.c_str(), &info) != 0) return system_failure(folder, "cannot be read");
  if ((info.st_mode & S_IWOTH) == 0 || (info.st_mode & S_ISVTX) != 0) return {};
  return unsafe(folder, "all users can replace the folders in it",
                fmt::format("run chmod o-w {0}, or chmod +t {0}", folder.string()));
}

}  // namespace

Status check_installation_folder(const Settings& settings) {
  constexpr const char* kRemedy = "remove it, or choose another workers.slurm.installation";
  constexpr mode_t kPermissions = 0777, kOfOthers = 0077;
  HP_RETURN_IF_ERROR(check_shared_folder(settings.folder));
  const auto folder = installation_folder(settings);
  struct stat info {};
  if (::lstat(folder.c_str(), &info) != 0) {
    return errno == ENOENT ? Status() : system_failure(folder, "cannot be read");
  }
  if (!S_ISDIR(info.st_mode))
    return unsafe(folder, "is not a folder, but a link or a file", kRemedy);
  if (info.st_uid != ::geteuid()) {
    return unsafe(folder, "belongs to " + user_name(info.st_uid), kRemedy);
  }
  if ((info.st_mode & kOfOthers) == 0) return {};
  return unsafe(
      folder,
      fmt::format("other users have rights on it (mode {:04o})", info.st_mode & kPermissions),
      fmt::format("run chmod 0700 {}, or use a file system that keeps modes", folder.string()));
}

Settings settings_of(const Config& config) {
  return {config.slurm_folder,        config.slurm_installation,
          config.slurm_partition,     config.slurm_account,
          slurm_options(config),      static_cast<int>(config.slurm_jobs),
          config.workers_time_limit_s};
}

}  // namespace hydroprint::daemon::slurm
