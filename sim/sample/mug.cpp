#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sample/chart.h"
#include "sim/sample/textured_mesh.h"
#include "sim/sample/turned.h"

namespace hydroprint::sample {
namespace {

using std::numbers::pi;

constexpr double kRadiusMm = 40;
constexpr double kHeightMm = 90;
constexpr double kWallMm = 4;
constexpr double kFloorMm = 5;
constexpr double kFilletMm = 6;
constexpr int kAround = 192;
constexpr double kRoundMm = 2 * pi * kRadiusMm;

/// Parts of the outline, from the middle of the bottom outward, up, over the rim and down inside.
enum Part : std::size_t { kBottom, kOuter, kInner, kFloor, kHandle };

/// Returns the parts of the outline. Each begins with the last point of the previous one.
std::vector<Outline> make_parts() {
  std::vector<Outline> parts(1, Outline(1));
  const auto next = [&] {
    OutlinePoint p = parts.back().back();
    p.arc_mm = 0;
    parts.push_back({p});
  };
  add_line(parts.back(), kRadiusMm - kFilletMm, 0, 24);
  add_arc(parts.back(), kRadiusMm - kFilletMm, kFilletMm, kFilletMm, -pi / 2, 0, 7);
  next();
  const double rim_z = kHeightMm - kWallMm / 2;
  add_line(parts.back(), kRadiusMm, rim_z, 62);
  add_arc(parts.back(), kRadiusMm - kWallMm / 2, rim_z, kWallMm / 2, 0, pi, 8);
  next();
  const double inside_mm = kRadiusMm - kWallMm;
  add_line(parts.back(), inside_mm, kFloorMm + kFilletMm, 56);
  next();
  add_arc(parts.back(), inside_mm - kFilletMm, kFloorMm + kFilletMm, kFilletMm, 0, -pi / 2, 7);
  add_line(parts.back(), 0, kFloorMm, 22);
  return parts;
}

// The handle joins the wall at two holes, each of 8 x 10 of the wall's cells.
constexpr int kHoleHalf = 4;   // cells to either side of the handle's plane
constexpr int kHoleRows = 10;  // height of a hole, in cells
constexpr int kLowRow = 10;    // first row of the wall in the lower hole
constexpr int kHighRow = 42;   // first row of the wall in the upper hole
constexpr int kSpokes = 2 * (2 * kHoleHalf + kHoleRows);
constexpr int kHandleRings = 60;
constexpr double kHandleRadiusMm = 5.5;
constexpr double kHandleReachMm = 27;

bool in_hole(int i, std::size_t row) {
  const auto r = static_cast<int>(row);
  const bool beside = i < kHoleHalf || i >= kAround - kHoleHalf;
  return beside &&
         ((r >= kLowRow && r < kLowRow + kHoleRows) || (r >= kHighRow && r < kHighRow + kHoleRows));
}

class MugMaker {
 public:
  MugMaker() {
    const double bottom = length_mm(kBottom);
    const double floor = length_mm(kFloor);
    const double outer = length_mm(kOuter);
    const double inner = length_mm(kInner);
    const double discs_y = outer + inner + 15;
    sheet_.size_mm = {kRoundMm + 10, discs_y + 2 * bottom + 5};
    sheet_.charts = {
        {{5, discs_y},
         {2 * bottom, 2 * bottom},
         [=](double x, double y) {
           return rings(std::hypot(x - bottom, y - bottom), {0.13F, 0.30F, 0.47F});
         }},
        {{5, 5}, {kRoundMm, outer}, scene},
        {{5, outer + 10}, {kRoundMm, inner}, lining},
        {{10 + 2 * bottom, discs_y},
         {2 * floor, 2 * floor},
         [=](double x, double y) {
           return rings(std::hypot(x - floor, y - floor), {0.80F, 0.36F, 0.22F});
         }},
        {{15 + 2 * (bottom + floor), discs_y}, {kHandleWidthMm, kHandleLengthMm}, braid}};
  }

  Sample run() {
    for (const std::size_t part : {kBottom, kOuter, kInner, kFloor}) add_part(part);
    add_handle();
    Sample sample;
    sample.mesh = std::move(mesh_);
    sample.texture = sheet_.draw();
    sample.px_per_mm = sheet_.px_per_mm;
    return sample;
  }

 private:
  static constexpr double kHandleWidthMm = 40;
  static constexpr double kHandleLengthMm = 75;

  [[nodiscard]] double length_mm(std::size_t part) const { return parts_[part].back().arc_mm; }

  // --- the body ---

  /// Adds the ring of an outline point and returns its first vertex. The two middles are single
  /// vertices. Parts share the ring at their common boundary.
  int ring_of(std::size_t part, std::size_t row) {
    if (row == 0 && part != kBottom) return last_ring_;
    const auto& p = parts_[part][row];
    const auto position = [&](int i) {
      const double angle = 2 * pi * i / kAround;
      return Eigen::Vector3d(p.radius_mm * std::cos(angle), p.radius_mm * std::sin(angle), p.z_mm);
    };
    last_ring_ = mesh_.add_vertex(position(0));
    if (p.radius_mm > 1e-9)
      for (int i = 1; i < kAround; ++i) mesh_.add_vertex(position(i));
    return last_ring_;
  }

  [[nodiscard]] Eigen::Vector2d place(std::size_t part, double arc_mm, double i) const {
    const double angle = 2 * pi * i / kAround;
    const double length = length_mm(part);
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    if (part == kBottom)  // seen from below
      return Eigen::Vector2d(length, length) +
             arc_mm * Eigen::Vector2d(direction.x(), -direction.y());
    if (part == kFloor) return Eigen::Vector2d(length, length) + (length - arc_mm) * direction;
    if (part == kInner) return {kRoundMm - kRadiusMm * angle, length - arc_mm};  // upright inside
    return {kRadiusMm * angle, arc_mm};
  }

  void add_part(std::size_t part) {
    const auto& points = parts_[part];
    std::vector<int> rings;
    for (std::size_t row = 0; row < points.size(); ++row) rings.push_back(ring_of(part, row));
    if (part == kOuter) wall_ = rings;
    const auto corner = [&](std::size_t row, int i) -> TexturedMesh::Corner {
      const bool is_middle = points[row].radius_mm < 1e-9;
      return {rings[row] + (is_middle ? 0 : i % kAround),
              mesh_.add_uv(sheet_.uv(part, place(part, points[row].arc_mm, i)))};
    };
    for (std::size_t row = 0; row + 1 < points.size(); ++row)
      for (int i = 0; i < kAround; ++i) {
        if (part == kOuter && in_hole(i, row)) continue;
        if (points[row].radius_mm < 1e-9) {
          mesh_.add_face({corner(row, i), corner(row + 1, i + 1), corner(row + 1, i)});
        } else if (points[row + 1].radius_mm < 1e-9) {
          mesh_.add_face({corner(row, i), corner(row, i + 1), corner(row + 1, i)});
        } else {
          mesh_.add_face(
              {corner(row, i), corner(row, i + 1), corner(row + 1, i + 1), corner(row + 1, i)});
        }
      }
  }

  // --- the handle ---

  /// Returns the rim of a hole, starting at the middle of its outer side (upper side of the upper
  /// hole, lower side of the lower hole), towards +y and around.
  [[nodiscard]] std::vector<int> hole_rim(int first_row, bool is_upper) const {
    std::vector<int> rim;
    const auto add = [&](int i, int row) {
      rim.push_back(
          wall_[static_cast<std::size_t>(first_row + (is_upper ? row : kHoleRows - row))] +
          (i + kAround) % kAround);
    };
    for (int i = 0; i < kHoleHalf; ++i) add(i, kHoleRows);
    for (int row = kHoleRows; row > 0; --row) add(kHoleHalf, row);
    for (int i = kHoleHalf; i > -kHoleHalf; --i) add(i, 0);
    for (int row = 0; row < kHoleRows; ++row) add(-kHoleHalf, row);
    for (int i = -kHoleHalf; i < 0; ++i) add(i, kHoleRows);
    return rim;
  }

  [[nodiscard]] double row_z(int row) const {
    return parts_[kOuter][static_cast<std::size_t>(row)].z_mm;
  }

  /// Returns a point on the handle's middle line: half an ellipse from the upper hole to the lower
  /// one.
  /// @param t  0 to 1
  [[nodiscard]] Eigen::Vector3d middle(double t) const {
    const double high = row_z(kHighRow + kHoleRows / 2);
    const double low = row_z(kLowRow + kHoleRows / 2);
    return {kRadiusMm + kHandleReachMm * std::sin(pi * t), 0,
            (high + low) / 2 + (high - low) / 2 * std::cos(pi * t)};
  }

  /// Returns the unit vector across the handle, in the plane of its middle line, away from the mug.
  [[nodiscard]] Eigen::Vector3d outward(double t) const {
    const double half = (row_z(kHighRow) - row_z(kLowRow)) / 2;
    const Eigen::Vector3d along(kHandleReachMm * std::cos(pi * t), 0, -half * std::sin(pi * t));
    return along.normalized().cross(Eigen::Vector3d::UnitY());
  }

  /// Returns point j of the handle's cross-section at t. The cross-section is round in the middle
  /// and changes into the holes' rims at the ends.
  [[nodiscard]] Eigen::Vector3d handle_point(double t, int j, const std::vector<int>& upper,
                                             const std::vector<int>& lower) const {
    const bool is_upper = t < 0.5;
    const double end = is_upper ? 0 : 1;
    const auto& rim = mesh_.vertex((is_upper ? upper : lower)[static_cast<std::size_t>(j)]);
    const Eigen::Vector3d from_middle = rim - middle(end);
    const double up = from_middle.dot(outward(end));
    const double side = from_middle.y();
    const double angle = 2 * pi * j / kSpokes;
    const double round = ramp(0, 0.16, std::abs(t - end));
    const double a = (1 - round) * up + round * kHandleRadiusMm * std::cos(angle);
    const double b = (1 - round) * side + round * kHandleRadiusMm * std::sin(angle);
    Eigen::Vector3d p = middle(t) + a * outward(t) + b * Eigen::Vector3d::UnitY();
    p.x() += (1 - round) * from_middle.x();  // the rim lies on the curved wall
    return p;
  }

  void add_handle() {
    const auto upper = hole_rim(kHighRow, true);
    const auto lower = hole_rim(kLowRow, false);
    std::vector<std::vector<int>> rings = {upper};
    for (int r = 1; r < kHandleRings; ++r) {
      std::vector<int> ring;
      for (int j = 0; j < kSpokes; ++j)
        ring.push_back(
            mesh_.add_vertex(handle_point(static_cast<double>(r) / kHandleRings, j, upper, lower)));
      rings.push_back(std::move(ring));
    }
    rings.push_back(lower);
    const auto corner = [&](int r, int j) -> TexturedMesh::Corner {
      const Eigen::Vector2d place(kHandleWidthMm * (1 - static_cast<double>(j) / kSpokes),
                                  kHandleLengthMm * r / kHandleRings);
      return {rings[static_cast<std::size_t>(r)][static_cast<std::size_t>(j % kSpokes)],
              mesh_.add_uv(sheet_.uv(kHandle, place))};
    };
    for (int r = 0; r < kHandleRings; ++r)
      for (int j = 0; j < kSpokes; ++j)
        mesh_.add_face({corner(r, j), corner(r + 1, j), corner(r + 1, j + 1), corner(r, j + 1)});
  }

  // --- the picture ---

  /// A bay with the sun behind hills, and waves in front. The picture is periodic around the mug.
  static Colour scene(double x, double y) {
    const double turn = 2 * pi * x / kRoundMm;
    const auto hill = [&](double base, double height, int waves, double shift) {
      return base + height * (0.6 * std::sin(waves * turn + shift) +
                              0.4 * std::sin((2 * waves + 1) * turn + 2 * shift));
    };
    Colour colour = mix({1.0F, 0.80F, 0.52F}, {0.22F, 0.50F, 0.80F}, ramp(35, 85, y));
    const double sun = std::hypot(x - kRoundMm / 2, y - 58);
    colour = mix(colour, {1.0F, 0.93F, 0.70F}, 0.8 * (1 - ramp(10, 22, sun)));
    if (sun < 10.5) colour = {0.99F, 0.58F, 0.20F};
    if (y < hill(46, 6, 3, 0.4)) colour = {0.50F, 0.53F, 0.66F};
    if (y < hill(40, 5, 4, 1.9)) colour = {0.30F, 0.44F, 0.50F};
    if (y < hill(34, 3, 6, 0.9)) colour = {0.19F, 0.40F, 0.31F};
    constexpr int kWaves = 5;
    for (int k = 0; k < kWaves; ++k) {
      const double crest = 29 - 6.2 * k + 1.6 * std::sin((14 - k) * turn + 1.7 * k);
      const Colour water =
          mix({0.35F, 0.72F, 0.78F}, {0.04F, 0.20F, 0.42F}, static_cast<double>(k) / (kWaves - 1));
      if (y < crest) colour = y > crest - 0.8 ? Colour(0.95F, 0.98F, 0.98F) : water;
    }
    if (y > outer_picture_top()) colour = {0.80F, 0.36F, 0.22F};
    return colour;
  }

  static double outer_picture_top() { return kHeightMm - kFilletMm - kWallMm; }

  static Colour lining(double, double y) {
    const Colour cream(0.97F, 0.94F, 0.86F);
    return std::fmod(y + 100, 12) < 1 ? Colour(0.80F, 0.36F, 0.22F) : cream;
  }

  static Colour rings(double r, const Colour& ink) {
    return to_nearest_line(r, 8) < 1 ? ink : Colour(0.97F, 0.94F, 0.86F);
  }

  static Colour braid(double x, double y) {
    const bool on = std::fmod(x + y + 400, 10) < 5;
    return on ? Colour(0.80F, 0.36F, 0.22F) : Colour(0.13F, 0.30F, 0.47F);
  }

  const std::vector<Outline> parts_ = make_parts();
  Sheet sheet_;
  TexturedMesh mesh_;
  int last_ring_ = 0;
  std::vector<int> wall_;  ///< first vertex of each ring of the outer wall
};

}  // namespace

Sample make_mug() { return MugMaker().run(); }

}  // namespace hydroprint::sample
