#include "sim/sample/textured_mesh.h"

#include <array>
#include <charconv>
#include <utility>

namespace hydroprint::sample {
namespace {

/// Appends a number in fixed notation, independent of the locale.
void append_number(std::string& text, double value, int digits) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, digits);
  text.append(1, ' ').append(buffer.data(), end);
}

}  // namespace

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
  std::string text = "# Hydroprint sample, in mm\nmtllib ";
  text.append(name).append(".mtl\nusemtl ").append(name).append("\n");
  for (const auto& v : vertices_) {
    text += 'v';
    for (int k = 0; k < 3; ++k) append_number(text, v[k], 6);
    text += '\n';
  }
  for (const auto& uv : uvs_) {
    text += "vt";
    for (int k = 0; k < 2; ++k) append_number(text, uv[k], 7);
    text += '\n';
  }
  for (const auto& face : faces_) {
    text += 'f';
    for (const auto& corner : face) {
      text.append(1, ' ').append(std::to_string(corner.vertex + 1));
      text.append(1, '/').append(std::to_string(corner.uv + 1));
    }
    text += '\n';
  }
  return text;
}

}  // namespace hydroprint::sample
