#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hydroprint::image {

/// How a layer comes to the surface; see PaintLayer in the API for the formulas.
enum class Projection { kUv, kVertexColours, kPlanar, kDip, kCylindrical, kBox, kDecal };

/// A layer of paint as described, before its picture is read. Frame O unless stated otherwise.
struct Layer {
  std::string name;                       ///< for messages
  std::filesystem::path picture;          ///< empty: none
  std::optional<Eigen::Vector3f> colour;  ///< sRGB-coded, [0, 1]; without a picture
  /// nullopt: kUv for models with texture coordinates, otherwise kDip.
  std::optional<Projection> projection;
  std::optional<Eigen::Vector3d> position_mm;  ///< nullopt: the middle of the bounding box
  std::optional<Eigen::Vector3d> direction;    ///< of view; any length; not for kDip
  std::optional<Eigen::Vector3d> up;           ///< any length; for kDip in frame F
  std::optional<double> size_mm;               ///< width; nullopt: fitted to the bounding box
  std::optional<double> depth_mm;              ///< of kDecal; nullopt: unlimited
  double turn_rad = 0;
  bool mirror = false;
  std::optional<bool> repeat;  ///< nullopt: true for kCylindrical, kBox and kUv
  double opacity = 1;
  std::optional<double> blend_mm;  ///< of kBox; nullopt: a tenth of the larger side
};

/// The paint of an object as described: a base colour, and layers above it (Paint in the API).
struct PaintSource {
  Eigen::Vector3f base_colour = Eigen::Vector3f::Ones();  ///< sRGB-coded, [0, 1]
  std::vector<Layer> layers;                              ///< the lowest first
};

/// Returns the name of a projection in the API: "vertex_colors".
[[nodiscard]] const char* name_of(Projection projection);

/// Returns the projection with this name in the API; nullopt if there is none.
[[nodiscard]] std::optional<Projection> projection_of(const std::string& name);

}  // namespace hydroprint::image
