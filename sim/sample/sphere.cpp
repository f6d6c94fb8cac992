#include <cmath>
#include <numbers>

#include "sim/sample/painting.h"
#include "sim/sample/textured_mesh.h"

namespace hydroprint::sample {
namespace {

using std::numbers::pi;
constexpr double kDegree = pi / 180;

/// Returns a sphere of meridians and parallels with an equirectangular map. u runs east from 180 W,
/// and v north from the south pole, which is the lowest point.
TexturedMesh make_sphere(double radius_mm, int meridians, int parallels) {
  TexturedMesh mesh;
  const auto position = [&](int i, int j) {
    const double latitude = pi * (static_cast<double>(j) / parallels - 0.5);
    const double longitude = 2 * pi * (static_cast<double>(i) / meridians - 0.5);
    return Eigen::Vector3d(radius_mm * std::cos(latitude) * std::cos(longitude),
                           radius_mm * std::cos(latitude) * std::sin(longitude),
                           radius_mm * std::sin(latitude));
  };
  const int south = mesh.add_vertex({0, 0, -radius_mm});
  for (int j = 1; j < parallels; ++j)
    for (int i = 0; i < meridians; ++i) mesh.add_vertex(position(i, j));
  const int north = mesh.add_vertex({0, 0, radius_mm});
  for (int j = 1; j < parallels; ++j)
    for (int i = 0; i <= meridians; ++i)
      mesh.add_uv({static_cast<double>(i) / meridians, static_cast<double>(j) / parallels});

  const auto corner = [&](int i, int j) -> TexturedMesh::Corner {
    return {1 + (j - 1) * meridians + i % meridians, (j - 1) * (meridians + 1) + i};
  };
  for (int i = 0; i < meridians; ++i) {
    const double middle = (i + 0.5) / meridians;  // a pole has its own u in each triangle
    mesh.add_face({{south, mesh.add_uv({middle, 0})}, corner(i + 1, 1), corner(i, 1)});
    for (int j = 1; j + 1 < parallels; ++j)
      mesh.add_face({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    const int top = parallels - 1;
    mesh.add_face({corner(i, top), corner(i + 1, top), {north, mesh.add_uv({middle, 1})}});
  }
  return mesh;
}

struct Place {
  double longitude_deg;
  double latitude_deg;
  Eigen::Vector3d direction;
};

Place place_at(double x_deg, double y_deg) {
  const double longitude = x_deg - 180;
  const double latitude = y_deg - 90;
  return {
      longitude,
      latitude,
      {std::cos(latitude * kDegree) * std::cos(longitude * kDegree),
       std::cos(latitude * kDegree) * std::sin(longitude * kDegree), std::sin(latitude * kDegree)}};
}

/// Returns the coverage, in [0, 1], of a place by the meridians and parallels every `spacing_deg`,
/// with lines `width_deg` wide.
double on_graticule(const Place& p, double spacing_deg, double width_deg) {
  const double shrink = std::cos(p.latitude_deg * kDegree);
  const double distance = std::min(to_nearest_line(p.longitude_deg, spacing_deg) * shrink,
                                   to_nearest_line(p.latitude_deg, spacing_deg));
  return 1 - ramp(0.35 * width_deg, 0.65 * width_deg, distance);
}

/// Draws the equator in red, the prime meridian in blue, and a disc with a ring on each pole, red
/// in the north and gold in the south.
Colour with_marks(Colour colour, const Place& p) {
  const double shrink = std::cos(p.latitude_deg * kDegree);
  const double equator = 1 - ramp(0.25, 0.5, std::abs(p.latitude_deg));
  const double greenwich = 1 - ramp(0.25, 0.5, std::abs(p.longitude_deg) * shrink);
  colour = mix(colour, {0.85F, 0.16F, 0.12F}, equator);
  colour = mix(colour, {0.12F, 0.30F, 0.85F}, greenwich);
  const double from_pole = 90 - std::abs(p.latitude_deg);
  const Colour mark =
      p.latitude_deg > 0 ? Colour(0.85F, 0.10F, 0.12F) : Colour(0.95F, 0.72F, 0.10F);
  const double disc = 1 - ramp(2.3, 2.7, from_pole);
  const double ring = 1 - ramp(0.3, 0.7, std::abs(from_pole - 4.5));
  return mix(colour, mark, std::max(disc, ring));
}

Colour ocean(double depth) {
  const Colour shelf(0.32F, 0.66F, 0.78F);
  const Colour deep(0.03F, 0.15F, 0.36F);
  return mix(shelf, deep, ramp(0, 0.55, depth));
}

Colour land(const Place& p, double height) {
  const double latitude = std::abs(p.latitude_deg) + 6 * noise(5 * p.direction, 3);
  const Colour jungle(0.13F, 0.42F, 0.16F);
  const Colour desert(0.84F, 0.72F, 0.45F);
  const Colour forest(0.24F, 0.48F, 0.22F);
  const Colour tundra(0.56F, 0.56F, 0.44F);
  Colour colour = mix(jungle, desert, ramp(9, 19, latitude));
  colour = mix(colour, forest, ramp(29, 39, latitude));
  colour = mix(colour, tundra, ramp(52, 64, latitude));
  colour = mix(colour, {0.50F, 0.38F, 0.27F}, 0.8 * ramp(0.3, 0.7, height));
  return mix(colour, {0.97F, 0.97F, 0.98F}, ramp(0.8, 0.9, height));
}

Colour globe_colour(double x_deg, double y_deg) {
  const Place p = place_at(x_deg, y_deg);
  const Eigen::Vector3d warp(noise(2 * p.direction, 2),
                             noise(2 * p.direction + Eigen::Vector3d(9, 9, 9), 2), 0);
  const double height = noise(1.7 * p.direction + 0.35 * warp + Eigen::Vector3d(3, 1, 4), 6) - 0.12;
  Colour colour = height > 0 ? land(p, height) : ocean(-height);
  colour = mix(colour, {0.96F, 0.93F, 0.80F}, 0.8 * (1 - ramp(0, 0.018, std::abs(height))));
  if (std::abs(p.latitude_deg) > 55) {
    const double ice = std::abs(p.latitude_deg) + 5 * noise(6 * p.direction, 4);
    colour = mix(colour, {0.95F, 0.97F, 1.0F}, ramp(71, 74, ice));
  }
  colour = mix(colour, {1, 1, 1}, 0.55 * on_graticule(p, 15, 0.3));
  return with_marks(colour, p);
}

Colour chessboard_colour(double x_deg, double y_deg) {
  const Place p = place_at(x_deg, y_deg);
  const Colour dark =
      p.latitude_deg > 0 ? Colour(0.10F, 0.22F, 0.42F) : Colour(0.10F, 0.36F, 0.28F);
  const Colour light(0.97F, 0.94F, 0.86F);
  Colour colour = is_dark_square(x_deg, y_deg, 15) ? dark : light;
  colour = mix(colour, {0.55F, 0.55F, 0.55F}, on_graticule(p, 5, 0.25));
  return with_marks(colour, p);
}

Sample make(double radius_mm, int meridians, int height_px, int samples,
            Colour (*colour)(double, double)) {
  Sample sample;
  sample.mesh = make_sphere(radius_mm, meridians, meridians / 2);
  sample.texture = draw(2 * height_px, height_px, 180.0 / height_px, samples, colour);
  sample.px_per_mm = height_px / (pi * radius_mm);
  return sample;
}

}  // namespace

Sample make_globe() { return make(60, 288, 1280, 1, globe_colour); }

Sample make_sphere80() { return make(80, 360, 1280, 2, chessboard_colour); }

}  // namespace hydroprint::sample
