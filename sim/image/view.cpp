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

float ViewDrawing::light(const Eigen::Vector3d& normal_O) const {
  static const Eigen::Vector3d key = Eigen::Vector3d(-0.45, 0.65, 0.9).normalized();
  Eigen::Vector3d normal = (X_VO_.linear() * normal_O).normalized();
  if (!normal.allFinite()) return 1;
  if (normal.z() < 0) normal = -normal;  // faces turned inside out are lit as well
  const double lit = std::max(0.0, normal.dot(key));
  return static_cast<float>(std::min(1.0, 0.5 + 0.08 * normal.y() + 0.47 * lit));
}

void ViewDrawing::draw_surface(const Colour& colour) {
  const Window window{0, 0, width_, height_};
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    Corners at;
    Eigen::Vector3d depth;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d p = project(surface_.points[surface_.triangles[t][i]]);
      at[i] = p.head<2>();
      depth[i] = p.z();
    }
    const auto& n = surface_.corner_normals[t];
    for_each_sample(at, window, [&](int x, int y, const Eigen::Vector3d& b) {
      Sample& sample = this->at(x, y);
      const auto towards = static_cast<float>(b.dot(depth));
      if (towards <= sample.towards) return;
      sample.towards = towards;
      sample.colour = colour(x, y) * light(b[0] * n[0] + b[1] * n[1] + b[2] * n[2]);
    });
  }
}

void ViewDrawing::draw_tiles(const std::vector<flow::MappedTriangle>& tiles,
                             const TileColourMaker& colour_of) {
  const Window window{0, 0, width_, height_};
  const float behind_mm = static_cast<float>(0.02 * depth_step_mm_);
  for (const flow::MappedTriangle& tile : tiles) {
    const auto points = tile_points(surface_, tile);
    Corners at;
    Eigen::Vector3d depth;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d p = project(points[i]);
      at[i] = p.head<2>();
      depth[i] = p.z();
    }
    const auto& corner_normals = surface_.corner_normals[tile.triangle];
    std::array<Eigen::Vector3d, 3> n;
    for (int i = 0; i < 3; ++i) {
      n[i].setZero();
      for (int k = 0; k < 3; ++k) {
        n[i] += static_cast<double>(tile.barycentric[i][k]) * corner_normals[k];
      }
    }
    TileColour colour;  // made when the first sample turns out to be visible
    for_each_sample(at, window, [&](int x, int y, const Eigen::Vector3d& b) {
      Sample& sample = this->at(x, y);
      if (static_cast<float>(b.dot(depth)) < sample.towards - behind_mm) return;
      if (!colour) colour = colour_of(tile, at);
      sample.colour = colour(x, y, b) * light(b[0] * n[0] + b[1] * n[1] + b[2] * n[2]);
    });
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
  constexpr float kShare = 1.0F / (kSupersample * kSupersample);
  for (int y = 0; y < height_ / kSupersample; ++y) {
    for (int x = 0; x < width_ / kSupersample; ++x) {
      std::uint8_t* out = picture.at(left_px + x, top_px + y);
      const Eigen::Vector3f behind =
          linear_from_srgb(Eigen::Vector3f(Eigen::Vector3f(out[0], out[1], out[2]) / 255.0F));
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int s = 0; s < kSupersample * kSupersample; ++s) {
        const int sx = kSupersample * x + s % kSupersample;
        const int sy = kSupersample * y + s / kSupersample;
        const Sample& sample = at(sx, sy);
        if (sample.towards == -HUGE_VALF) {
          sum += behind;
        } else {
          sum += sample.colour * (is_outline(sx, sy) ? kOutlineShade : 1.0F);
        }
      }
      for (int c = 0; c < 3; ++c) out[c] = srgb8_from_linear(sum[c] * kShare);
    }
  }
}

}  // namespace hydroprint::image
