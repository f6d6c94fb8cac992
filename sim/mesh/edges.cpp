#include "sim/mesh/edges.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::mesh {
namespace {

struct Keyed {
  int low;
  int high;
  int side;
};

/// Counting sort by one end: stable and linear. A comparison sort would dominate the time for large
/// models.
void sort_by(int Keyed::*end, std::size_t points, std::vector<Keyed>& items,
             std::vector<Keyed>& buffer) {
  std::vector<std::size_t> start(points + 1, 0);
  for (const auto& item : items) ++start[static_cast<std::size_t>(item.*end) + 1];
  for (std::size_t i = 0; i < points; ++i) start[i + 1] += start[i];
  for (const auto& item : items) buffer[start[static_cast<std::size_t>(item.*end)]++] = item;
  items.swap(buffer);
}

}  // namespace

Edges::Edges(const std::vector<Eigen::Vector3i>& triangles, const std::vector<int>& weld) {
  HP_CHECK(triangles.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max() / 3));
  std::vector<Keyed> items(3 * triangles.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto [from, to] = side_ends(static_cast<int>(i), triangles, weld);
    items[i] = {std::min(from, to), std::max(from, to), static_cast<int>(i)};
  }
  std::vector<Keyed> buffer(items.size());
  sort_by(&Keyed::high, weld.size(), items, buffer);
  sort_by(&Keyed::low, weld.size(), items, buffer);

  sides_.reserve(items.size());
  begin_.reserve(items.size() / 2 + 2);
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i == 0 || items[i].low != items[i - 1].low || items[i].high != items[i - 1].high)
      begin_.push_back(i);
    sides_.push_back(items[i].side);
  }
  begin_.push_back(items.size());
}

Groups shells_of(std::size_t count, const Edges& edges) {
  Groups out(count);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (const int side : edges.sides(e))
      out.join(static_cast<std::size_t>(edges.sides(e)[0] / 3), static_cast<std::size_t>(side / 3));
  }
  return out;
}

}  // namespace hydroprint::mesh
