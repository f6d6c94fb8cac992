#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace hydroprint::rig {

/// A value that one thread writes without ever waiting and any thread reads whole: a reader that
/// met the writer half way reads again.
///
/// Every access is atomic, and ordered by release and acquire alone, no fence: a reader that gets a
/// word of a later value acquires with it the odd turn that was stored before it, so its second
/// look at the turn differs from the first, which had acquired all words of its own value.
template <class T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// By one thread only.
  void store(const T& value) {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    // Whoever sees one of these words sees the odd turn, too.
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
