#include "daemon/workers/program_digest.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {

Result<std::string> ProgramDigest::get() {
  const std::lock_guard lock(mutex_);
  struct stat info {};
  if (::stat(path_.c_str(), &info) != 0) {
    return fail(Code::kInternal,
                path_.string() + ": the worker program does not exist; check workers.program",
                "WORKER_UNUSABLE");
  }
  const std::string stamp = fmt::format("{} {} {}.{}", info.st_ino, info.st_size,
                                        info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
  if (stamp != stamp_) {
    HP_ASSIGN_OR_RETURN(digest_, sha256_of_file(path_));
    stamp_ = stamp;
  }
  return digest_;
}

}  // namespace hydroprint::daemon
