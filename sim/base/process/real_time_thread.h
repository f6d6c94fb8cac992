#pragma once

#include <cstddef>
#include <cstdint>

namespace hydroprint {

/// How the system schedules a thread.
enum class Scheduling : std::uint8_t {
  kUnknown,   ///< the thread has not requested anything yet
  kRealTime,  ///< SCHED_FIFO: the thread runs before all ordinary threads
  kRaised,    ///< a negative nice value
  kNormal,    ///< neither
};

/// What the system has granted to a thread.
struct ThreadPriority {
  Scheduling scheduling = Scheduling::kUnknown;
  bool memory_locked = false;  ///< the requested memory cannot be swapped out
};

/// Requests SCHED_FIFO for the calling thread or, if the system refuses that, the lowest nice value
/// that it grants. Threads and processes that this thread starts inherit neither. Also locks the
/// next 64 KiB of the thread's stack; `memory_locked` tells whether the system permitted it.
/// A thread that calls this must sleep regularly, because it can occupy a processor completely.
/// @param fifo_priority  1 to 99; a thread of a greater priority runs first
[[nodiscard]] ThreadPriority become_real_time(int fifo_priority);

/// Loads the pages of a range of memory and locks them, so that no access to them waits for a disk.
/// They stay locked until they are unmapped; child processes do not inherit the lock. Returns false
/// if the system refuses it (RLIMIT_MEMLOCK).
[[nodiscard]] bool lock_memory(const void* start, std::size_t bytes);

}  // namespace hydroprint
