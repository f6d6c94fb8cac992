#include "sim/mesh/coincident.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "sim/mesh/edges.h"
#include "sim/mesh/groups.h"

namespace hydroprint::mesh {
namespace {

/// A face as its three welded points in ascending order, and which way round they are.
struct Face {
  std::array<int, 3> points{};
  bool is_even = false;  ///< the face's own order is an even permutation of `points`
};

Face face_of(const Eigen::Vector3i& triangle, const std::vector<int>& weld) {
  Face out;
  for (int k = 0; k < 3; ++k)
    out.points[static_cast<std::size_t>(k)] = weld[static_cast<std::size_t>(triangle[k])];
  const auto first = std::min_element(out.points.begin(), out.points.end());
  std::rotate(out.points.begin(), first, out.points.end());
  out.is_even = out.points[1] < out.points[2];
  if (!out.is_even) std::swap(out.points[1], out.points[2]);
  return out;
}

/// One face of each set of coincident ones, in their order.
struct Merged {
  std::vector<int> triangle;      ///< index of the first face of the set
  std::vector<char> both_ways;    ///< 1 if the set has faces both ways round
  std::vector<std::size_t> size;  ///< number of faces in the set
};

Merged merge(const std::vector<Eigen::Vector3i>& triangles, const std::vector<int>& weld) {
  std::vector<Face> faces;
  faces.reserve(triangles.size());
  for (const auto& triangle : triangles) faces.push_back(face_of(triangle, weld));
  std::vector<int> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto points = [&](int t) { return faces[static_cast<std::size_t>(t)].points; };
  std::ranges::stable_sort(order, {}, points);
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i == 0 || points(order[i]) != points(order[i - 1])) starts.push_back(i);
  const auto first_of = [&](std::size_t start) { return order[start]; };
  starts.push_back(order.size());
  std::vector<std::size_t> sets(starts.size() - 1);
  std::iota(sets.begin(), sets.end(), std::size_t{0});
  std::ranges::sort(sets, {}, [&](std::size_t s) { return first_of(starts[s]); });
  Merged out;
  for (const std::size_t s : sets) {
    const int first = first_of(starts[s]);
    bool both = false;
    for (std::size_t i = starts[s]; i < starts[s + 1]; ++i)
      both = both || faces[static_cast<std::size_t>(order[i])].is_even !=
                         faces[static_cast<std::size_t>(first)].is_even;
    out.triangle.push_back(first);
    out.both_ways.push_back(both ? 1 : 0);
    out.size.push_back(starts[s + 1] - starts[s]);
  }
  return out;
}

/// Finds the faces that divide two parts which touch.
class WallFinder {
 public:
  WallFinder(const std::vector<Eigen::Vector3i>& triangles, const std::vector<int>& weld,
             const std::vector<char>& both_ways)
      : edges_(triangles, weld),
        both_ways_(both_ways),
        groups_(triangles.size()),
        crossing_(triangles.size()) {}

  /// Returns 1 for each face of a wall.
  std::vector<char> run() {
    join();
    std::vector<char> has_rim(both_ways_.size(), 0), fails(both_ways_.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) look_at(e, has_rim, fails);
    std::vector<char> out(both_ways_.size(), 0);
    for (std::size_t t = 0; t < out.size(); ++t) {
      const std::size_t group = groups_.find(t);
      const bool is_wall = has_rim[crossing_.find(t)] != 0 && fails[group] == 0;
      out[t] = both_ways_[t] != 0 && is_wall ? 1 : 0;
    }
    return out;
  }

 private:
  [[nodiscard]] std::size_t count_plain(std::size_t e) const {
    const auto sides = edges_.sides(e);
    return static_cast<std::size_t>(std::ranges::count_if(
        sides, [&](int side) { return both_ways_[static_cast<std::size_t>(side / 3)] == 0; }));
  }

  /// Joins faces given both ways round that continue each other, or cross.
  void join() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto sides = edges_.sides(e);
      if (count_plain(e) != 0) continue;
      const auto first = static_cast<std::size_t>(sides[0] / 3);
      for (const int side : sides) {
        const auto t = static_cast<std::size_t>(side / 3);
        if (sides.size() == 2) groups_.join(first, t);
        crossing_.join(first, t);
      }
    }
  }

  /// Notes for the walls at an edge whether it can be part of their rim.
  void look_at(std::size_t e, std::vector<char>& has_rim, std::vector<char>& fails) {
    const auto sides = edges_.sides(e);
    const std::size_t plain = count_plain(e), walls = sides.size() - plain;
    const bool is_inside = plain == 0 && walls == 2;
    if (walls == 0 || is_inside) return;
    const bool is_crossing = plain == 0 && walls > 2;
    for (const int side : sides) {
      const auto t = static_cast<std::size_t>(side / 3);
      if (both_ways_[t] == 0) continue;
      if (plain > 0 && plain % 2 == 0) has_rim[crossing_.find(t)] = 1;
      if (plain % 2 != 0 || (plain == 0 && !is_crossing)) fails[groups_.find(t)] = 1;
    }
  }

  Edges edges_;
  const std::vector<char>& both_ways_;
  Groups groups_;    ///< walls that continue each other
  Groups crossing_;  ///< walls that continue each other or cross
};

}  // namespace

DistinctFaces merge_coincident(const std::vector<Eigen::Vector3i>& triangles,
                               const std::vector<int>& weld) {
  const Merged merged = merge(triangles, weld);
  DistinctFaces out;
  if (merged.triangle.size() == triangles.size()) {
    out.kept = merged.triangle;
    return out;
  }
  std::vector<Eigen::Vector3i> faces;
  for (const int t : merged.triangle) faces.push_back(triangles[static_cast<std::size_t>(t)]);
  const std::vector<char> is_wall = WallFinder(faces, weld, merged.both_ways).run();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (is_wall[i] != 0) {
      out.walls += merged.size[i];
    } else {
      out.kept.push_back(merged.triangle[i]);
      out.copies += merged.size[i] - 1;
    }
  }
  return out;
}

}  // namespace hydroprint::mesh
