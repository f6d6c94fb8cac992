#include "sim/overlay/disjoint_curves.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

namespace hydroprint::overlay {
namespace {

constexpr int kNoCurve = -1;

/// A simple closed curve.
struct Curve {
  std::vector<int> points;  ///< indices of points, counter-clockwise
  int turns = 0;            ///< 1 if it was given counter-clockwise, -1 if clockwise
  int winding_outside = 0;
  int outline_outside = kNoCurve;  ///< innermost outline around it
  int outline_inside = kNoCurve;   ///< innermost outline around its inside
};

/// The lines of curves, and how they hang together.
struct Network {
  std::vector<GridPoint> points;             ///< sorted
  std::vector<std::array<int, 2>> lines_at;  ///< the two lines at each point
  std::vector<std::array<int, 2>> ends;      ///< the points a and b of each line
};

/// @return nullopt if a line does not count once, or if a point has more than two lines
std::optional<Network> network_of(const std::vector<GridLine>& lines) {
  struct End {
    GridPoint point;
    int line, end;
  };
  std::vector<End> ends;
  ends.reserve(2 * lines.size());
  for (int l = 0; l < static_cast<int>(lines.size()); ++l) {
    if (std::abs(lines[l].passes[0]) != 1 || lines[l].passes[1] != 0) return std::nullopt;
    ends.push_back({lines[l].a, l, 0});
    ends.push_back({lines[l].b, l, 1});
  }
  std::sort(ends.begin(), ends.end(), [](const End& x, const End& y) {
    return std::tie(x.point, x.line) < std::tie(y.point, y.line);
  });
  Network network;
  network.ends.resize(lines.size());
  // As many curves arrive at a point as leave it, so its number of lines is even.
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
    if (i + 2 < ends.size() && ends[i + 1].point == ends[i + 2].point) return std::nullopt;
    const int point = static_cast<int>(network.points.size());
    network.points.push_back(ends[i].point);
    network.lines_at.push_back({ends[i].line, ends[i + 1].line});
    for (const End& end : {ends[i], ends[i + 1]}) network.ends[end.line][end.end] = point;
  }
  return network;
}

/// Sweeps over the plane by increasing x, then y. Each curve begins at its first point, where the
/// next line below it tells in which region it lies.
class Sweep {
 public:
  Sweep(const std::vector<GridLine>& lines, const Network& network)
      : lines_(lines),
        network_(network),
        curve_of_(lines.size(), kNoCurve),
        active_([this](int l, int m) { return is_below(l, m); }),
        place_(lines.size(), active_.end()) {}

  Region region() {
    Region region;
    region.overlay.points = network_.points;
    for (int p = 0; p < static_cast<int>(network_.points.size()); ++p) {
      const auto [l, m] = network_.lines_at[p];
      for (const int line : {l, m}) {
        if (network_.ends[line][1] == p) active_.erase(place_[line]);
      }
      for (const int line : {l, m}) {
        if (network_.ends[line][0] == p) place_[line] = active_.insert(line).first;
      }
      if (curve_of_[l] == kNoCurve) begin_curve(is_below(l, m) ? l : m, p, region.outlines);
    }
    return region;
  }

 private:
  /// Compares two lines that the sweep meets at the same time.
  [[nodiscard]] bool is_below(int l, int m) const {
    if (l == m) return false;
    const GridLine& p = lines_[l];
    const GridLine& q = lines_[m];
    const bool is_first = p.a <= q.a;
    const GridLine& first = is_first ? p : q;
    const GridLine& second = is_first ? q : p;
    const int side = turn(first.a, first.b, second.a);
    const bool is_above = (side != 0 ? side : turn(first.a, first.b, second.b)) > 0;
    return is_above == is_first;
  }

  /// @param lower  the lower one of the two lines at the curve's first point
  void begin_curve(int lower, int point, std::vector<Outline>& outlines) {
    const int index = static_cast<int>(curves_.size());
    Curve curve;
    curve.turns = lines_[lower].passes[0];
    for (int line = lower, at = point; curve_of_[line] == kNoCurve;) {
      curve_of_[line] = index;
      curve.points.push_back(at);
      at = network_.ends[line][network_.ends[line][0] == at ? 1 : 0];
      line = network_.lines_at[at][network_.lines_at[at][0] == line ? 1 : 0];
    }
    if (place_[lower] != active_.begin()) {
      const int below = *std::prev(place_[lower]);
      const Curve& other = curves_[curve_of_[below]];
      const bool is_inside = lines_[below].passes[0] == other.turns;
      curve.winding_outside = other.winding_outside + (is_inside ? other.turns : 0);
      curve.outline_outside = is_inside ? other.outline_inside : other.outline_outside;
    }
    curve.outline_inside = curve.outline_outside;
    const bool is_open_inside = curve.winding_outside + curve.turns == 0;
    if (is_open_inside || curve.winding_outside == 0) {
      curve.outline_inside = static_cast<int>(outlines.size());
      outlines.push_back(outline_of(curve, is_open_inside));
    }
    curves_.push_back(std::move(curve));
  }

  [[nodiscard]] Outline outline_of(const Curve& curve, bool is_hole) const {
    Outline outline;
    outline.points = curve.points;
    if (is_hole) std::reverse(outline.points.begin(), outline.points.end());
    outline.area_mm2 = area_mm2(network_.points, outline.points);
    outline.parent = curve.outline_outside;
    return outline;
  }

  using Active = std::set<int, std::function<bool(int, int)>>;
  const std::vector<GridLine>& lines_;
  const Network& network_;
  std::vector<Curve> curves_;
  std::vector<int> curve_of_;  ///< of each line
  Active active_;              ///< lines that the sweep is crossing, from the lowest to the highest
  std::vector<Active::iterator> place_;  ///< of each line in active_
};

}  // namespace

std::optional<Region> region_in_disjoint_curves(const std::vector<GridLine>& lines) {
  const std::optional<Network> network = network_of(lines);
  if (!network) return std::nullopt;
  return Sweep(lines, *network).region();
}

}  // namespace hydroprint::overlay
