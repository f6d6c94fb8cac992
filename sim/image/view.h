#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "sim/flow/surface_map.h"
#include "sim/image/picture.h"
#include "sim/image/raster.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// A direction to look at the object from, in parallel projection. Rows of `axes`: right, up and
/// towards the viewer, in the film frame F.
struct View {
  std::string name;
  Eigen::Matrix3d axes;
};

/// Front (from -y), back, three-quarter and from below (where the film takes hold first); +z of F
/// is up.
[[nodiscard]] std::vector<View> standard_views();

/// Size of the object as seen: half the width and height about its middle, mm.
[[nodiscard]] Eigen::Vector2d half_extent_mm(const mesh::Surface& surface, const Pose& X_FO,
                                             const View& view);

/// The object drawn from one side with a depth buffer, shaded by a light over the viewer's left
/// shoulder, each pixel the mean of 2 x 2 samples.
class ViewDrawing {
 public:
  ViewDrawing(const mesh::Surface& surface, const Pose& X_FO, const View& view, int width_px,
              int height_px, double px_per_mm);

  /// Linear colour, before light, of a sample; x and y in samples.
  using Colour = std::function<Eigen::Vector3f(int x, int y)>;

  /// Finds what can be seen of the surface; before anything is drawn on it.
  void place_surface();

  /// Draws tiles on the surface. `colour_of` is asked once a tile with its corners on the grid of
  /// samples and returns the linear colour at a sample from its barycentric coordinates.
  using TileColour = std::function<Eigen::Vector3f(int x, int y, const Eigen::Vector3d&)>;
  using TileColourMaker =
      std::function<TileColour(const flow::MappedTriangle& tile, const Corners& at)>;
  void draw_tiles(const std::vector<flow::MappedTriangle>& tiles, const TileColourMaker& colour_of);

  /// Draws the rest of the surface in colours of the place on the picture.
  void draw_bare(const Colour& colour);

  /// Draws points as discs over what has been drawn, where the surface does not hide them.
  /// @param points_O  a point that lies deeper than `deep_mm` below the surface is hidden
  /// @param colours   linear, one a point
  void draw_points(std::span<const Eigen::Vector3d> points_O,
                   std::span<const Eigen::Vector3f> colours, double radius_mm, double deep_mm);

  /// Puts the drawing, with its outlines, on a picture whose pixels there are background.
  void put_on(RgbImage& picture, int left_px, int top_px) const;

 private:
  struct Sample {
    Eigen::Vector3f colour = Eigen::Vector3f::Constant(NAN);  ///< NaN: nothing drawn yet
    int triangle = -1;           ///< of the surface, that is seen there; -1: background
    float towards = -HUGE_VALF;  ///< place along the view, mm; -infinity: background
  };
  [[nodiscard]] Window window() const { return {0, 0, width_, height_}; }
  /// x and y in samples, z along the view.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point_O) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 3> project(
      const std::array<Eigen::Vector3d, 3>& points_O) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners_of(std::size_t triangle) const;
  /// Of its corners, one a column, as seen.
  [[nodiscard]] Eigen::Matrix3d normals_of(std::size_t triangle) const;
  [[nodiscard]] bool is_outline(int x, int y) const;
  [[nodiscard]] Sample& at(int x, int y) {
    return samples_[static_cast<std::size_t>(y) * width_ + x];
  }
  [[nodiscard]] const Sample& at(int x, int y) const {
    return samples_[static_cast<std::size_t>(y) * width_ + x];
  }

  const mesh::Surface& surface_;
  Eigen::Isometry3d X_VO_;  ///< object to view, mm, about the object's middle
  int width_, height_;      ///< in samples
  double samples_per_mm_;
  double depth_step_mm_;  ///< jumps in depth beyond this are outlines
  std::vector<Sample> samples_;
};

}  // namespace hydroprint::image
