#include "sim/waterline/columns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/mesh/edges.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Angle of the grid, whose tangent is the inverse of the golden ratio: far from simple ratios.
constexpr double kTurn_rad = 0.5536;

/// A part of a body that shares no edge with others.
struct Shell {
  bool is_manifold = true;  ///< all edges have two faces
  double volume_mm3 = 0;    ///< negative: a cavity
};

struct Shells {
  std::vector<int> of_triangle;
  std::vector<Shell> all;
};

Shells find_shells(const Body& body) {
  std::vector<int> itself(body.points_mm.size());
  std::iota(itself.begin(), itself.end(), 0);
  const mesh::Edges edges(body.triangles, itself);
  mesh::Groups groups = mesh::shells_of(body.triangles.size(), edges);
  Shells shells;
  shells.of_triangle.resize(body.triangles.size());
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    const std::size_t first = groups.find(t);  // the smallest of its shell
    if (first == t) shells.all.emplace_back();
    const int shell =
        first == t ? static_cast<int>(shells.all.size()) - 1 : shells.of_triangle[first];
    shells.of_triangle[t] = shell;
    const Vector3d origin = body.points_mm[body.triangles[first][0]];
    const Eigen::Vector3i& v = body.triangles[t];
    const Vector3d a = body.points_mm[v[0]] - origin, b = body.points_mm[v[1]] - origin;
    shells.all[shell].volume_mm3 += a.dot(b.cross(body.points_mm[v[2]] - origin)) / 6;
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() == 2) continue;
    shells.all[shells.of_triangle[edges.sides(e)[0] / 3]].is_manifold = false;
  }
  return shells;
}

/// A crossing of a line with a triangle.
struct Crossing {
  std::uint32_t column = 0;
  int shell = 0;
  int rise = 0;  ///< 1: the line enters the body, -1: it leaves it
  double immersion_mm = 0;
};

/// Returns x and z at which the edge from `a` to `b` crosses a row. The same for both directions.
Vector2d cross_row(const std::vector<Vector3d>& points, int a, int b, double row) {
  const auto [low, high] = std::minmax(a, b);
  const Vector3d& p = points[static_cast<std::size_t>(low)];
  const Vector3d& q = points[static_cast<std::size_t>(high)];
  const double s = (row - p.y()) / (q.y() - p.y());
  return {p.x() + s * (q.x() - p.x()), p.z() + s * (q.z() - p.z())};
}

/// Appends the crossings of one triangle. A row includes the lower end of an edge but not the upper
/// one, and a span of a row its left end but not its right one. So a line that passes through an
/// edge or a corner crosses as many triangles as one beside it.
/// @param points  x and y in cells of the grid, z in mm
void cross(const std::vector<Vector3d>& points, const Eigen::Vector3i& t, int shell,
           std::vector<Crossing>& out) {
  const double low = std::min({points[t[0]].y(), points[t[1]].y(), points[t[2]].y()});
  const double high = std::max({points[t[0]].y(), points[t[1]].y(), points[t[2]].y()});
  const int first = std::max(0, static_cast<int>(std::ceil(low - 0.5)));
  for (int row = first; row < Columns::kAcross && row + 0.5 < high; ++row) {
    const double y = row + 0.5;
    // The corners are counter-clockwise as seen from outside. So if the triangle faces up, its left
    // edge leads down.
    std::array<Vector2d, 2> ends;  // of the edge that leads up, and of the one that leads down
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const bool is_below = points[a].y() <= y;
      if (is_below != (points[b].y() <= y)) ends[is_below ? 0 : 1] = cross_row(points, a, b, y);
    }
    const int rise = ends[0].x() < ends[1].x() ? 1 : -1;
    if (rise < 0) std::swap(ends[0], ends[1]);
    const int from = std::max(0, static_cast<int>(std::ceil(ends[0].x() - 0.5)));
    for (int i = from; i < Columns::kAcross && i + 0.5 < ends[1].x(); ++i) {
      const double s = (i + 0.5 - ends[0].x()) / (ends[1].x() - ends[0].x());
      out.push_back({static_cast<std::uint32_t>(row * Columns::kAcross + i), shell, rise,
                     ends[0].y() + s * (ends[1].y() - ends[0].y())});
    }
  }
}

/// A change of the number of solids around a point of a line, at an immersion.
using Step = std::pair<double, int>;

/// Appends where a line enters and leaves one shell. The crossings are sorted.
void append_steps(std::span<const Crossing> crossings, const Shell& shell,
                  std::vector<Step>& steps) {
  const bool is_cavity = shell.is_manifold && shell.volume_mm3 < 0;
  int sum = 0;
  bool was_inside = false;
  for (const Crossing& crossing : crossings) {
    sum += is_cavity ? -crossing.rise : crossing.rise;
    const bool is_inside = shell.is_manifold ? sum > 0 : !was_inside;
    if (is_inside != was_inside) {
      steps.emplace_back(crossing.immersion_mm, is_inside != is_cavity ? 1 : -1);
    }
    was_inside = is_inside;
  }
  if (was_inside) steps.pop_back();  // an opening: entered but not left
}

/// Appends the spans of one line. The crossings are sorted by shell and immersion.
void append_spans(std::span<const Crossing> crossings, const std::vector<Shell>& shells,
                  std::vector<Columns::Span>& out) {
  std::vector<Step> steps;
  for (auto from = crossings.begin(); from != crossings.end();) {
    const int shell = from->shell;
    const auto to =
        std::find_if(from, crossings.end(), [&](const Crossing& c) { return c.shell != shell; });
    append_steps({from, to}, shells[shell], steps);
    from = to;
  }
  std::ranges::stable_sort(steps, {}, &Step::first);
  int inside = 0;
  double from_mm = 0;
  for (const auto& [immersion_mm, rise] : steps) {
    const int before = inside;
    inside += rise;
    if (before <= 0 && inside > 0) from_mm = immersion_mm;
    if (before > 0 && inside <= 0) out.push_back({from_mm, immersion_mm});
  }
}

}  // namespace

Columns::Columns(const Body& body) {
  const Eigen::Rotation2Dd turn(kTurn_rad);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3i& t : body.triangles) {
    for (const int v : t) box.extend(turn * body.points_mm[v].head<2>());
  }
  middle_mm_ = box.center();
  cell_mm_ = box.sizes().maxCoeff() / kAcross;
  const Vector2d corner_mm = middle_mm_ - Vector2d::Constant(0.5 * kAcross * cell_mm_);
  std::vector<Vector3d> seen;
  seen.reserve(body.points_mm.size());
  for (const Vector3d& p : body.points_mm) {
    const Vector2d cells = (turn * p.head<2>() - corner_mm) / cell_mm_;
    seen.emplace_back(cells.x(), cells.y(), p.z());
  }
  std::vector<Crossing> crossings;
  const Shells shells = find_shells(body);
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    cross(seen, body.triangles[t], shells.of_triangle[t], crossings);
  }
  std::ranges::sort(crossings, [](const Crossing& a, const Crossing& b) {
    return std::tie(a.column, a.shell, a.immersion_mm) <
           std::tie(b.column, b.shell, b.immersion_mm);
  });
  start_.reserve(std::size_t{kAcross} * kAcross + 1);
  auto from = crossings.begin();
  for (std::uint32_t column = 0; column < kAcross * kAcross; ++column) {
    start_.push_back(spans_.size());
    const auto to =
        std::find_if(from, crossings.end(), [&](const Crossing& c) { return c.column != column; });
    append_spans({from, to}, shells.all, spans_);
    from = to;
  }
  start_.push_back(spans_.size());
}

Eigen::Vector2d Columns::place_mm(std::size_t column) const {
  const Vector2d cells(static_cast<double>(column % kAcross),
                       static_cast<double>(column / kAcross));
  const Vector2d seen = middle_mm_ + cell_mm_ * (cells + Vector2d::Constant(0.5 * (1 - kAcross)));
  return Eigen::Rotation2Dd(-kTurn_rad) * seen;
}

}  // namespace hydroprint::waterline
