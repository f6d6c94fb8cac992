#include "sim/registration/object/units.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

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

std::string sizes(double mesh_mm, double scan_mm) {
  char buffer[120];
  std::snprintf(buffer, sizeof buffer,
                "the mesh is %.3g mm across, but the object in view is %.3g mm across", mesh_mm,
                scan_mm);
  return buffer;
}

std::string number(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", x);
  return buffer;
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
  const std::string what = sizes(mesh_mm, scan_mm);
  if (best == nullptr)
    return fail(Code::kFailedPrecondition,
                what + ". Use the complete mesh of the object in the gripper", "NOT_THIS_OBJECT");
  const std::string remedy = too_large ? ". Its lengths were read as " + std::string(best->name) +
                                             ". Give a scale " + number(best->mm) + " times smaller"
                                       : ". Its file seems to be in " + std::string(best->name) +
                                             ". Give a scale " + number(best->mm) + " times larger";
  return fail(Code::kFailedPrecondition, what + remedy, "WRONG_UNITS");
}

}  // namespace hydroprint::registration
