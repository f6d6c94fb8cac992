#include "sim/mesh/subdivide.h"

#include <fmt/format.h>

#include <cstdint>
#include <unordered_map>

#include "sim/base/check.h"
#include "sim/mesh/edges.h"

namespace hydroprint::mesh {
namespace {

/// A corner of a new triangle.
struct Corner {
  int point = 0;
  Eigen::Vector3f barycentric;
};

class Pass {
 public:
  Pass(Patchwork& work, double max_edge_mm) : work_(work), max_edge_mm_(max_edge_mm) {}

  /// Finds the edges to cut and returns the number of triangles after the pass.
  std::size_t plan() {
    std::size_t cuts = 0;
    for (int side = 0; side < static_cast<int>(3 * work_.triangles.size()); ++side)
      if (is_long(side)) ++cuts;
    return work_.triangles.size() + cuts;  // each cut side adds one triangle
  }

  void run(std::size_t count) {
    Patchwork out;
    out.triangles.reserve(count);
    out.source_triangle.reserve(count);
    out.source_barycentric.reserve(count);
    for (std::size_t t = 0; t < work_.triangles.size(); ++t) split(t, out);
    work_.triangles.swap(out.triangles);
    work_.source_triangle.swap(out.source_triangle);
    work_.source_barycentric.swap(out.source_barycentric);
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& point(int i) const {
    return work_.points[static_cast<std::size_t>(i)];
  }

  [[nodiscard]] bool is_long(int side) const {
    const auto [from, to] = side_ends(side, work_.triangles, work_.weld);
    return (point(to) - point(from)).norm() > max_edge_mm_;
  }

  int midpoint(int side) {
    const auto [from, to] = side_ends(side, work_.triangles, work_.weld);
    const auto low = static_cast<std::uint64_t>(std::min(from, to));
    const auto high = static_cast<std::uint64_t>(std::max(from, to));
    const auto [entry, is_new] =
        midpoints_.try_emplace(low << 32 | high, static_cast<int>(work_.points.size()));
    if (is_new) {
      const Eigen::Vector3d middle = (point(from) + point(to)) / 2;
      work_.weld.push_back(entry->second);
      work_.points.push_back(middle);
    }
    return entry->second;
  }

  void split(std::size_t t, Patchwork& out) {
    const Eigen::Vector3i triangle = work_.triangles[t];
    const auto barycentric = work_.source_barycentric[t];
    std::array<Corner, 3> corner;
    std::array<bool, 3> cut{};
    int cuts = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = {triangle[static_cast<int>(k)], barycentric[k]};
      cut[k] = is_long(static_cast<int>(3 * t + k));
      cuts += cut[k] ? 1 : 0;
    }
    const auto middle = [&](std::size_t k) -> Corner {
      return {midpoint(static_cast<int>(3 * t + k)),
              (barycentric[k] + barycentric[(k + 1) % 3]) / 2};
    };
    const auto emit = [&](const Corner& a, const Corner& b, const Corner& c) {
      out.triangles.emplace_back(a.point, b.point, c.point);
      out.source_triangle.push_back(work_.source_triangle[t]);
      out.source_barycentric.push_back({a.barycentric, b.barycentric, c.barycentric});
    };
    if (cuts == 0) return emit(corner[0], corner[1], corner[2]);
    if (cuts == 3) {
      const std::array m = {middle(0), middle(1), middle(2)};
      for (std::size_t k = 0; k < 3; ++k) emit(corner[k], m[k], m[(k + 2) % 3]);
      return emit(m[0], m[1], m[2]);
    }
    // Rotates the corners so that side 0 (and side 1, if two are cut) is cut.
    std::size_t s = 0;
    while (!cut[s] || (cuts == 2 && !cut[(s + 1) % 3])) ++s;
    const auto& a = corner[s];
    const auto& b = corner[(s + 1) % 3];
    const auto& c = corner[(s + 2) % 3];
    const Corner ab = middle(s);
    if (cuts == 1) {
      emit(a, ab, c);
      return emit(ab, b, c);
    }
    const Corner bc = middle((s + 1) % 3);
    emit(ab, b, bc);
    const double through_a = (point(bc.point) - point(a.point)).norm();
    const double through_c = (point(ab.point) - point(c.point)).norm();
    if (through_a <= through_c) {
      emit(a, ab, bc);
      return emit(a, bc, c);
    }
    emit(a, ab, c);
    emit(ab, bc, c);
  }

  Patchwork& work_;
  double max_edge_mm_;
  std::unordered_map<std::uint64_t, int> midpoints_;
};

}  // namespace

Result<Patchwork> subdivide(Patchwork input, double max_edge_mm, std::size_t max_triangles,
                            const Context& context) {
  HP_CHECK(max_edge_mm > 0);
  HP_CHECK(input.weld.size() == input.points.size());
  HP_CHECK(input.source_triangle.size() == input.triangles.size());
  HP_CHECK(input.source_barycentric.size() == input.triangles.size());
  Patchwork work = std::move(input);
  while (true) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    Pass pass(work, max_edge_mm);
    const std::size_t count = pass.plan();
    if (count == work.triangles.size()) return work;
    if (count > max_triangles)
      return fail(Code::kResourceExhausted, fmt::format("more than {} triangles", max_triangles));
    pass.run(count);
  }
}

}  // namespace hydroprint::mesh
