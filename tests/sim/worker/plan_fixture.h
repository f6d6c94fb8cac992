#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "hydroprint/v1/report.pb.h"
#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {

/// A vertex of plan.ply.
struct PlanPoint {
  std::array<double, 3> xyz;
  int dip = 0;
  std::vector<double> weight, stretch, stretch_min;
};

/// Contents of plan.ply.
struct PlanPly {
  std::vector<PlanPoint> points;
  std::size_t triangles = 0;
};

/// Fails the test if header and size are not those of a plan of this many dips.
[[nodiscard]] PlanPly read_plan_ply(const std::filesystem::path& path, std::size_t dips);

/// A closed sphere with another one inside it, both as sphere_obj() with this many rings.
[[nodiscard]] std::string hollow_sphere_obj(double radius_mm, double cavity_mm, int rings);

/// Runs plan on the sphere with two opposite dips.
class PlanWorker : public Worker {
 protected:
  void SetUp() override;

  /// Writes two.json with these orientations, each for a full dip.
  void write_immersions(const std::vector<std::array<double, 4>>& rotations_wxyz) const;
  /// The command line, with a small film, Stokes flow and 100 dpi unless `more` says otherwise.
  [[nodiscard]] Arguments plan(const Arguments& more) const;
  /// Runs it. Fails the test unless it succeeds with a report that is a PlanReport.
  [[nodiscard]] v1::PlanReport planned(const Arguments& more) const;
  /// The warnings as "CODE where".
  [[nodiscard]] static std::set<std::string> warned(const v1::PlanReport& report);
};

}  // namespace hydroprint::worker
