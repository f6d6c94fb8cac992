#include "daemon/store/quota.h"

#include <fmt/format.h>

#include <algorithm>

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kMebibyte = 1 << 20;

tl::unexpected<Error> over_quota(const char* quota, std::int64_t used, std::int64_t allowed,
                                 const std::string& words) {
  auto error = fail(Code::kResourceExhausted, words, ErrorReason::QUOTA_EXCEEDED);
  error.value().metadata = {
      {"quota", quota}, {"used", fmt::to_string(used)}, {"allowed", fmt::to_string(allowed)}};
  return error;
}

tl::unexpected<Error> too_many_bytes(const std::string& owner, const Usage& usage,
                                     std::int64_t allowed, std::int64_t more_bytes) {
  // Rounds up, so that a quota that is used up never looks as if space were left.
  const auto mebibytes = [](std::int64_t bytes) { return (bytes + kMebibyte - 1) / kMebibyte; };
  std::string words = fmt::format("{} uses {} of {} MiB", owner, mebibytes(usage.stored_bytes),
                                  allowed / kMebibyte);
  if (usage.pinned_bytes > 0) {
    words += fmt::format(" ({} by pinned jobs)", mebibytes(usage.pinned_bytes));
  }
  if (more_bytes > 0)
    words += fmt::format(", and the new file needs {} MiB more", mebibytes(more_bytes));
  return over_quota("bytes", usage.stored_bytes, allowed,
                    words +
                        "; delete jobs (hydroprint list --mine, hydroprint delete) or files "
                        "(hydroprint assets list, hydroprint assets delete)");
}

}  // namespace

Result<Usage> usage_of(Database& database, const std::string& owner) {
  Usage usage;
  HP_RETURN_IF_ERROR(database.each(
      "SELECT (SELECT count(*) FROM jobs WHERE +owner=?1 AND state=1), "
      "coalesce((SELECT bytes FROM artifact_bytes WHERE owner=?1),0) + "
      "(SELECT coalesce(sum(size),0) FROM asset_owners JOIN assets USING(sha256) WHERE owner=?1) + "
      "(SELECT coalesce(sum(size),0) FROM uploads WHERE owner=?1), "
      "coalesce((SELECT pinned FROM artifact_bytes WHERE owner=?1),0)",
      {owner}, [&](const DbRow& row) {
        usage = {row.integer(0), row.integer(1), row.integer(2)};
      }));
  return usage;
}

Status check_job_quota(Database& database, const std::string& owner, const Quota& quota,
                       bool is_queued) {
  HP_ASSIGN_OR_RETURN(const Usage usage, usage_of(database, owner));
  const std::int64_t jobs = quota.max_queued_jobs, bytes = quota.max_stored_bytes;
  if (is_queued && jobs > 0 && usage.queued_jobs >= jobs) {
    return over_quota("jobs", usage.queued_jobs, jobs,
                      fmt::format("{} has {} of {} jobs in the queue; wait until some have "
                                  "finished, or cancel some (hydroprint cancel JOB)",
                                  owner, usage.queued_jobs, jobs));
  }
  if (bytes == 0 || usage.stored_bytes < bytes) return {};
  return too_many_bytes(owner, usage, bytes, 0);
}

Status check_byte_quota(Database& database, const std::string& owner, const Quota& quota,
                        std::int64_t more_bytes) {
  const std::int64_t allowed = quota.max_stored_bytes;
  if (allowed == 0) return {};
  HP_ASSIGN_OR_RETURN(const Usage usage, usage_of(database, owner));
  if (more_bytes <= allowed - std::min(usage.stored_bytes, allowed)) return {};
  return too_many_bytes(owner, usage, allowed, more_bytes);
}

}  // namespace hydroprint::daemon
