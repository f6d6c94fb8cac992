#include "sim/overlay/grid_lines.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hydroprint::overlay {
namespace {

constexpr double kUnits_per_mm = 1e6;

__extension__ typedef __int128 Int128;  // NOLINT(modernize-use-using): -Wpedantic

/// A point at which a line is split.
struct Split {
  int line;
  GridPoint at;
};

Int128 cross(const GridPoint& from, const GridPoint& p, const GridPoint& q) {
  return static_cast<Int128>(p.x - from.x) * (q.y - from.y) -
         static_cast<Int128>(p.y - from.y) * (q.x - from.x);
}

Int128 absolute(Int128 value) { return value < 0 ? -value : value; }

/// Returns true if the line runs through the square of the grid around the point, and does not
/// end at the point.
bool runs_through(const GridLine& line, const GridPoint& p) {
  const auto [low, high] = std::minmax(line.a.y, line.b.y);
  if (p.x < line.a.x || p.x > line.b.x || p.y < low || p.y > high) return false;
  if (p == line.a || p == line.b) return false;
  return 2 * absolute(cross(line.a, line.b, p)) <= (line.b.x - line.a.x) + (high - low);
}

bool cross_each_other(const GridLine& l, const GridLine& m) {
  return turn(l.a, l.b, m.a) * turn(l.a, l.b, m.b) < 0 &&
         turn(m.a, m.b, l.a) * turn(m.a, m.b, l.b) < 0;
}

GridPoint crossing(const GridLine& l, const GridLine& m) {
  const auto before = static_cast<long double>(cross(m.a, m.b, l.a));
  const auto after = static_cast<long double>(cross(m.a, m.b, l.b));
  const long double t = before / (before - after);
  return {l.a.x + std::llround(t * static_cast<long double>(l.b.x - l.a.x)),
          l.a.y + std::llround(t * static_cast<long double>(l.b.y - l.a.y))};
}

void find_splits(const std::vector<GridLine>& lines, int i, int j, std::vector<Split>& splits) {
  const GridLine& l = lines[i];
  const GridLine& m = lines[j];
  bool touch = false;
  const auto split_at = [&](const GridLine& line, int index, const GridPoint& p) {
    if (!runs_through(line, p)) return;
    splits.push_back({index, p});
    touch = true;
  };
  split_at(l, i, m.a);
  split_at(l, i, m.b);
  split_at(m, j, l.a);
  split_at(m, j, l.b);
  if (touch || !cross_each_other(l, m)) return;
  // At an end point of one of the lines after rounding, the crossing only splits the other.
  const GridPoint at = crossing(l, m);
  if (at != l.a && at != l.b) splits.push_back({i, at});
  if (at != m.a && at != m.b) splits.push_back({j, at});
}

std::vector<Split> find_splits(const std::vector<GridLine>& lines) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 2, int>;
  std::vector<Box> boxes;
  boxes.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto [low, high] = std::minmax(lines[i].a.y, lines[i].b.y);
    boxes.emplace_back(CGAL::Bbox_2(static_cast<double>(lines[i].a.x), static_cast<double>(low),
                                    static_cast<double>(lines[i].b.x), static_cast<double>(high)),
                       static_cast<int>(i));
  }
  std::vector<Split> splits;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
    find_splits(lines, x.info(), y.info(), splits);
  });
  return splits;
}

/// Replaces each split line by its pieces.
void apply(std::vector<Split> splits, std::vector<GridLine>& lines) {
  const auto along = [&](const Split& s) -> Int128 {
    const GridLine& line = lines[s.line];
    return static_cast<Int128>(s.at.x - line.a.x) * (line.b.x - line.a.x) +
           static_cast<Int128>(s.at.y - line.a.y) * (line.b.y - line.a.y);
  };
  std::sort(splits.begin(), splits.end(), [&](const Split& s, const Split& t) {
    return s.line != t.line ? s.line < t.line
                            : std::tuple(along(s), s.at) < std::tuple(along(t), t.at);
  });
  for (std::size_t i = 0; i < splits.size();) {
    const int index = splits[i].line;
    const GridLine whole = lines[index];
    const auto add_piece = [&](const GridPoint& from, const GridPoint& to) {
      if (from == to) return;
      const bool is_turned = to < from;
      GridLine piece = {is_turned ? to : from, is_turned ? from : to, whole.passes};
      for (int& passes : piece.passes) passes = is_turned ? -passes : passes;
      lines.push_back(piece);
    };
    GridPoint from = whole.a;
    for (; i < splits.size() && splits[i].line == index; ++i) {
      add_piece(from, splits[i].at);
      from = splits[i].at;
    }
    add_piece(from, whole.b);
    lines[index].passes = {0, 0};
  }
}

/// Sorts the lines, adds up equal ones, and removes those without passes.
void add_up(std::vector<GridLine>& lines) {
  std::sort(lines.begin(), lines.end(), [](const GridLine& l, const GridLine& m) {
    return std::tie(l.a, l.b) < std::tie(m.a, m.b);
  });
  std::size_t size = 0;
  for (std::size_t i = 0; i < lines.size();) {
    GridLine sum = lines[i++];
    for (; i < lines.size() && lines[i].a == sum.a && lines[i].b == sum.b; ++i) {
      for (int group : {0, 1}) sum.passes[group] += lines[i].passes[group];
    }
    if (sum.passes != std::array<int, 2>{0, 0}) lines[size++] = sum;
  }
  lines.resize(size);
}

}  // namespace

GridPoint to_grid(const Eigen::Vector2d& p) {
  return {std::llround(p.x() * kUnits_per_mm), std::llround(p.y() * kUnits_per_mm)};
}

Eigen::Vector2d to_mm(const GridPoint& p) {
  return {static_cast<double>(p.x) / kUnits_per_mm, static_cast<double>(p.y) / kUnits_per_mm};
}

int turn(const GridPoint& p, const GridPoint& q, const GridPoint& r) {
  const Int128 area = cross(p, q, r);
  return (area > 0 ? 1 : 0) - (area < 0 ? 1 : 0);
}

void add_line(std::vector<GridLine>& lines, const GridPoint& from, const GridPoint& to, int group) {
  if (from == to) return;
  GridLine line = from < to ? GridLine{from, to} : GridLine{to, from};
  line.passes[group] = from < to ? 1 : -1;
  lines.push_back(line);
}

std::vector<GridLine> split_at_meetings(std::vector<GridLine> lines) {
  add_up(lines);
  // Rounding may let pieces meet again. This ends, because each piece is shorter than its line.
  while (true) {
    std::vector<Split> splits = find_splits(lines);
    if (splits.empty()) return lines;
    apply(std::move(splits), lines);
    add_up(lines);
  }
}

}  // namespace hydroprint::overlay
