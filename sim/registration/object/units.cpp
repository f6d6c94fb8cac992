#include "sim/registration/object/units.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/base/number_text.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kSamples = 1000;
/// Limits for the size of a scan relative to its object.
constexpr double kLeast = 0.4, kMost = 1.25;

struct Unit {
  double mm;
  const char* name;
};
constexpr std::array kUnits{Unit{1000, "metres"}, Unit{25.4, "inches"}, Unit{10, "centimetres"}};

/// Returns the approximate diameter: the largest distance from the point that is farthest from the
/// middle.
double across(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  for (const auto& p : points) from += p / static_cast<double>(points.size());
  double far = 0;
  for (int round = 0; round < 2; ++round) {
    Eigen::Vector3d farthest = from;
    far = 0;
    for (const auto& p : points) {
      if ((p - from).norm() <= far) continue;
      far = (p - from).norm();
      farthest = p;
    }
    from = farthest;
  }
  return far;
}

}  // namespace

Status check_size(const Shape& shape, std::span<const scan::ScanPoint> points) {
  std::vector<Eigen::Vector3d> scan, mesh;
  for (const auto& p : points) scan.push_back(p.point_mm);
  for (const auto& s : shape.samples(kSamples)) mesh.push_back(s.point_mm);
  const double scan_mm = across(scan), mesh_mm = across(mesh);
  const auto fits = [&](double factor) {
    const double ratio = scan_mm / (mesh_mm * factor);
    return ratio > kLeast && ratio < kMost;
  };
  if (fits(1)) return {};
  const Unit* best = nullptr;
  bool too_large = false;
  double nearest = 1e9;
  for (const Unit& unit : kUnits) {
    for (const bool large : {false, true}) {
      const double factor = large ? 1 / unit.mm : unit.mm;
      const double off = std::abs(std::log(scan_mm / (mesh_mm * factor) / 0.9));
      if (!fits(factor) || off > nearest) continue;
      nearest = off;
      best = &unit;
      too_large = large;
    }
  }
  const std::string what =
      fmt::format("the mesh is {} mm across, but the object in view is {} mm across",
                  three_digits(mesh_mm), three_digits(scan_mm));
  if (best == nullptr)
    return fail(Code::kFailedPrecondition,
                what + ". Use the complete mesh of the object in the gripper",
                ErrorReason::NOT_THIS_OBJECT);
  return fail(Code::kFailedPrecondition,
              fmt::format("{}. {} {}. Give a scale {} times {}", what,
                          too_large ? "The lengths in the mesh were read as"
                                    : "The mesh file seems to be in",
                          best->name, best->mm, too_large ? "smaller" : "larger"),
              ErrorReason::WRONG_UNITS);
}

}  // namespace hydroprint::registration
