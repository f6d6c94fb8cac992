#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "sim/flow/surface_map.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/texture/raster.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// A direction from which to view the object, in parallel projection. Rows of `axes`: right, up and
/// towards the viewer, in the film frame F.
struct View {
  std::string name;
  Eigen::Matrix3d axes;
};

/// Returns the standard views: front (from -y), back, three-quarter and from below (the side that
/// touches the film first); +z of F is up.
[[nodiscard]] std::vector<View> standard_views();

/// Returns the size of the object in the view: half its width and height, mm.
[[nodiscard]] Eigen::Vector2d half_extent_mm(const mesh::Surface& surface, const Pose& X_FO,
                                             const View& view);

/// The parts of an object, and of the film tiles on it, that are visible from one side, with 2 x 2
/// samples per pixel. Computed once with a depth buffer and then used for drawings in any colours.
/// Object and tiles must outlive it.
class SeenObject {
 public:
  SeenObject(const mesh::Surface& surface, const Pose& X_FO,
             std::span<const flow::MappedTriangle> tiles, const View& view, int width_px,
             int height_px, double px_per_mm);

  struct Sample {
    int tile = -1;               ///< index of the visible tile; -1: no tile, or background
    float towards = -HUGE_VALF;  ///< position along the view, mm; -infinity: background
    float light = 1;             ///< brightness factor, for a lamp over the viewer's left shoulder
    [[nodiscard]] bool is_background() const { return towards == -HUGE_VALF; }
  };
  /// A visible tile and its samples.
  struct SeenTile {
    const flow::MappedTriangle& tile;
    std::span<const int> samples;
  };

  [[nodiscard]] int width() const { return width_; }  ///< in samples, like the height
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] double samples_per_mm() const { return samples_per_mm_; }
  [[nodiscard]] double depth_step_mm() const { return depth_step_mm_; }
  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }
  [[nodiscard]] std::size_t seen_tiles() const { return tile_numbers_.size(); }
  [[nodiscard]] SeenTile seen_tile(std::size_t i) const;
  /// Projects a point: x and y in samples, z along the view.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& point_O) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 3> tile_corners(const flow::MappedTriangle& tile) const;

 private:
  [[nodiscard]] Window window() const { return {0, 0, width_, height_}; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + x;
  }
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners_of(std::size_t triangle) const;
  /// Returns the normals at the corners of a triangle, in the view frame, one per column.
  [[nodiscard]] Eigen::Matrix3d normals_of(std::size_t triangle) const;
  /// Computes the depth of each sample. Returns the index of the triangle of the surface that is
  /// visible there; -1: background.
  std::vector<int> place_surface();
  void place_tiles();
  void sort_by_tile();
  void light_tiles();
  void light_bare(const std::vector<int>& triangles);

  const mesh::Surface& surface_;
  std::span<const flow::MappedTriangle> tiles_;
  Eigen::Isometry3d X_VO_;  ///< object to view, mm; the origin is the object's middle
  int width_, height_;
  double samples_per_mm_;
  double depth_step_mm_;  ///< larger jumps in depth are drawn as outlines
  std::vector<Sample> samples_;
  /// The visible tiles, the first index of each in `by_tile_`, and the samples of all tiles.
  std::vector<int> tile_numbers_, first_of_tile_, by_tile_;
};

/// A drawing of a SeenObject.
class ViewDrawing {
 public:
  explicit ViewDrawing(const SeenObject& seen);

  /// Draws the tiles. `colour_of` is called once per tile with its corners on the sample grid. It
  /// returns a function from a sample's position and barycentric coordinates to its linear colour
  /// before shading.
  using TileColour = std::function<Eigen::Vector3f(int x, int y, const Eigen::Vector3d&)>;
  using TileColourMaker =
      std::function<TileColour(const flow::MappedTriangle& tile, const Corners& at)>;
  void draw_tiles(const TileColourMaker& colour_of);

  /// Draws the rest of the surface. `colour` returns a sample's linear colour before shading.
  using Colour = std::function<Eigen::Vector3f(int x, int y)>;
  void draw_bare(const Colour& colour);

  /// Draws points as discs over the drawing, where the surface does not hide them.
  /// @param points_O  points more than `deep_mm` behind the visible surface are hidden
  /// @param colours   linear, one per point
  void draw_points(std::span<const Eigen::Vector3d> points_O,
                   std::span<const Eigen::Vector3f> colours, double radius_mm, double deep_mm);

  /// Copies the drawing with its outlines onto a picture, whose pixels remain where the drawing
  /// shows background.
  void put_on(RgbImage& picture, int left_px, int top_px) const;

 private:
  struct Sample {
    Eigen::Vector3f colour;
    float towards;  ///< position of the drawn surface along the view
  };
  [[nodiscard]] bool is_outline(int x, int y) const;
  [[nodiscard]] Sample& at(int x, int y) {
    return samples_[static_cast<std::size_t>(y) * seen_.width() + x];
  }
  [[nodiscard]] const Sample& at(int x, int y) const {
    return samples_[static_cast<std::size_t>(y) * seen_.width() + x];
  }

  const SeenObject& seen_;
  std::vector<Sample> samples_;
};

}  // namespace hydroprint::image
