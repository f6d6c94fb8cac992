#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hydroprint::flow {

/// Maps edges to values. An edge is given by the indices of its two ends, in either order. The hash
/// table is one array: with a separate node for each of millions of edges, cache misses would
/// dominate the run time.
template <class T>
class EdgeTable {
 public:
  explicit EdgeTable(std::size_t expected = 0) : slots_(std::bit_ceil(2 * expected + 16)) {}

  /// Returns the value of an edge, or nullptr if it has none; valid until the next set().
  [[nodiscard]] const T* find(int a, int b) const {
    const Slot& slot = slots_[place(key_of(a, b))];
    return slot.key == kNone ? nullptr : &slot.value;
  }

  /// Sets the value of an edge, replacing an earlier one.
  void set(int a, int b, const T& value) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    const std::uint64_t key = key_of(a, b);
    Slot& slot = slots_[place(key)];
    count_ += slot.key == kNone;
    slot = {key, value};
  }

 private:
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  struct Slot {
    std::uint64_t key = kNone;
    T value{};
  };

  static std::uint64_t key_of(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
  }

  /// Returns the slot that holds the key, or the free slot for it.
  [[nodiscard]] std::size_t place(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::uint64_t hash = (key ^ key >> 29) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
    std::size_t at = hash & mask;
    while (slots_[at].key != key && slots_[at].key != kNone) at = (at + 1) & mask;
    return at;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.key != kNone) slots_[place(slot.key)] = slot;
    }
  }

  std::vector<Slot> slots_;  ///< the size is a power of two; at most half of the slots are used
  std::size_t count_ = 0;
};

}  // namespace hydroprint::flow
