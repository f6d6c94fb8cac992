#include "sim/waterline/check_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "sim/waterline/columns.h"

namespace hydroprint::waterline {
namespace {

constexpr double kMostOff = 0.02;
constexpr double kStandardErrors = 3;
/// Sections that fewer vertical lines cross are not measured by them.
constexpr double kLeastLines = 8;
constexpr std::size_t kMostTriangles = 12;

using Samples = std::array<double, Columns::kSamples>;

/// Returns the weight of each waterline in the trapezoidal rule, mm. Outside of the waterlines the
/// area is that of the first and of the last.
std::vector<double> weights_mm(const std::vector<Waterline>& lines) {
  std::vector<double> weights(lines.size(), 0);
  weights.front() = lines.front().immersion_mm;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const double half_mm = 0.5 * (lines[k].immersion_mm - lines[k - 1].immersion_mm);
    weights[k - 1] += half_mm;
    weights[k] += half_mm;
  }
  return weights;
}

/// Returns for each waterline its area along the vertical lines of each interleaved grid, mm2.
std::vector<Samples> areas_mm2(const Columns& columns, const std::vector<Waterline>& lines) {
  std::vector<Samples> rises(lines.size() + 1, Samples{});
  const auto index_of = [&](double immersion_mm) {
    return std::ranges::lower_bound(lines, immersion_mm, {}, &Waterline::immersion_mm) -
           lines.begin();
  };
  const double cell_mm2 = Columns::kSamples * columns.cell_mm2();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const int sample = Columns::sample_of(c);
    for (const Columns::Span& span : columns.spans(c)) {
      rises[index_of(span.from_mm)][sample] += cell_mm2;
      rises[index_of(span.to_mm)][sample] -= cell_mm2;
    }
  }
  for (std::size_t k = 1; k < rises.size(); ++k) {
    for (int s = 0; s < Columns::kSamples; ++s) rises[k][s] += rises[k - 1][s];
  }
  rises.pop_back();
  return rises;
}

double mean(const Samples& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / Columns::kSamples;
}

double standard_error(const Samples& values) {
  const double middle = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / (Columns::kSamples - 1) / Columns::kSamples);
}

bool is_inside(const Columns& columns, std::size_t column, double immersion_mm) {
  return std::ranges::any_of(columns.spans(column), [&](const Columns::Span& span) {
    return span.from_mm < immersion_mm && immersion_mm <= span.to_mm;
  });
}

/// Returns the place where section and vertical lines differ that is nearest to the middle of all
/// such places.
Eigen::Vector2d place_of_difference(const Columns& columns, const Waterline& line,
                                    const Eigen::Vector2d& offset_mm) {
  std::vector<Eigen::Vector2d> places;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Eigen::Vector2d place = columns.place_mm(c) + offset_mm;
    if (is_inside(columns, c, line.immersion_mm) == is_inside(line.section, place)) continue;
    places.push_back(place);
    sum += place;
  }
  if (places.empty()) return sum;
  const Eigen::Vector2d middle = sum / static_cast<double>(places.size());
  return *std::ranges::min_element(
      places, {}, [&](const Eigen::Vector2d& p) { return (p - middle).squaredNorm(); });
}

/// Returns the triangles at the immersion that are nearest to a place.
std::vector<int> triangles_near(const Body& body, double immersion_mm,
                                const Eigen::Vector2d& place_mm) {
  std::vector<std::pair<double, int>> found;
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    const Eigen::Vector3i& v = body.triangles[t];
    const Eigen::Vector3d& a = body.points_mm[v[0]];
    const Eigen::Vector3d& b = body.points_mm[v[1]];
    const Eigen::Vector3d& c = body.points_mm[v[2]];
    const auto [low, high] = std::minmax({a.z(), b.z(), c.z()});
    if (low > immersion_mm || high < immersion_mm) continue;
    const Eigen::Vector2d middle = (a + b + c).head<2>() / 3;
    found.emplace_back((middle - place_mm).squaredNorm(), static_cast<int>(t));
  }
  const std::size_t count = std::min(kMostTriangles, found.size());
  std::ranges::partial_sort(found, found.begin() + static_cast<std::ptrdiff_t>(count));
  std::vector<int> triangles;
  for (std::size_t i = 0; i < count; ++i) triangles.push_back(found[i].second);
  return triangles;
}

}  // namespace

std::vector<SectionArea> section_areas(const std::vector<Waterline>& lines) {
  std::vector<SectionArea> areas;
  areas.reserve(lines.size());
  for (const Waterline& line : lines) areas.push_back({line.immersion_mm, area_mm2(line.section)});
  return areas;
}

std::optional<SectionsOff> check_sections(const Body& body, const std::vector<Waterline>& lines,
                                          const Motion& motion) {
  if (lines.empty()) return std::nullopt;
  const Columns columns(body);
  const std::vector<double> weights = weights_mm(lines);
  const std::vector<Samples> areas = areas_mm2(columns, lines);
  SectionsOff off;
  Samples along{};
  double worst_mm3 = -1;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double section_mm3 = weights[k] * area_mm2(lines[k].section);
    off.sections_mm3 += section_mm3;
    for (int s = 0; s < Columns::kSamples; ++s) along[s] += weights[k] * areas[k][s];
    const double difference_mm3 = std::abs(section_mm3 - weights[k] * mean(areas[k]));
    if (difference_mm3 <= worst_mm3) continue;
    worst_mm3 = difference_mm3;
    worst = k;
  }
  off.columns_mm3 = mean(along);
  const double least_mm2 = kLeastLines * columns.cell_mm2() + kLeastLoop_mm2;
  const double most_mm3 = kMostOff * off.columns_mm3 + kStandardErrors * standard_error(along) +
                          least_mm2 * lines.back().immersion_mm;
  if (std::abs(off.sections_mm3 - off.columns_mm3) <= most_mm3) return std::nullopt;
  const Eigen::Vector2d offset = offset_at(motion, lines[worst].immersion_mm);
  off.immersion_mm = lines[worst].immersion_mm;
  off.place_mm = place_of_difference(columns, lines[worst], offset);
  off.triangles = triangles_near(body, off.immersion_mm, off.place_mm - offset);
  return off;
}

}  // namespace hydroprint::waterline
