#include "sim/validate/measure.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"
#include "sim/validate/film_locator.h"

namespace hydroprint::validate {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Summary summarise(std::vector<double> values) {
  std::erase_if(values, [](double x) { return !std::isfinite(x); });
  if (values.empty()) return {0, kNan, kNan, kNan, kNan, kNan};
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  Summary out;
  out.count = values.size();
  for (const double x : values) {
    out.mean += x / count;
    out.rms += x * x / count;
  }
  out.rms = std::sqrt(out.rms);
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(std::ceil(q * (count - 1)))];
  };
  out.p50 = quantile(0.5);
  out.p95 = quantile(0.95);
  out.max = values.back();
  return out;
}

Result<std::vector<double>> landing_errors(const pipeline::Dip& plan,
                                           const pipeline::Dip& experiment,
                                           const Context& context) {
  HP_CHECK(plan.map.surface.film_mm.size() == plan.surface.points.size());
  const FilmLocator locator(experiment.surface, experiment.map.tiles);
  std::vector<double> errors(plan.surface.points.size(), kNan);
  HP_RETURN_IF_ERROR(parallel_for(context, {}, errors.size(), [&](std::size_t v) -> Status {
    const Eigen::Vector2d& film = plan.map.surface.film_mm[v];
    if (!film.allFinite()) return {};
    const auto landed = locator.at(film);
    errors[v] = landed ? (*landed - plan.surface.points[v]).norm() : HUGE_VAL;
    return {};
  }));
  return errors;
}

std::vector<double> film_differences(const pipeline::Dip& a, const pipeline::Dip& b) {
  HP_CHECK(a.map.surface.film_mm.size() == b.map.surface.film_mm.size());
  std::vector<double> out;
  for (std::size_t v = 0; v < a.map.surface.film_mm.size(); ++v) {
    out.push_back((a.map.surface.film_mm[v] - b.map.surface.film_mm[v]).norm());
  }
  return out;
}

std::vector<double> values_where(const mesh::Surface& surface, const std::vector<double>& values,
                                 const Region& region) {
  HP_CHECK(values.size() == surface.points.size());
  std::vector<double> out;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (surface.weld[v] == static_cast<int>(v) && region(surface.points[v]))
      out.push_back(values[v]);
  }
  return out;
}

double share_where(const mesh::Surface& surface, const Region& region,
                   const std::function<bool(std::size_t point)>& holds) {
  double all = 0, held = 0;
  for (const Eigen::Vector3i& t : surface.triangles) {
    const Eigen::Vector3d& a = surface.points[t[0]];
    const double third = (surface.points[t[1]] - a).cross(surface.points[t[2]] - a).norm() / 6;
    for (const int v : t) {
      if (!region(surface.points[v])) continue;
      all += third;
      if (holds(static_cast<std::size_t>(v))) held += third;
    }
  }
  return all > 0 ? held / all : 0;
}

image::Quantity quantity_of(const std::string& label, const mesh::Surface& surface,
                            const std::vector<double>& values, const Region& fits) {
  return {label, values_where(surface, values, fits), 0, 1e-3,
          [&surface, &values](const flow::MappedTriangle& tile) {
            const Eigen::Vector3i& v = surface.triangles[tile.triangle];
            Eigen::Vector3d corners(values[v[0]], values[v[1]], values[v[2]]);
            double sum = 0;
            int known = 0;
            for (const double x : corners) {
              if (std::isnan(x)) continue;
              sum += x;
              ++known;
            }
            std::array<double, 3> at{};
            for (int i = 0; i < 3; ++i) {
              for (int k = 0; k < 3; ++k) {
                const double value = std::isnan(corners[k]) ? sum / known : corners[k];
                const auto weight = static_cast<double>(tile.barycentric[i][k]);
                if (weight != 0) at[i] += weight * value;
              }
            }
            return at;
          }};
}

std::string text_of(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

}  // namespace hydroprint::validate
