// Accuracy and speed of Stokes dips of spheres: see README.md beside this file for the method.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kDegree = std::numbers::pi / 180;

struct Run {
  pipeline::Dip dip;
  double seconds = 0;
  std::map<std::string, double> stage_seconds;
};

Run run(const mesh::Model& model, const pipeline::DipOptions& options) {
  Run result;
  Context context;
  context.threads = 2;
  auto last = Clock::now();
  std::string stage = "reading";
  context.report = [&](std::string_view now, double) {
    const auto time = Clock::now();
    result.stage_seconds[std::string(now)] += std::chrono::duration<double>(time - last).count();
    last = time;
  };
  const auto start = Clock::now();
  auto dip = pipeline::dip(model, options, context);
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (!dip) {
    std::fprintf(stderr, "bench_sphere: %s\n", dip.error().message.c_str());
    std::exit(1);
  }
  result.stage_seconds["rest"] += std::chrono::duration<double>(Clock::now() - last).count();
  result.dip = std::move(*dip);
  return result;
}

struct Errors {
  double rms_mm = 0, max_mm = 0;
  std::size_t count = 0, missing = 0;
};

Errors summarise(const std::vector<double>& errors, std::size_t missing) {
  Errors result;
  for (const double e : errors) {
    result.rms_mm += e * e;
    result.max_mm = std::max(result.max_mm, e);
  }
  result.count = errors.size();
  result.missing = missing;
  if (!errors.empty())
    result.rms_mm = std::sqrt(result.rms_mm / static_cast<double>(errors.size()));
  return result;
}

double theta_of(const Eigen::Vector3d& point, double radius_mm) {
  return std::acos(std::clamp(-point.z() / radius_mm, -1.0, 1.0));
}

/// Distance on the sphere between where a film point lands and where it lands exactly.
Errors against_exact(const pipeline::Dip& dip, double sphere_mm, double vat_mm, double most_rad) {
  std::vector<double> errors;
  std::size_t missing = 0;
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    const Eigen::Vector3d& p = dip.surface.points[v];
    const double theta = theta_of(p, sphere_mm);
    if (theta > most_rad) continue;
    const Eigen::Vector2d& film = dip.map.surface.film_mm[v];
    if (std::isnan(film.x())) {
      ++missing;
      continue;
    }
    const double along =
        sphere_mm * (exact::contact_angle_rad(sphere_mm, vat_mm, film.norm()) - theta);
    const Eigen::Vector2d flat = p.head<2>();
    const double turn = flat.norm() < 1e-9 || film.norm() < 1e-9
                            ? 0
                            : std::atan2(flat.x() * film.y() - flat.y() * film.x(), flat.dot(film));
    errors.push_back(std::hypot(along, sphere_mm * std::sin(theta) * turn));
  }
  return summarise(errors, missing);
}

/// Distance on the film between two runs on the same surface.
Errors against_run(const pipeline::Dip& dip, const pipeline::Dip& finest, double sphere_mm,
                   double most_rad) {
  std::vector<double> errors;
  std::size_t missing = 0;
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    if (theta_of(dip.surface.points[v], sphere_mm) > most_rad) continue;
    const double e = (dip.map.surface.film_mm[v] - finest.map.surface.film_mm[v]).norm();
    if (std::isnan(e)) {
      ++missing;
    } else {
      errors.push_back(e);
    }
  }
  return summarise(errors, missing);
}

void print(const char* what, const Errors& e) {
  std::printf("  %-22s rms %.4f mm  max %.4f mm  (%zu points, %zu missing)\n", what, e.rms_mm,
              e.max_mm, e.count, e.missing);
}

void print(const Run& r) {
  const auto& f = r.dip.figures;
  std::printf(
      "  %.2f s, %d waterlines, film mesh up to %d vertices, depth %.2f mm, coverage %.4f\n",
      r.seconds, f.steps, f.film_vertices_max, f.depth_mm, f.coverage);
  for (const auto& [stage, seconds] : r.stage_seconds) {
    std::printf("    %-12s %.3f s\n", stage.c_str(), seconds);
  }
}

pipeline::DipOptions options_for(const std::string& film, double depth_mm) {
  pipeline::DipOptions options;
  options.outline = film::parse_outline(film).value();
  options.depth_mm = depth_mm;
  options.map.make_tiles = false;
  return options;
}

double depth_to(double radius_mm, double theta_rad) {
  return radius_mm * (1 - std::cos(theta_rad));
}

void centred() {
  std::puts("centred sphere, radius 40 mm, icosphere of 81,920 triangles, circular film 105 mm");
  const Run r = run(sample::icosphere(40, 6), options_for("circle:105", 80));
  print(r);
  for (const double degrees : {60, 90, 120, 150, 165}) {
    print(("to " + std::to_string(static_cast<int>(degrees)) + " degrees").c_str(),
          against_exact(r.dip, 40, 105, degrees * kDegree));
  }
}

void off_centre() {
  std::puts("sphere of radius 45 mm at (25, -40) on A4, against the finest run, to 120 degrees");
  const mesh::Model model = sample::icosphere(45, 6);
  pipeline::DipOptions options = options_for("A4", depth_to(45, 121 * kDegree));
  options.X_FO = Pose(Eigen::Translation3d(25, -40, 0));
  const Run normal = run(model, options);
  print(normal);
  options.schedule.swept_mm /= 3;
  options.mesh.size.at_waterline_mm /= 2;
  options.mesh.size.growth /= 2;
  options.mesh.size.most_mm /= 2;
  options.mesh.spacing_mm /= 2;
  options.mesh.tolerance_mm /= 2;
  const Run fine = run(model, options);
  print(fine);
  print("normal against finest", against_run(normal.dip, fine.dip, 45, 120 * kDegree));
}

void speed() {
  std::puts("sphere of radius 60 mm on A4 to 120 degrees (the dip alone, in process, 2 threads)");
  const mesh::Model model = sample::icosphere(60, 6);
  print(run(model, options_for("A4", depth_to(60, 120 * kDegree))));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("  peak memory of this process %.0f MiB\n",
              static_cast<double>(usage.ru_maxrss) / 1024);
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  const std::string which = argc > 1 ? argv[1] : "all";
  if (which == "all" || which == "centred") hydroprint::bench::centred();
  if (which == "all" || which == "off-centre") hydroprint::bench::off_centre();
  if (which == "all" || which == "speed") hydroprint::bench::speed();
}
