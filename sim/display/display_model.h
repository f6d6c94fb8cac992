#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/texture/paint.h"
#include "sim/mesh/model.h"

namespace hydroprint::display {

/// Maximum number of triangles that are shown; larger models are thinned.
inline constexpr std::size_t kMostTriangles = 200'000;

/// The triangles of a model that share a colour source (image::Paint::Ink).
struct Part {
  std::string name;                                  ///< of the first material
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< linear factor
  int picture = -1;                                  ///< index into pictures; -1: none
  std::vector<Eigen::Vector3i> triangles;            ///< indices of vertices
};

/// A texture as a PNG, sRGB, row 0 at the top. It is blended with white where it is transparent.
struct Picture {
  std::vector<unsigned char> png;
  mesh::Wrap wrap_u = mesh::Wrap::kRepeat, wrap_v = mesh::Wrap::kRepeat;
};

/// A model for display. The colour of a point is the product, in linear light, of its part's
/// colour, its part's picture and the colour of its vertices: what is printed there.
struct DisplayModel {
  Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();  ///< frame O; positions are relative to it
  std::vector<Eigen::Vector3f> positions;               ///< mm
  /// Per vertex, the number of its place: 0, 1, ... in order of first use by the model's triangles.
  /// It does not depend on the model's colours.
  std::vector<int> places;
  std::vector<Eigen::Vector2f> uvs;      ///< v up; empty: none
  std::vector<Eigen::Vector3f> colours;  ///< linear; empty: all white
  std::vector<Part> parts;               ///< none is empty
  std::vector<Picture> pictures;
  Warnings warnings;

  [[nodiscard]] std::size_t triangles() const;
};

/// Makes the display of a model: at most kMostTriangles (thin_surface), textures within the limits
/// of show_pictures(). Vertices are shared by triangles only where position, texture coordinates
/// and colour agree.
/// @param paint  of this model
/// @return kCancelled; kInternal if memory runs out
[[nodiscard]] Result<DisplayModel> make_display(const mesh::Model& model, const image::Paint& paint,
                                                const Context& context);

/// Returns the shape that make_display() shows, without colours: vertex i is place i.
[[nodiscard]] Result<mesh::Model> shown_shape(const mesh::Model& model, const Context& context);

}  // namespace hydroprint::display
