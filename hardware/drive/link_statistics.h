#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace hydroprint::drive {

/// Longest times of the buckets of LinkStatistics::replies, in s; the last bucket has no limit.
inline constexpr std::array<double, 8> kReplyLimits_s = {0.001, 0.002, 0.005, 0.01,
                                                         0.02,  0.05,  0.1,   0.2};

/// How the replies of a drive arrive, since the start.
struct LinkStatistics {
  std::uint64_t damaged_replies = 0;      ///< damaged, or of another request
  std::uint64_t unanswered_requests = 0;  ///< without a reply in time
  std::uint64_t retried_reads = 0;        ///< repeated after a bad reply
  /// Valid replies by the time from sending the request to the end of the reply.
  std::array<std::uint64_t, kReplyLimits_s.size() + 1> replies{};
  double reply_time_sum_s = 0;  ///< sum of these times

  [[nodiscard]] bool has_replies() const {
    return std::any_of(replies.begin(), replies.end(), [](std::uint64_t each) { return each > 0; });
  }
};

/// Counts for LinkStatistics. Thread-safe without waiting.
class LinkCounters {
 public:
  void add_damaged(std::uint64_t replies) { damaged_ += replies; }
  void add_unanswered() { ++unanswered_; }
  void add_retry() { ++retried_; }
  void add_reply(std::chrono::nanoseconds time) {
    const double time_s = std::chrono::duration<double>(time).count();
    const auto* bucket = std::lower_bound(kReplyLimits_s.begin(), kReplyLimits_s.end(), time_s);
    ++replies_.at(static_cast<std::size_t>(bucket - kReplyLimits_s.begin()));
    sum_ns_ += static_cast<std::uint64_t>(time.count());
  }

  [[nodiscard]] LinkStatistics read() const {
    LinkStatistics out{damaged_, unanswered_, retried_, {}, 1e-9 * static_cast<double>(sum_ns_)};
    std::copy(replies_.begin(), replies_.end(), out.replies.begin());
    return out;
  }

 private:
  std::atomic<std::uint64_t> damaged_{0}, unanswered_{0}, retried_{0}, sum_ns_{0};
  std::array<std::atomic<std::uint64_t>, kReplyLimits_s.size() + 1> replies_{};
};

}  // namespace hydroprint::drive
