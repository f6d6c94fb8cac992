#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/pipeline/dip.h"
#include "sim/sample/painting.h"
#include "sim/validate/experiments.h"
#include "sim/validate/film_locator.h"
#include "sim/validate/measure.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Assumed standard deviations of the errors of gripper and film, for each axis.
constexpr double kGripper_mm = 0.3, kGripper_deg = 0.3;
constexpr double kFilm_mm = 0.5, kFilm_deg = 0.2;
constexpr unsigned kSeed = 1;
constexpr int kDraws = 12, kQuickDraws = 4;

constexpr double kGrid_mm = 5;
constexpr int kAcross = 20, kAlong = 29;  // grid points on each side of the middle

/// Normally distributed numbers that do not depend on the standard library.
class Dice {
 public:
  double normal() {
    const double u = 1 - uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }

 private:
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  std::mt19937_64 engine_{kSeed};
};

/// Returns the object's pose relative to the film, with random errors of the gripper and of the
/// film.
Pose drawn(const Pose& X_FO, Dice& dice) {
  const Vector3d turn =
      kGripper_deg * kDegree * Vector3d(dice.normal(), dice.normal(), dice.normal());
  const Vector3d shift(kGripper_mm * dice.normal(), kGripper_mm * dice.normal(), 0);
  Pose held = X_FO;
  held.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * X_FO.linear();
  held.translation() += shift;
  Pose film(Eigen::AngleAxisd(kFilm_deg * kDegree * dice.normal(), Vector3d::UnitZ()));
  film.pretranslate(Vector3d(kFilm_mm * dice.normal(), kFilm_mm * dice.normal(), 0));
  return film.inverse() * held;
}

/// Returns the film's grid points, row by row from the bottom.
std::vector<Vector2d> grid() {
  std::vector<Vector2d> points;
  for (int j = -kAlong; j <= kAlong; ++j) {
    for (int i = -kAcross; i <= kAcross; ++i) points.emplace_back(kGrid_mm * i, kGrid_mm * j);
  }
  return points;
}

/// Standard deviation of positions: root of the sum of the variances of x, y and z.
double scatter(const std::vector<Vector3d>& places) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : places) mean += p / static_cast<double>(places.size());
  double sum = 0;
  for (const Vector3d& p : places) sum += (p - mean).squaredNorm();
  return std::sqrt(sum / static_cast<double>(places.size() - 1));
}

/// Interpolates values at the grid points bilinearly; NaN if one of the four values is missing.
double between(const std::vector<double>& values, const Vector2d& film_mm) {
  constexpr int kColumns = 2 * kAcross + 1, kRows = 2 * kAlong + 1;
  const double x = film_mm.x() / kGrid_mm + kAcross, y = film_mm.y() / kGrid_mm + kAlong;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  if (!(x >= 0 && y >= 0) || i + 1 >= kColumns || j + 1 >= kRows) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double u = x - i, v = y - j;
  const auto at = [&](int column, int row) { return values[row * kColumns + column]; };
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

image::RgbImage chessboard() {
  constexpr double kMmPerPx = 0.25;
  return sample::draw(840, 1188, kMmPerPx, 2, [](double x, double y) -> sample::Colour {
    const bool dark = sample::is_dark_square(x - 105, y - 148.5, 2 * kGrid_mm);
    return dark ? sample::Colour(0.10F, 0.22F, 0.42F) : sample::Colour(0.97F, 0.94F, 0.86F);
  });
}

}  // namespace

Status repeatability(ExperimentContext& setup, Experiment& out, const Context& context) {
  const int draws = setup.quick() ? kQuickDraws : kDraws;
  out.text = {
      fmt::format(
          "The paper prints the same chessboard on the same face several times and finds it in the "
          "same places. Here the same film, with a grid of 5 mm, is dipped {} times onto the globe "
          "(radius 60 mm). Each dip has different random errors of the gripper and of the film's "
          "position. The figure is the spread of the positions where each grid point lands.",
          draws),
      fmt::format("Assumed standard deviations (normal distribution, for each axis; seed {}): "
                  "gripper 0.3 mm sideways and 0.3 degrees about each axis; film 0.5 mm along and "
                  "across, and 0.2 degrees in its plane. Each dip is computed with Stokes flow, "
                  "which is fast, and accurate enough for the difference of two similar dips.",
                  kSeed)};
  Steps steps(context, out.name, draws + 1);
  HP_ASSIGN_OR_RETURN(const Body* body, setup.body("globe", context));
  pipeline::DipOptions options = setup.options(*body, Fineness::kUsual);
  options.film_model = pipeline::FilmModel::kStokes;
  options.map.tolerance_mm = 0.1;
  options.map.least_edge_mm = 0.2;
  const Context first = steps.next();
  HP_ASSIGN_OR_RETURN(const pipeline::Dip planned, pipeline::dip(body->model, options, first));

  const std::vector<Vector2d> points = grid();
  std::vector<std::vector<Vector3d>> landed(points.size());
  // Landing points of the film's middle, which do not depend on the flow.
  std::vector<Vector3d> contacts;
  Dice dice;
  for (int draw = 0; draw < draws; ++draw) {
    const Context next = steps.next();
    options.X_FO = drawn(body->X_FO, dice);
    HP_ASSIGN_OR_RETURN(const pipeline::Dip dip, pipeline::dip(body->model, options, next));
    const FilmLocator locator(dip.surface, dip.map.tiles);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (const auto place = locator.at(points[i])) landed[i].push_back(*place);
    }
    // Near the lowest point, film lands without stretching, at a distance equal to the chord: r0 =
    // 2 R sin(theta / 2).
    const Vector3d middle(-dip.X_FO.translation().x(), -dip.X_FO.translation().y(), 0);
    const double sag = kGlobe_mm - middle.squaredNorm() / (2 * kGlobe_mm);
    contacts.emplace_back(dip.X_FO.linear().transpose() * (middle - sag * Vector3d::UnitZ()));
  }

  std::vector<double> spread(points.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> theta(points.size(), 1e9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (landed[i].size() != static_cast<std::size_t>(draws)) continue;
    spread[i] = scatter(landed[i]);
    theta[i] = theta_deg(landed[i].front());
  }
  Table table{
      "Spread of the landing (root of the sum of the variances along x, y and z)",
      {"angle to the water", "grid points", "median, mm", "95th percentile, mm", "largest, mm"},
      {}};
  const auto summary = [&](double from_deg, double to_deg) {
    std::vector<double> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (theta[i] >= from_deg && theta[i] < to_deg) values.push_back(spread[i]);
    }
    return summarise(values);
  };
  for (const auto& [from, to] :
       std::vector<std::pair<int, int>>{{0, 60}, {60, 90}, {90, 120}, {120, 150}}) {
    const Summary s = summary(from, to);
    table.rows.push_back({fmt::format("{} to {} degrees", from, to), std::to_string(s.count),
                          text_of(s.p50, 2), text_of(s.p95, 2), text_of(s.max, 2)});
  }
  out.tables.push_back(std::move(table));
  const std::size_t middle = points.size() / 2;
  out.figures.push_back({"spread_to_equator_p95_mm",
                         "spread of the grid points to the equator (95th percentile)", "mm",
                         summary(0, 90).p95,
                         Limit{0, 2,
                               "the paper's largest error to the equator, which also includes "
                               "these errors"}});
  out.figures.push_back({"spread_at_contact_mm", "spread where the object first touches the film",
                         "mm", spread[middle], std::nullopt});
  out.figures.push_back(
      {"spread_at_contact_ratio", "the same, relative to the spread of the random errors", "",
       spread[middle] / scatter(contacts),
       Limit{0.97, 1.03, "the film has not moved yet, so the two spreads are equal"}});

  HP_ASSIGN_OR_RETURN(const auto film, setup.texture(chessboard(), first));
  HP_ASSIGN_OR_RETURN(const auto views,
                      image::find_views(planned.surface, planned.X_FO, planned.map.tiles, first));
  HP_RETURN_IF_ERROR(setup.show(out, "chessboard", image::predicted_picture(views, film, first),
                                "The film's chessboard of 10 mm, landed without errors."));
  image::Quantity quantity{"spread mm", spread, 0, 0.1, [&](const flow::MappedTriangle& tile) {
                             std::array<double, 3> values{};
                             for (int i = 0; i < 3; ++i)
                               values[i] = between(spread, tile.film_mm[i]);
                             return values;
                           }};
  return setup.show(out, "spread", image::quantity_picture(views, quantity, first),
                    "Spread of the landing with random errors; hatched: no film in some dips.");
}

}  // namespace hydroprint::validate
