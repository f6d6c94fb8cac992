#include <assimp/BaseImporter.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <exception>
#include <memory>
#include <new>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/ply_check.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/read/stl_check.h"
#include "sim/mesh/read/textures.h"
#include "sim/mesh/read/triangulate.h"

namespace hydroprint::mesh {
namespace {

/// Unregisters all other importers (about forty), so that no file can reach them.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    if (importer.GetImporterIndex(extension.c_str()) == i) continue;
    const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
    importer.UnregisterLoader(other.get());  // we own it after this
  }
}

Status append(const aiMesh& mesh, const std::filesystem::path& path, Model& model) {
  const int shift = static_cast<int>(model.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const auto& p = mesh.mVertices[i];
    model.vertices.emplace_back(p.x, p.y, p.z);
    if (mesh.HasVertexColors(0)) {
      const auto& c = mesh.mColors[0][i];
      model.vertex_colours.emplace_back(c.r, c.g, c.b);
    }
  }
  std::vector<int> polygon;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const auto& face = mesh.mFaces[f];
    polygon.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        return bad_input(path, fmt::format("face {}", f),
                         "uses a vertex out of range; export the file again");
      polygon.push_back(shift + static_cast<int>(face.mIndices[k]));
    }
    if (polygon.size() < 3) continue;
    for (const auto& t : triangulate(model.vertices, polygon)) {
      std::array<Eigen::Vector2f, 3> uvs;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(t[k]);
        if (!mesh.HasTextureCoords(0)) continue;
        const auto& uv = mesh.mTextureCoords[0][face.mIndices[corner]];
        uvs[k] = {uv.x, uv.y};
      }
      model.triangles.emplace_back(polygon[static_cast<std::size_t>(t[0])],
                                   polygon[static_cast<std::size_t>(t[1])],
                                   polygon[static_cast<std::size_t>(t[2])]);
      if (mesh.HasTextureCoords(0)) model.corner_uvs.push_back(uvs);
    }
  }
  return {};
}

Result<Model> import(const std::string& bytes, const std::filesystem::path& path,
                     const std::string& extension) try {
  Assimp::Importer importer;
  keep_only(importer, extension);
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (scene == nullptr) return bad_input(path, "", importer.GetErrorString());
  Model model;
  model.path = path;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    HP_RETURN_IF_ERROR(append(*scene->mMeshes[m], path, model));
  return model;
} catch (const std::bad_alloc&) {
  throw;  // not a fault of the file
} catch (const std::exception& e) {
  return bad_input(path, "", e.what());
}

}  // namespace

Result<Model> read_stl(std::string bytes, const std::filesystem::path& path,
                       const Context& context) {
  HP_ASSIGN_OR_RETURN(const std::size_t facets, check_stl(bytes, path, context));
  HP_RETURN_IF_ERROR(check_face_count(facets, path));
  return import(bytes, path, "stl");
}

Result<Model> read_ply(std::string bytes, const std::filesystem::path& path,
                       const Context& context) {
  HP_ASSIGN_OR_RETURN(const PlyFacts facts, check_ply(bytes, path, context));
  HP_RETURN_IF_ERROR(check_face_count(facts.faces, path));
  HP_ASSIGN_OR_RETURN(Model model, import(bytes, path, "ply"));
  if (model.vertices.size() != facts.vertices)
    return damaged(path, "", "not all vertices could be read");
  if (facts.has_face_uvs) {
    model.corner_uvs.clear();
    model.warnings.push_back({"face_uvs_ignored",
                              "texture coordinates listed per face are ignored in PLY files; "
                              "use OBJ to keep them",
                              path.string()});
  }
  if (!facts.texture.empty()) {
    Material material;
    material.name = "TextureFile";
    material.texture = resolve_texture(path.parent_path(), facts.texture);
    model.materials.push_back(std::move(material));
    model.triangle_material.assign(model.triangles.size(), 0);
  }
  return model;
}

}  // namespace hydroprint::mesh
