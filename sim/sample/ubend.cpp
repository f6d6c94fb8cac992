#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sample/painting.h"
#include "sim/sample/textured_mesh.h"

namespace hydroprint::sample {
namespace {

using std::numbers::pi;

constexpr double kTubeMm = 12;  // radius of the tube
constexpr double kBendMm = 35;  // radius of the bend, to the tube's centre line
constexpr double kLegMm = 60;   // length of the straight part
constexpr int kAround = 96;
constexpr double kCapMm = pi / 2 * kTubeMm;
constexpr double kLengthMm = 2 * kCapMm + 2 * kLegMm + pi * kBendMm;
constexpr double kRoundMm = 2 * pi * kTubeMm;

/// A ring of the tube: its middle, the direction of the tube there, and its radius.
struct Ring {
  Eigen::Vector3d middle;
  Eigen::Vector3d along;
  double radius_mm;
};

/// Returns the ring at arc length s: up the left leg from its foot, over the bend and down the
/// right leg.
Ring ring_at(double s) {
  if (s > kLengthMm / 2) {
    Ring ring = ring_at(kLengthMm - s);
    ring.middle.x() = -ring.middle.x();
    ring.along.z() = -ring.along.z();
    return ring;
  }
  if (s < kCapMm) {
    const double angle = s / kTubeMm;
    return {{-kBendMm, 0, kTubeMm * (1 - std::cos(angle))},
            Eigen::Vector3d::UnitZ(),
            kTubeMm * std::sin(angle)};
  }
  if (s < kCapMm + kLegMm)
    return {{-kBendMm, 0, kTubeMm + s - kCapMm}, Eigen::Vector3d::UnitZ(), kTubeMm};
  const double angle = (s - kCapMm - kLegMm) / kBendMm;
  return {{-kBendMm * std::cos(angle), 0, kTubeMm + kLegMm + kBendMm * std::sin(angle)},
          {std::sin(angle), 0, std::cos(angle)},
          kTubeMm};
}

/// Returns point i of a ring. The seam of the texture runs along the inside of the bend.
Eigen::Vector3d point_on(const Ring& ring, int i) {
  const double angle = pi + 2 * pi * i / kAround;
  const Eigen::Vector3d outward = ring.along.cross(Eigen::Vector3d::UnitY());
  return ring.middle +
         ring.radius_mm * (std::cos(angle) * outward + std::sin(angle) * Eigen::Vector3d::UnitY());
}

/// Pattern of Fig. 13, with a different colour for each leg and a line along the back.
Colour colour_at(double x_mm, double y_mm) {
  constexpr double kSquare = kRoundMm / 8;
  const double x = x_mm - kLengthMm / 2;
  const Colour dark = mix({0.09F, 0.25F, 0.53F}, {0.62F, 0.14F, 0.16F}, ramp(-12, 12, x));
  Colour colour = is_dark_square(x, y_mm, kSquare) ? dark : Colour(0.97F, 0.96F, 0.92F);
  if (std::abs(y_mm - kRoundMm / 2) < 0.5) colour = {0.95F, 0.65F, 0.10F};
  return colour;
}

}  // namespace

Sample make_ubend() {
  constexpr int kRings = 180;  // steps along the tube
  Sample sample;
  auto& mesh = sample.mesh;
  const auto at = [](int j) { return kLengthMm * j / kRings; };
  const int left = mesh.add_vertex({-kBendMm, 0, 0});
  for (int j = 1; j < kRings; ++j)
    for (int i = 0; i < kAround; ++i) mesh.add_vertex(point_on(ring_at(at(j)), i));
  const int right = mesh.add_vertex({kBendMm, 0, 0});
  for (int j = 1; j < kRings; ++j)
    for (int i = 0; i <= kAround; ++i)
      mesh.add_uv({static_cast<double>(j) / kRings, static_cast<double>(i) / kAround});

  const auto corner = [](int j, int i) -> TexturedMesh::Corner {
    return {1 + (j - 1) * kAround + i % kAround, (j - 1) * (kAround + 1) + i};
  };
  for (int i = 0; i < kAround; ++i) {
    const double middle = (i + 0.5) / kAround;
    mesh.add_face({{left, mesh.add_uv({0, middle})}, corner(1, i), corner(1, i + 1)});
    for (int j = 1; j + 1 < kRings; ++j)
      mesh.add_face({corner(j, i), corner(j + 1, i), corner(j + 1, i + 1), corner(j, i + 1)});
    mesh.add_face(
        {corner(kRings - 1, i), {right, mesh.add_uv({1, middle})}, corner(kRings - 1, i + 1)});
  }
  sample.px_per_mm = 9;
  const int width_px = static_cast<int>(std::lround(kLengthMm * sample.px_per_mm));
  const int height_px = static_cast<int>(std::lround(kRoundMm * sample.px_per_mm));
  sample.texture = draw(width_px, height_px, 1 / sample.px_per_mm, 2, colour_at);
  return sample;
}

}  // namespace hydroprint::sample
