#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Meaning of texture coordinates outside [0, 1].
enum class Wrap { kRepeat, kMirror, kClamp };

/// Use of a texture's alpha channel: blended with white, ignored, or cut out (opaque at
/// Material::alpha_cutoff and above, else nothing is printed).
enum class AlphaMode { kBlend, kOpaque, kMask };

/// A material of a model file.
struct Material {
  std::string name;
  Eigen::Vector3f colour = {1, 1, 1};        ///< sRGB-coded, [0, 1]
  bool has_colour = false;                   ///< false: the file defines no colour
  std::filesystem::path texture;             ///< resolved against the model's folder; empty: none
  std::vector<unsigned char> texture_bytes;  ///< the image file itself if the model embeds it
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  /// True for glTF: the colour of a point is the product, in linear light, of the texture, `colour`
  /// and the vertex colour. False: a texture replaces `colour`, and `colour` the vertex colours.
  bool multiplies = false;
  /// If `multiplies`: the vertices' colours are one of the factors.
  bool uses_vertex_colours = false;
  /// True for glTF: the texture's values are sRGB in the file's own orientation, whatever its
  /// profile, gamma and Exif data say (glTF 2.0, section 3.8.3.2).
  bool texture_as_stored = false;
  AlphaMode alpha_mode = AlphaMode::kBlend;
  float alpha = 1;  ///< multiplies the texture's alpha
  float alpha_cutoff = 0.5F;
};

/// A material file that a model names.
struct MaterialFile {
  std::filesystem::path path;  ///< resolved against the model's folder
  bool is_missing = false;     ///< it does not exist, and triangles need it
};

/// A model as read: geometry in mm in the object frame O, and the sources of its colour.
/// Invariants: indices in range, every coordinate finite, at least one triangle with an area.
struct Model {
  std::filesystem::path path;
  double scale = 1;                                        ///< millimetres per unit of the file
  std::vector<Eigen::Vector3d> vertices;                   ///< in the file's order, times scale
  std::vector<Eigen::Vector3i> triangles;                  ///< polygons split; none with zero area
  std::vector<std::array<Eigen::Vector2f, 3>> corner_uvs;  ///< per triangle, v up; empty: none
  std::vector<int> triangle_material;                      ///< into materials; empty: none
  std::vector<Material> materials;
  std::vector<MaterialFile> material_files;
  std::vector<Eigen::Vector3f> vertex_colours;    ///< sRGB-coded [0, 1]; empty: none
  std::vector<Eigen::Vector3f> triangle_colours;  ///< likewise, where vertices have none
  /// What seems to define colours but could not be understood, one phrase each with its place:
  /// `material "skin": KHR_materials_pbrSpecularGlossiness`.
  std::vector<std::string> not_understood;
  Warnings warnings;  ///< assumptions made while reading

  /// The material of a triangle; null if it has none.
  [[nodiscard]] const Material* material_of(std::size_t triangle) const {
    const int m = triangle < triangle_material.size() ? triangle_material[triangle] : -1;
    return m >= 0 && static_cast<std::size_t>(m) < materials.size() ? &materials[m] : nullptr;
  }
};

}  // namespace hydroprint::mesh
