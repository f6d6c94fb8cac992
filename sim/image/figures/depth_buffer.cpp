#include "sim/image/figures/depth_buffer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/image/film/stretch.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

constexpr int kSupersample = 2;
constexpr float kOutlineShade = 0.35F;

/// Returns a view from a direction given by azimuth (0: from -y, counter-clockwise seen from above)
/// and elevation.
View view_from(std::string name, double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * M_PI / 180, elevation = elevation_deg * M_PI / 180;
  const Eigen::Vector3d right(std::cos(azimuth), std::sin(azimuth), 0);
  const Eigen::Vector3d towards(std::sin(azimuth) * std::cos(elevation),
                                -std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
  View view{std::move(name), Eigen::Matrix3d()};
  view.axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return view;
}

struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-HUGE_VAL);
};

Box box_in(const mesh::Surface& surface, const Eigen::Matrix3d& rotation) {
  Box box;
  for (const auto& point : surface.points) {
    const Eigen::Vector3d p = rotation * point;
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

/// Brightness of a surface with this normal, seen along z.
float light(Eigen::Vector3d normal) {
  static const Eigen::Vector3d key = Eigen::Vector3d(-0.45, 0.65, 0.9).normalized();
  const double length = normal.norm();
  if (!(length > 0)) return 1;
  normal /= normal.z() < 0 ? -length : length;  // faces turned inside out are lit as well
  const double lit = std::max(0.0, normal.dot(key));
  return static_cast<float>(std::min(1.0, 0.5 + 0.08 * normal.y() + 0.47 * lit));
}

Corners flat(const std::array<Eigen::Vector3d, 3>& corners) {
  return {corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()};
}

/// Calls visit(x, y, towards) for every sample inside a triangle; `towards` is the position of the
/// sample along the view.
/// @param corners  x and y in samples, z along the view
template <class Visit>
void for_each_place(const std::array<Eigen::Vector3d, 3>& corners, const Window& window,
                    Visit&& visit) {
  const Corners at = flat(corners);
  bool is_first = true;  // depths are set up on demand: most tiles have no sample
  double origin = 0, per_x = 0, per_y = 0;
  for_each_span(at, window, [&](int y, int begin, int end) {
    if (std::exchange(is_first, false)) {
      const BarycentricMap map(at);
      const Eigen::Vector3d depth(corners[0].z(), corners[1].z(), corners[2].z());
      origin = map.at(0.5, 0.5).dot(depth);
      per_x = map.per_x().dot(depth);
      per_y = map.per_y().dot(depth);
    }
    const double row = origin + per_y * y;
    for (int x = begin; x < end; ++x) visit(x, y, static_cast<float>(row + per_x * x));
  });
}

}  // namespace

std::vector<View> standard_views() {
  return {view_from("front", 0, 8), view_from("back", 180, 8), view_from("three-quarter", 40, 28),
          view_from("from below", 0, -75)};
}

Eigen::Vector2d half_extent_mm(const mesh::Surface& surface, const Pose& X_FO, const View& view) {
  const Box box = box_in(surface, view.axes * X_FO.rotation());
  return 0.5 * (box.high - box.low).head<2>();
}

SeenObject::SeenObject(const mesh::Surface& surface, const Pose& X_FO,
                       std::span<const flow::MappedTriangle> tiles, const View& view, int width_px,
                       int height_px, double px_per_mm)
    : surface_(surface),
      tiles_(tiles),
      X_VO_(Eigen::Isometry3d::Identity()),
      width_(width_px * kSupersample),
      height_(height_px * kSupersample),
      samples_per_mm_(px_per_mm * kSupersample),
      samples_(static_cast<std::size_t>(width_) * height_) {
  const Eigen::Matrix3d rotation = view.axes * X_FO.rotation();
  const Box box = box_in(surface, rotation);
  X_VO_.linear() = rotation;
  X_VO_.translation() = -0.5 * (box.low + box.high);
  depth_step_mm_ = 0.04 * (box.high - box.low).maxCoeff();
  const std::vector<int> triangles = place_surface();
  place_tiles();
  sort_by_tile();
  light_tiles();
  light_bare(triangles);
}

SeenObject::SeenTile SeenObject::seen_tile(std::size_t i) const {
  const std::span<const int> all(by_tile_);
  return {tiles_[tile_numbers_[i]],
          all.subspan(first_of_tile_[i], first_of_tile_[i + 1] - first_of_tile_[i])};
}

Eigen::Vector3d SeenObject::project(const Eigen::Vector3d& point_O) const {
  const Eigen::Vector3d p = X_VO_ * point_O;
  return {0.5 * width_ + p.x() * samples_per_mm_, 0.5 * height_ - p.y() * samples_per_mm_, p.z()};
}

std::array<Eigen::Vector3d, 3> SeenObject::tile_corners(const flow::MappedTriangle& tile) const {
  const auto points = tile_points(surface_, tile);
  return {project(points[0]), project(points[1]), project(points[2])};
}

std::array<Eigen::Vector3d, 3> SeenObject::corners_of(std::size_t triangle) const {
  const Eigen::Vector3i& v = surface_.triangles[triangle];
  return {project(surface_.points[v[0]]), project(surface_.points[v[1]]),
          project(surface_.points[v[2]])};
}

Eigen::Matrix3d SeenObject::normals_of(std::size_t triangle) const {
  const auto& n = surface_.corner_normals[triangle];
  Eigen::Matrix3d out;
  out << n[0], n[1], n[2];
  return X_VO_.linear() * out;
}

std::vector<int> SeenObject::place_surface() {
  std::vector<int> triangles(samples_.size(), -1);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    for_each_place(corners_of(t), window(), [&](int x, int y, float towards) {
      Sample& sample = samples_[index(x, y)];
      if (towards <= sample.towards) return;
      sample.towards = towards;
      triangles[index(x, y)] = static_cast<int>(t);
    });
  }
  return triangles;
}

void SeenObject::place_tiles() {
  const auto behind_mm = static_cast<float>(0.02 * depth_step_mm_);
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    for_each_place(tile_corners(tiles_[t]), window(), [&](int x, int y, float towards) {
      Sample& sample = samples_[index(x, y)];
      if (towards >= sample.towards - behind_mm) sample.tile = static_cast<int>(t);
    });
  }
}

void SeenObject::sort_by_tile() {
  std::vector<int> count(tiles_.size(), 0);
  for (const Sample& sample : samples_) {
    if (sample.tile >= 0) ++count[sample.tile];
  }
  std::vector<int> next(tiles_.size(), 0);
  int first = 0;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (count[t] == 0) continue;
    tile_numbers_.push_back(static_cast<int>(t));
    first_of_tile_.push_back(next[t] = first);
    first += count[t];
  }
  first_of_tile_.push_back(first);
  by_tile_.resize(first);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (samples_[i].tile >= 0) by_tile_[next[samples_[i].tile]++] = static_cast<int>(i);
  }
}

void SeenObject::light_tiles() {
  for (std::size_t i = 0; i < seen_tiles(); ++i) {
    const auto [tile, samples] = seen_tile(i);
    const BarycentricMap map(flat(tile_corners(tile)));
    Eigen::Matrix3d barycentric;
    for (int c = 0; c < 3; ++c) barycentric.col(c) = tile.barycentric[c].cast<double>();
    const Eigen::Matrix3d normals = normals_of(tile.triangle) * barycentric;
    for (const int s : samples) {
      samples_[s].light = light(normals * map.at(s % width_ + 0.5, s / width_ + 0.5));
    }
  }
}

void SeenObject::light_bare(const std::vector<int>& triangles) {
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    if (samples_[s].is_background() || samples_[s].tile >= 0) continue;
    const auto i = static_cast<int>(s);
    const BarycentricMap map(flat(corners_of(triangles[s])));
    samples_[s].light =
        light(normals_of(triangles[s]) * map.at(i % width_ + 0.5, i / width_ + 0.5));
  }
}

ViewDrawing::ViewDrawing(const SeenObject& seen) : seen_(seen) {
  samples_.reserve(seen.samples().size());
  for (const SeenObject::Sample& sample : seen.samples()) {
    samples_.push_back({Eigen::Vector3f::Zero(), sample.towards});
  }
}

void ViewDrawing::draw_tiles(const TileColourMaker& colour_of) {
  for (std::size_t i = 0; i < seen_.seen_tiles(); ++i) {
    const auto [tile, samples] = seen_.seen_tile(i);
    const Corners at = flat(seen_.tile_corners(tile));
    const BarycentricMap map(at);
    const TileColour colour = colour_of(tile, at);
    for (const int s : samples) {
      const int x = s % seen_.width(), y = s / seen_.width();
      samples_[s].colour = colour(x, y, map.at(x + 0.5, y + 0.5)) * seen_.samples()[s].light;
    }
  }
}

void ViewDrawing::draw_bare(const Colour& colour) {
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    const SeenObject::Sample& sample = seen_.samples()[s];
    if (sample.is_background() || sample.tile >= 0) continue;
    const auto i = static_cast<int>(s);
    samples_[s].colour = colour(i % seen_.width(), i / seen_.width()) * sample.light;
  }
}

void ViewDrawing::draw_points(std::span<const Eigen::Vector3d> points_O,
                              std::span<const Eigen::Vector3f> colours, double radius_mm,
                              double deep_mm) {
  HP_CHECK(colours.size() == points_O.size());
  HP_CHECK(radius_mm > 0);
  const double radius = radius_mm * seen_.samples_per_mm();
  for (std::size_t i = 0; i < points_O.size(); ++i) {
    const Eigen::Vector3d middle = seen_.project(points_O[i]);
    const auto first = [&](double at) { return static_cast<int>(std::ceil(at - radius - 0.5)); };
    for (int y = std::max(0, first(middle.y()));
         y < seen_.height() && y + 0.5 < middle.y() + radius; ++y) {
      for (int x = std::max(0, first(middle.x()));
           x < seen_.width() && x + 0.5 < middle.x() + radius; ++x) {
        if (std::hypot(x + 0.5 - middle.x(), y + 0.5 - middle.y()) > radius) continue;
        Sample& sample = at(x, y);
        if (middle.z() < sample.towards - deep_mm) continue;
        sample.colour = colours[i];
        const auto s = static_cast<std::size_t>(y) * seen_.width() + x;
        if (seen_.samples()[s].is_background()) sample.towards = static_cast<float>(middle.z());
      }
    }
  }
}

bool ViewDrawing::is_outline(int x, int y) const {
  const float here = at(x, y).towards;
  const auto is_far_behind = [&](int nx, int ny) {
    if (nx < 0 || ny < 0 || nx >= seen_.width() || ny >= seen_.height()) return true;
    return here - at(nx, ny).towards > static_cast<float>(seen_.depth_step_mm());
  };
  return is_far_behind(x - 1, y) || is_far_behind(x + 1, y) || is_far_behind(x, y - 1) ||
         is_far_behind(x, y + 1);
}

void ViewDrawing::put_on(RgbImage& picture, int left_px, int top_px) const {
  constexpr int kSamples = kSupersample * kSupersample;
  for (int y = 0; y < seen_.height() / kSupersample; ++y) {
    for (int x = 0; x < seen_.width() / kSupersample; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int behind = 0;
      for (int s = 0; s < kSamples; ++s) {
        const int sx = kSupersample * x + s % kSupersample;
        const int sy = kSupersample * y + s / kSupersample;
        const Sample& sample = at(sx, sy);
        if (sample.towards == -HUGE_VALF) {
          ++behind;
        } else {
          sum += sample.colour * (is_outline(sx, sy) ? kOutlineShade : 1.0F);
        }
      }
      if (behind == kSamples) continue;
      std::uint8_t* out = picture.at(left_px + x, top_px + y);
      if (behind > 0) {
        const Eigen::Vector3f coded = Eigen::Vector3f(out[0], out[1], out[2]) / 255.0F;
        sum += static_cast<float>(behind) * linear_from_srgb(coded);
      }
      for (int c = 0; c < 3; ++c) out[c] = srgb8_from_linear(sum[c] / kSamples);
    }
  }
}

}  // namespace hydroprint::image
