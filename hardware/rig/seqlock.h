#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace hydroprint::rig {

/// A value that one thread writes without waiting and any thread reads consistently: a reader that
/// overlaps with a write repeats the read.
/// All accesses are atomic, with release and acquire ordering and no fences. A writer makes the
/// counter `turn_` odd before it writes the words, and even again afterwards. A reader that sees a
/// word of a newer value therefore also sees the odd counter that was stored before that word. The
/// reader's second load of the counter then differs from its first, so it repeats the read.
template <class T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Only one thread may call this.
  void store(const T& value) {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    // A reader that sees one of these words also sees the odd counter.
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    turn_.store(turn + 2, std::memory_order_release);
  }

  [[nodiscard]] T load() const {
    std::array<std::uint64_t, kWords> words{};
    std::uint64_t before = 0, after = 1;
    while (before != after || before % 2 != 0) {
      before = turn_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      after = turn_.load(std::memory_order_relaxed);
    }
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  std::atomic<std::uint64_t> turn_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace hydroprint::rig
