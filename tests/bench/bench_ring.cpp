// Compares the sheet with a ring of ink with the one-dimensional solution. See README.md.
#include <algorithm>
#include <limits>

#include "sim/ink/ink_field.h"
#include "sim/pipeline/dip.h"
#include "sim/sample/icosphere.h"
#include "tests/bench/figures.h"
#include "tests/support/axisymmetric_sheet.h"

namespace hydroprint::bench {
namespace {

constexpr double kSphere_mm = 40;
constexpr double kVat_mm = 105;
constexpr double kInner_mm = 25, kOuter_mm = 40;  ///< radii of the ring of ink
constexpr double kEdge_mm = 1;                    ///< width of the ring's edges
constexpr int kRings = 8400;  ///< number of film rings in the one-dimensional solution

/// A twice differentiable step from 0 to 1 over a width of 1.
double rise(double x) {
  const double t = std::clamp(x + 0.5, 0.0, 1.0);
  return t * t * t * (10 + t * (-15 + 6 * t));
}

/// Amount of ink at a radius: the maximum, t = 4, within the ring, and 0 outside.
double ink_at(double r) {
  return ink::kMostInk * (rise((r - kInner_mm) / kEdge_mm) - rise((r - kOuter_mm) / kEdge_mm));
}

testing::Errors errors_of(const mesh::Model& model, const pipeline::DipOptions& options,
                          const axisymmetric::Dip& solution) {
  const pipeline::Dip dip = value_of(pipeline::dip(model, options, two_threads()));
  const auto angle = [&](double film_mm) {
    const auto landing = solution.at_film(film_mm);
    return landing ? landing->contact_angle_rad : std::numeric_limits<double>::quiet_NaN();
  };
  return testing::errors_to(120, dip.surface,
                            testing::landing_distances_mm(dip, kSphere_mm, angle));
}

void measure() {
  pipeline::DipOptions options = testing::sphere_options("circle:105", kSphere_mm, 120);
  const film::Profile profile = options.profile;
  const axisymmetric::Film film{
      kVat_mm, [&](double r) { return film::rest_thickness_mm(profile, ink_at(r)); },
      profile.thickness_mm};
  const axisymmetric::Dip solution(film, axisymmetric::sphere(kSphere_mm, 2.25), kRings);
  const mesh::Model model = sample::icosphere(kSphere_mm, 6);
  const double without = errors_of(model, options, solution).summary.rms;
  options.ink = value_of(ink::InkField::from_function(
      ink::ink_grid(options.outline),
      [](const Eigen::Vector2d& p) { return std::clamp(ink_at(p.norm()), 0.0, ink::kMostInk); }));
  Json figures = json_of(errors_of(model, options, solution));
  figures["rms_mm_without_ink"] = without;
  print("ring", figures);
}

}  // namespace
}  // namespace hydroprint::bench

int main() { hydroprint::bench::measure(); }
