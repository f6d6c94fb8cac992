#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sample/painting.h"
#include "sim/sample/textured_mesh.h"
#include "sim/sample/turned.h"

namespace hydroprint::sample {
namespace {

using std::numbers::pi;

constexpr double kHeightMm = 66;
constexpr double kWallMm = 4;
constexpr double kFloorMm = 5;
constexpr double kFootMm = 47;  // outer radius at the bottom
constexpr double kRimMm = 50;   // outer radius at the rim
constexpr double kFilletMm = 3;
constexpr int kAround = 180;

/// Returns the outline from the middle of the bottom outward, up, over the rim, and down inside to
/// the middle again.
Outline make_outline() {
  Outline out(1);
  add_line(out, kFootMm - kFilletMm, 0, 22);
  add_arc(out, kFootMm - kFilletMm, kFilletMm, kFilletMm, -pi / 2, 0, 6);
  const double rim_z = kHeightMm - kWallMm / 2;
  add_line(out, kRimMm, rim_z, 36);
  add_arc(out, kRimMm - kWallMm / 2, rim_z, kWallMm / 2, 0, pi, 8);
  const double inside_mm = kFootMm - kWallMm;
  add_line(out, inside_mm, kFloorMm + kFilletMm, 34);
  add_arc(out, inside_mm - kFilletMm, kFloorMm + kFilletMm, kFilletMm, 0, -pi / 2, 6);
  add_line(out, 0, kFloorMm, 22);
  return out;
}

/// Sectors of 15 degrees and rings of 12 mm; green outside, red inside.
Colour colour_at(double turn, double arc_mm, double rim_arc_mm) {
  const Colour dark =
      arc_mm < rim_arc_mm ? Colour(0.12F, 0.38F, 0.30F) : Colour(0.66F, 0.18F, 0.16F);
  constexpr double kRingMm = 12;
  return is_dark_square(24 * turn, arc_mm / kRingMm, 1) ? dark : Colour(0.97F, 0.95F, 0.89F);
}

}  // namespace

Sample make_bowl() {
  const Outline places = make_outline();
  const std::size_t last = places.size() - 1;
  const double length_mm = places.back().arc_mm;
  Sample sample;
  TexturedMesh& mesh = sample.mesh;
  std::vector<int> ring, uv;  // first vertex and texture coordinate of each outline point
  for (const OutlinePoint& p : places) {
    const bool is_middle = &p == &places.front() || &p == &places.back();
    ring.push_back(mesh.add_vertex({p.radius_mm, 0, p.z_mm}));
    for (int i = 1; i < kAround && !is_middle; ++i) {
      const double angle = 2 * pi * i / kAround;
      mesh.add_vertex({p.radius_mm * std::cos(angle), p.radius_mm * std::sin(angle), p.z_mm});
    }
    const double v = p.arc_mm / length_mm;
    uv.push_back(mesh.add_uv({is_middle ? 0.5 / kAround : 0, v}));
    for (int i = 1; i <= kAround; ++i) {  // at a middle, u lies between those of the ring
      mesh.add_uv({std::min<double>(kAround, is_middle ? i + 0.5 : i) / kAround, v});
    }
  }
  const auto corner = [&](std::size_t row, int i) -> TexturedMesh::Corner {
    const bool is_middle = row == 0 || row == last;
    return {ring[row] + (is_middle ? 0 : i % kAround), uv[row] + i};
  };
  for (int i = 0; i < kAround; ++i) {
    mesh.add_face({corner(0, i), corner(1, i + 1), corner(1, i)});
    for (std::size_t row = 1; row + 1 < last; ++row) {
      mesh.add_face(
          {corner(row, i), corner(row, i + 1), corner(row + 1, i + 1), corner(row + 1, i)});
    }
    mesh.add_face({corner(last - 1, i), corner(last - 1, i + 1), corner(last, i)});
  }
  sample.px_per_mm = 7;
  const int width_px = static_cast<int>(std::lround(2 * pi * kRimMm * sample.px_per_mm));
  const int height_px = static_cast<int>(std::lround(length_mm * sample.px_per_mm));
  const double rim_arc_mm = length_mm / 2;
  sample.texture = draw(width_px, height_px, 1 / sample.px_per_mm, 2, [&](double x, double y) {
    return colour_at(x * sample.px_per_mm / width_px, y, rim_arc_mm);
  });
  return sample;
}

}  // namespace hydroprint::sample
