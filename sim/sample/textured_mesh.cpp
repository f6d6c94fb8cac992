#include "sim/sample/textured_mesh.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace hydroprint::sample {

int TexturedMesh::add_vertex(const Eigen::Vector3d& position_mm) {
  vertices_.push_back(position_mm);
  return static_cast<int>(vertices_.size()) - 1;
}

int TexturedMesh::add_uv(const Eigen::Vector2d& uv) {
  uvs_.push_back(uv);
  return static_cast<int>(uvs_.size()) - 1;
}

void TexturedMesh::add_face(std::vector<Corner> corners) { faces_.push_back(std::move(corners)); }

mesh::Model TexturedMesh::to_model() const {
  mesh::Model model;
  model.vertices = vertices_;
  for (const auto& face : faces_) {
    for (std::size_t k = 2; k < face.size(); ++k) {
      const std::array<Corner, 3> corners = {face[0], face[k - 1], face[k]};
      model.triangles.emplace_back(corners[0].vertex, corners[1].vertex, corners[2].vertex);
      auto& uvs = model.corner_uvs.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        uvs[i] = uvs_[static_cast<std::size_t>(corners[i].uv)].cast<float>();
      }
    }
  }
  return model;
}

std::string TexturedMesh::to_obj(const std::string& name) const {
  std::string text = fmt::format("# Hydroprint sample, in mm\nmtllib {0}.mtl\nusemtl {0}\n", name);
  for (const auto& v : vertices_)
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", v.x(), v.y(), v.z());
  for (const auto& uv : uvs_) text += fmt::format("vt {:.7f} {:.7f}\n", uv.x(), uv.y());
  for (const auto& face : faces_) {
    text += 'f';
    for (const auto& corner : face) text += fmt::format(" {}/{}", corner.vertex + 1, corner.uv + 1);
    text += '\n';
  }
  return text;
}

}  // namespace hydroprint::sample
