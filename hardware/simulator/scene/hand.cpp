#include "hardware/simulator/scene/hand.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/base/look_at.h"

namespace hydroprint::simulated_scene {
namespace {

/// A frequency band of the motion of a hand held still. Physiological tremor has a frequency of 8
/// to 12 Hz and an amplitude of some tenths of a millimetre; at lower frequencies the arm sways by
/// millimetres (Elble and Koller, Tremor, 1990).
struct Sway {
  double least_hz, most_hz;
  double amplitude_mm, amplitude_rad;
};
constexpr std::array<Sway, 4> kSways = {{{0.3, 0.7, 2.5, 0.006},
                                         {1.0, 2.0, 0.8, 0.003},
                                         {3.0, 5.0, 0.2, 0.001},
                                         {8.0, 12.0, 0.15, 0.0008}}};

/// Displacement (mm) and rotation (rad).
struct Shake {
  Eigen::Vector3d shift_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
};

double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;  // independent of the standard library
}

Shake shake(std::uint64_t seed, double time_s) {
  std::mt19937_64 random(seed ^ 0x68616e64U);
  Shake out;
  for (const Sway& sway : kSways) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool turns : {false, true}) {
        const double hz = sway.least_hz + (sway.most_hz - sway.least_hz) * unit(random);
        const double phase = 2 * std::numbers::pi * unit(random);
        const double wave = std::sin(2 * std::numbers::pi * hz * time_s + phase);
        (turns ? out.turn_rad : out.shift_mm)[axis] +=
            wave * (turns ? sway.amplitude_rad : sway.amplitude_mm);
      }
    }
  }
  return out;
}

/// Returns the camera's position at a time, on a closed Catmull-Rom spline through the stand's
/// positions.
Eigen::Vector3d place(const CameraStand& stand, double time_s) {
  const int count = static_cast<int>(stand.via_mm.size()) + 1;
  if (count == 1) return stand.at_mm;
  const double turns = time_s / stand.period_s;
  const double along = (turns - std::floor(turns)) * count;
  const int piece = std::min(static_cast<int>(along), count - 1);
  const double t = along - piece;
  const auto knot = [&](int i) -> const Eigen::Vector3d& {
    const int k = (i + count) % count;
    return k == 0 ? stand.at_mm : stand.via_mm[static_cast<std::size_t>(k - 1)];
  };
  const Eigen::Vector3d& a = knot(piece - 1);
  const Eigen::Vector3d& b = knot(piece);
  const Eigen::Vector3d& c = knot(piece + 1);
  const Eigen::Vector3d& d = knot(piece + 2);
  return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * (t * t) +
                (3 * b - 3 * c + d - a) * (t * t * t));
}

}  // namespace

Pose camera_pose(const CameraStand& stand, std::uint64_t seed, double time_s) {
  Pose out = look_at(place(stand, time_s), stand.looks_at_mm, stand.turn_rad);
  if (stand.via_mm.empty() || !stand.trembles) return out;
  const Shake now = shake(seed, time_s);
  const double angle = now.turn_rad.norm();
  out.translation() += now.shift_mm;
  if (angle > 0) out.rotate(Eigen::AngleAxisd(angle, now.turn_rad / angle));
  return out;
}

}  // namespace hydroprint::simulated_scene
