#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/mesh/model.h"

namespace tinygltf {
class Model;
}

namespace hydroprint::mesh {

/// The source of a glTF primitive's colour.
struct GltfColour {
  Material material;
  int uv_set = 0;  ///< TEXCOORD_n of its texture
  /// From the file's texture coordinates to the texture (KHR_texture_transform).
  Eigen::Affine2d uv_transform = Eigen::Affine2d::Identity();
  /// Linear R G B and alpha that multiply the vertices' colours before they are blended with white:
  /// for AlphaMode::kBlend without a texture. `material` then has no factors.
  Eigen::Vector4d blended_factor = Eigen::Vector4d::Ones();
  std::vector<std::string> not_understood;  ///< see Model::not_understood
  Warnings warnings;
};

/// Reads the base colour of a material (glTF 2.0, section 3.9.2): texture and factor of
/// pbrMetallicRoughness, else of KHR_materials_pbrSpecularGlossiness; else, if vertices have no
/// colours either, its emission. A texture in a format that needs an extension (WebP, KTX2) without
/// another source makes the whole colour not understood.
/// @param index           of the material; -1 or beyond the last: the default material
/// @param vertex_colours  the primitive has COLOR_0
/// @param path            of the model
[[nodiscard]] GltfColour gltf_colour(const tinygltf::Model& model, int index, bool vertex_colours,
                                     const std::filesystem::path& path);

}  // namespace hydroprint::mesh
