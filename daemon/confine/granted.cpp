#include "daemon/confine/granted.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "daemon/confine/landlock.h"

namespace hydroprint::confine {
namespace {

template <class Resource>
std::string limit_text(Resource resource) {
  rlimit limits{};
  const bool is_limited = getrlimit(resource, &limits) == 0 && limits.rlim_cur != RLIM_INFINITY;
  return is_limited ? fmt::format("{}", limits.rlim_cur) : "null";
}

}  // namespace

std::string granted_json(bool is_confined) {
  return fmt::format(
      "{{\"seccomp\":{},\"landlock_version\":{},\"limits\":{{\"data_bytes\":{},\"cpu_s\":{},"
      "\"file_bytes\":{},\"open_files\":{}}}}}\n",
      is_confined, is_confined ? landlock_version() : 0, limit_text(RLIMIT_DATA),
      limit_text(RLIMIT_CPU), limit_text(RLIMIT_FSIZE), limit_text(RLIMIT_NOFILE));
}

}  // namespace hydroprint::confine
