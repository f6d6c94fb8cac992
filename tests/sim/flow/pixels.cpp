#include "tests/sim/flow/pixels.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/image/texture/raster.h"

namespace hydroprint::flow::reference {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kDirections = 16;
/// The map jumps between two particles if the distance between their landing points is more than
/// this multiple of their distance on the film.
constexpr double kMostStretch = 5;
constexpr double kLeastJump_mm = 0.2;

Vector3d point_in(const waterline::Body& body, int triangle, const Vector3d& barycentric) {
  Vector3d point = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    point += barycentric[i] * body.points_mm[body.triangles[triangle][i]];
  }
  return point;
}

/// Difference on the film between the distance for a small step from a spot of the surface and the
/// expected distance. The map is not defined off the surface, so the step's normal component is
/// added unchanged.
double film_distance_mm(const PixelMap::Spot& spot, const Vector3d& normal, const Vector3d& step_mm,
                        const Vector2d& expected_mm) {
  return (spot.film_per_surface * step_mm - expected_mm).norm() + std::abs(normal.dot(step_mm));
}

Vector3d normal_of(const waterline::Body& body, int triangle) {
  const Eigen::Vector3i& v = body.triangles[triangle];
  const Vector3d& a = body.points_mm[v[0]];
  return (body.points_mm[v[1]] - a).cross(body.points_mm[v[2]] - a).normalized();
}

}  // namespace

PixelMap::PixelMap(const waterline::Body& body, const std::vector<MappedTriangle>& tiles,
                   const image::FilmGrid& grid)
    : body_(body), tiles_(tiles), grid_(grid) {
  tile_.assign(static_cast<std::size_t>(grid.columns) * grid.rows, -1);
  std::vector<float> time_s(tile_.size(), HUGE_VALF);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const image::Corners corners = {grid.cell(tiles[t].film_mm[0]), grid.cell(tiles[t].film_mm[1]),
                                    grid.cell(tiles[t].film_mm[2])};
    const auto& times = tiles[t].contact_time_s;
    image::for_each_sample(
        corners, {0, 0, grid.columns, grid.rows}, [&](int x, int y, const Vector3d& b) {
          const auto time = static_cast<float>(b[0] * times[0] + b[1] * times[1] + b[2] * times[2]);
          const std::size_t i = index({x, y});
          if (!(time < time_s[i])) return;
          time_s[i] = time;
          tile_[i] = static_cast<int>(t);
        });
  }
}

Vector2d PixelMap::film_mm(const Pixel& pixel) const {
  return {grid_.left_mm + (pixel.x() + 0.5) * grid_.pitch_mm,
          grid_.top_mm - (pixel.y() + 0.5) * grid_.pitch_mm};
}

std::optional<PixelMap::Spot> PixelMap::at(const Pixel& pixel) const {
  const int t = tile_[index(pixel)];
  if (t < 0) return std::nullopt;
  const MappedTriangle& tile = tiles_[t];
  const Vector2d film = film_mm(pixel);
  const Vector3d in_tile = image::BarycentricMap(tile.film_mm).at(film.x(), film.y());
  Spot spot{tile.triangle, Vector3d::Zero(), Vector3d::Zero(), Gradient::Zero()};
  std::array<Vector3d, 3> corners;
  for (int i = 0; i < 3; ++i) {
    const Vector3d barycentric = tile.barycentric[i].cast<double>();
    corners[i] = point_in(body_, tile.triangle, barycentric);
    spot.barycentric += in_tile[i] * barycentric;
  }
  spot.point_mm = point_in(body_, tile.triangle, spot.barycentric);
  spot.film_per_surface = gradient_of(tile.film_mm, corners);
  return spot;
}

bool PixelMap::is_at_jump(const Pixel& pixel) const {
  const auto here = at(pixel);
  for (const Pixel& next : {Pixel(pixel + Pixel::UnitX()), Pixel(pixel + Pixel::UnitY())}) {
    if (next.x() >= grid_.columns || next.y() >= grid_.rows) continue;
    const auto there = at(next);
    if (here.has_value() != there.has_value()) return true;
    if (!here) continue;
    const double off_mm =
        film_distance_mm(*here, normal_of(body_, here->triangle), there->point_mm - here->point_mm,
                         film_mm(next) - film_mm(pixel));
    if (off_mm > grid_.pitch_mm) return true;
  }
  return false;
}

PixelComparison::PixelComparison(const PixelMap& map, const waterline::Body& body,
                                 const Particles& particles)
    : map_(map), body_(body), particles_(particles) {}

PixelError PixelComparison::compare(const std::optional<PixelMap::Spot>& spot,
                                    const std::optional<Particles::Contact>& contact,
                                    const Vector2d& offset_mm) const {
  PixelError out;
  out.lands = spot || contact;
  out.is_ruled = contact && !waterline::film_can_follow(normal_of(body_, contact->triangle));
  if (out.is_ruled) return out;
  if (!spot || !contact) {
    out.error_mm = out.lands ? kInfinite : 0;
    return out;
  }
  const Vector3d landed = point_in(body_, contact->triangle, contact->barycentric);
  out.error_mm =
      film_distance_mm(*spot, normal_of(body_, spot->triangle), landed - spot->point_mm, offset_mm);
  return out;
}

bool PixelComparison::are_apart(const std::optional<Particles::Contact>& a,
                                const std::optional<Particles::Contact>& b,
                                double film_distance_mm) const {
  if (!a || !b) return a.has_value() != b.has_value();
  const double apart_mm =
      (point_in(body_, a->triangle, a->barycentric) - point_in(body_, b->triangle, b->barycentric))
          .norm();
  return apart_mm > kMostStretch * film_distance_mm + kLeastJump_mm;
}

PixelError PixelComparison::at(const Pixel& pixel) const {
  return compare(map_.at(pixel), particles_.follow(map_.film_mm(pixel)), Vector2d::Zero());
}

double PixelComparison::moved_mm(const Pixel& pixel, const Particles& others) const {
  const Vector2d film = map_.film_mm(pixel);
  const auto here = particles_.follow(film), there = others.follow(film);
  if (!here && !there) return 0;
  const auto spot = map_.at(pixel);
  if (!here || !there || !spot) return kInfinite;
  const Vector3d step = point_in(body_, there->triangle, there->barycentric) -
                        point_in(body_, here->triangle, here->barycentric);
  return film_distance_mm(*spot, normal_of(body_, spot->triangle), step, Vector2d::Zero());
}

double PixelComparison::jump_distance_mm(const Pixel& pixel) const {
  const auto spot = map_.at(pixel);
  const Vector2d film = map_.film_mm(pixel);
  const double pitch_mm = map_.grid().pitch_mm;
  const auto here = particles_.follow(film);
  const auto agrees = [&](const auto& contact, const Vector2d& offset_mm) {
    const PixelError error = compare(spot, contact, offset_mm);
    return error.is_ruled || error.error_mm <= pitch_mm / 2;
  };
  if (agrees(here, Vector2d::Zero())) return 0;
  for (double radius_mm = pitch_mm / 4; radius_mm < 4; radius_mm *= std::numbers::sqrt2) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kDirections;
      const Vector2d offset = radius_mm * Vector2d(std::cos(angle), std::sin(angle));
      const auto there = particles_.follow(film + offset);
      if (agrees(there, offset) || are_apart(here, there, radius_mm)) return radius_mm;
    }
  }
  return kInfinite;
}

}  // namespace hydroprint::flow::reference
