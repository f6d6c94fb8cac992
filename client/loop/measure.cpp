#include "client/loop/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace hydroprint::loop {
namespace {

bool is_whole(double x) { return std::abs(x - std::round(x)) < 1e-6; }

bool is_cross(const Body& body, const Eigen::Vector3d& p) {
  if (!body.is_round) return p.z() < 1e-6 && is_whole(p.x() / 10) && is_whole(p.y() / 10);
  const double theta_deg = std::acos(std::clamp(-p.z() / p.norm(), -1.0, 1.0)) / kDegree;
  return theta_deg < 90 + 1e-6 && is_whole(theta_deg / 15) &&
         is_whole(std::atan2(p.y(), p.x()) / (15 * kDegree));
}

/// Returns the indices of the vertices that are cross-points and have a film point, only one of
/// those at the same place.
std::vector<std::size_t> crosses(const Body& body, const SurfaceMap& plan) {
  std::vector<std::size_t> out;
  std::set<std::array<long, 3>> places;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const Eigen::Vector3d& p = plan.points[i];
    if (!is_cross(body, p) || !plan.film_mm[i].allFinite()) continue;
    const auto near = [](double x) { return std::lround(1e4 * x); };
    if (places.insert({near(p.x()), near(p.y()), near(p.z())}).second) out.push_back(i);
  }
  return out;
}

}  // namespace

double bound_mm(const Body& body) { return body.is_round ? 1.3 : 1.0; }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(
      std::ceil(share * static_cast<double>(values.size() - 1)))];
}

CrossErrors cross_errors(const Body& body, const SurfaceMap& plan, const SurfaceMap& truth,
                         const Truth& as) {
  const FilmLocator locator(truth);
  const Eigen::Vector3d nowhere =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  CrossErrors out;
  for (const std::size_t i : crosses(body, plan)) {
    const auto landed = locator.at(as.printer_scale * plan.film_mm[i] + as.film_mm);
    out.push_back(landed ? Eigen::Vector3d(*landed - plan.points[i]) : nowhere);
  }
  return out;
}

std::vector<double> lengths_mm(const CrossErrors& errors) {
  std::vector<double> out;
  for (const Eigen::Vector3d& error : errors) {
    if (error.allFinite()) out.push_back(error.norm());
  }
  return out;
}

int lost(const CrossErrors& errors) {
  return static_cast<int>(errors.size() - lengths_mm(errors).size());
}

CrossErrors pooled(const std::vector<Round>& rounds, CrossErrors Round::*stage) {
  CrossErrors out;
  for (const Round& round : rounds) {
    const CrossErrors& errors = round.*stage;
    out.insert(out.end(), errors.begin(), errors.end());
  }
  return out;
}

double share(const std::vector<Round>& rounds, CrossErrors Round::*before,
             CrossErrors Round::*stage) {
  const CrossErrors all = pooled(rounds, &Round::placement), with = pooled(rounds, stage);
  const CrossErrors without = before == nullptr ? CrossErrors() : pooled(rounds, before);
  double part = 0, whole = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Eigen::Vector3d step = with[i];
    if (before != nullptr) step -= without[i];
    if (!all[i].allFinite() || !step.allFinite()) continue;
    part += step.dot(all[i]);
    whole += all[i].squaredNorm();
  }
  return whole > 0 ? part / whole : 0;
}

}  // namespace hydroprint::loop
