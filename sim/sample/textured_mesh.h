#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/image/io/rgb_image.h"
#include "sim/mesh/model.h"

namespace hydroprint::sample {

/// A mesh of triangles and quads for an OBJ file. Faces point outward.
class TexturedMesh {
 public:
  struct Corner {
    int vertex = 0;
    int uv = 0;
  };

  int add_vertex(const Eigen::Vector3d& position_mm);
  int add_uv(const Eigen::Vector2d& uv);
  /// Adds a face with three or four corners, counter-clockwise from outside.
  void add_face(std::vector<Corner> corners);

  [[nodiscard]] const Eigen::Vector3d& vertex(int i) const {
    return vertices_[static_cast<std::size_t>(i)];
  }
  /// Returns the mesh as an OBJ file that uses the material `name` in `name`.mtl.
  [[nodiscard]] std::string to_obj(const std::string& name) const;
  /// Returns the mesh as a model without a material.
  [[nodiscard]] mesh::Model to_model() const;

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector2d> uvs_;
  std::vector<std::vector<Corner>> faces_;
};

/// Mesh and texture of a sample.
struct Sample {
  TexturedMesh mesh;
  image::RgbImage texture;
  double px_per_mm = 1;
};

[[nodiscard]] Sample make_globe();
[[nodiscard]] Sample make_sphere80();
[[nodiscard]] Sample make_board();
[[nodiscard]] Sample make_ubend();
[[nodiscard]] Sample make_mug();
[[nodiscard]] Sample make_bowl();

}  // namespace hydroprint::sample
