#include "sim/image/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/image/colour.h"
#include "sim/image/stretch.h"

namespace hydroprint::image {
namespace {

constexpr int kSupersample = 2;
constexpr float kOutlineShade = 0.35F;

/// A view from a direction given by azimuth (0: from -y, counter-clockwise seen from above) and
/// elevation.
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

/// How bright a surface with that normal is, seen along z.
float light(Eigen::Vector3d normal) {
  static const Eigen::Vector3d key = Eigen::Vector3d(-0.45, 0.65, 0.9).normalized();
  const double length = normal.norm();
  if (!(length > 0)) return 1;
  normal /= normal.z() < 0 ? -length : length;  // faces turned inside out are lit as well
  const double lit = std::max(0.0, normal.dot(key));
  return static_cast<float>(std::min(1.0, 0.5 + 0.08 * normal.y() + 0.47 * lit));
}

/// Calls visit(x, y, towards, map) for every sample inside a triangle, with its place along the
/// view.
/// @param corners  x and y in samples, z along the view
template <class Visit>
void for_each_place(const std::array<Eigen::Vector3d, 3>& corners, const Window& window,
                    Visit&& visit) {
  const BarycentricMap map({corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()});
  const Eigen::Vector3d depth(corners[0].z(), corners[1].z(), corners[2].z());
  const double origin = map.at(0.5, 0.5).dot(depth);
  const double per_x = map.per_x().dot(depth), per_y = map.per_y().dot(depth);
  for_each_span({corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()}, window,
                [&](int y, int begin, int end) {
                  const double row = origin + per_y * y;
                  for (int x = begin; x < end; ++x) {
                    visit(x, y, static_cast<float>(row + per_x * x), map);
                  }
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

ViewDrawing::ViewDrawing(const mesh::Surface& surface, const Pose& X_FO, const View& view,
                         int width_px, int height_px, double px_per_mm)
    : surface_(surface),
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
}

Eigen::Vector3d ViewDrawing::project(const Eigen::Vector3d& point_O) const {
  const Eigen::Vector3d p = X_VO_ * point_O;
  return {0.5 * width_ + p.x() * samples_per_mm_, 0.5 * height_ - p.y() * samples_per_mm_, p.z()};
}

std::array<Eigen::Vector3d, 3> ViewDrawing::project(
    const std::array<Eigen::Vector3d, 3>& points_O) const {
  std::array<Eigen::Vector3d, 3> out;
  std::transform(points_O.begin(), points_O.end(), out.begin(),
                 [&](const Eigen::Vector3d& p) { return project(p); });
  return out;
}

std::array<Eigen::Vector3d, 3> ViewDrawing::corners_of(std::size_t triangle) const {
  const Eigen::Vector3i& v = surface_.triangles[triangle];
  return project({surface_.points[v[0]], surface_.points[v[1]], surface_.points[v[2]]});
}

Eigen::Matrix3d ViewDrawing::normals_of(std::size_t triangle) const {
  const auto& n = surface_.corner_normals[triangle];
  Eigen::Matrix3d out;
  out << n[0], n[1], n[2];
  return X_VO_.linear() * out;
}

void ViewDrawing::place_surface() {
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    for_each_place(corners_of(t), window(), [&](int x, int y, float towards, const auto&) {
      Sample& sample = at(x, y);
      if (towards <= sample.towards) return;
      sample.towards = towards;
      sample.triangle = static_cast<int>(t);
    });
  }
}

void ViewDrawing::draw_tiles(const std::vector<flow::MappedTriangle>& tiles,
                             const TileColourMaker& colour_of) {
  const float behind_mm = static_cast<float>(0.02 * depth_step_mm_);
  for (const flow::MappedTriangle& tile : tiles) {
    const auto corners = project(tile_points(surface_, tile));
    Eigen::Matrix3d normals;
    TileColour colour;  // made when the first sample turns out to be visible
    for_each_place(corners, window(), [&](int x, int y, float towards, const auto& map) {
      Sample& sample = at(x, y);
      if (towards < sample.towards - behind_mm) return;
      if (!colour) {
        colour =
            colour_of(tile, {corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()});
        Eigen::Matrix3d barycentric;
        for (int i = 0; i < 3; ++i) {
          for (int k = 0; k < 3; ++k) barycentric(k, i) = tile.barycentric[i][k];
        }
        normals = normals_of(static_cast<std::size_t>(tile.triangle)) * barycentric;
      }
      const Eigen::Vector3d b = map.at(x + 0.5, y + 0.5);
      sample.colour = colour(x, y, b) * light(normals * b);
    });
  }
}

void ViewDrawing::draw_bare(const Colour& colour) {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      Sample& sample = at(x, y);
      if (sample.triangle < 0 || !std::isnan(sample.colour.x())) continue;
      const auto triangle = static_cast<std::size_t>(sample.triangle);
      const auto corners = corners_of(triangle);
      const BarycentricMap map({corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()});
      sample.colour = colour(x, y) * light(normals_of(triangle) * map.at(x + 0.5, y + 0.5));
    }
  }
}

void ViewDrawing::draw_points(std::span<const Eigen::Vector3d> points_O,
                              std::span<const Eigen::Vector3f> colours, double radius_mm,
                              double deep_mm) {
  const double radius = radius_mm * samples_per_mm_;
  for (std::size_t i = 0; i < points_O.size(); ++i) {
    const Eigen::Vector3d middle = project(points_O[i]);
    const auto first = [&](double at) { return static_cast<int>(std::ceil(at - radius - 0.5)); };
    for (int y = std::max(0, first(middle.y())); y < height_ && y + 0.5 < middle.y() + radius;
         ++y) {
      for (int x = std::max(0, first(middle.x())); x < width_ && x + 0.5 < middle.x() + radius;
           ++x) {
        if (std::hypot(x + 0.5 - middle.x(), y + 0.5 - middle.y()) > radius) continue;
        Sample& sample = at(x, y);
        if (middle.z() < sample.towards - deep_mm) continue;
        sample.colour = colours[i];
        if (sample.triangle < 0) sample.towards = static_cast<float>(middle.z());
      }
    }
  }
}

bool ViewDrawing::is_outline(int x, int y) const {
  const float here = at(x, y).towards;
  const auto is_far_behind = [&](int nx, int ny) {
    if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) return true;
    return here - at(nx, ny).towards > static_cast<float>(depth_step_mm_);
  };
  return is_far_behind(x - 1, y) || is_far_behind(x + 1, y) || is_far_behind(x, y - 1) ||
         is_far_behind(x, y + 1);
}

void ViewDrawing::put_on(RgbImage& picture, int left_px, int top_px) const {
  constexpr int kSamples = kSupersample * kSupersample;
  for (int y = 0; y < height_ / kSupersample; ++y) {
    for (int x = 0; x < width_ / kSupersample; ++x) {
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
