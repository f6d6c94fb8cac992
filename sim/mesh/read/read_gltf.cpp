#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include "sim/mesh/read/colours.h"
#include "sim/mesh/read/file.h"
#include "sim/mesh/read/gltf_accessor.h"
#include "sim/mesh/read/gltf_check.h"
#include "sim/mesh/read/gltf_material.h"
#include "sim/mesh/read/names.h"
#include "sim/mesh/read/readers.h"

namespace hydroprint::mesh {
namespace {

constexpr int kMaxDepth = 256;              // maximum depth of nodes
constexpr std::size_t kMaxNodes = 100'000;  // maximum number of visited nodes

Eigen::Affine3d local_transform(const tinygltf::Node& node) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    result.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    return result;
  }
  if (node.translation.size() == 3)
    result.translate(
        Eigen::Vector3d(node.translation[0], node.translation[1], node.translation[2]));
  if (node.rotation.size() == 4) {
    const Eigen::Quaterniond q(node.rotation[3], node.rotation[0], node.rotation[1],
                               node.rotation[2]);
    if (q.norm() > 0) result.rotate(q.normalized());
  }
  if (node.scale.size() == 3)
    result.scale(Eigen::Vector3d(node.scale[0], node.scale[1], node.scale[2]));
  return result;
}

class GltfImporter {
 public:
  GltfImporter(const tinygltf::Model& source, const std::filesystem::path& path) : source_(source) {
    model_.path = path;
  }

  Result<Model> run() {
    for (const int root : roots()) HP_RETURN_IF_ERROR(visit(root, Eigen::Affine3d::Identity(), 0));
    if (with_uvs_ == 0) model_.corner_uvs.clear();
    if (with_colours_ == 0) model_.vertex_colours.clear();
    if (with_uvs_ > 0 && with_uvs_ < primitives_)
      warn(WarningCode::FACES_WITHOUT_UV,
           "some parts have no texture coordinates: they take the colour of the texture's "
           "lower left corner");
    if (skinned_ > 0)
      warn(WarningCode::SKIN_IGNORED,
           fmt::format("{} parts are deformed by a skeleton, which is not supported: they are used "
                       "in their modelled shape, at their node's position",
                       skinned_));
    if (morphing_ > 0)
      warn(WarningCode::MORPH_IGNORED,
           fmt::format(
               "{} parts have morph targets, which are not supported: their base shape is used",
               morphing_));
    warn_of_colours();
    if (skipped_ > 0)
      warn(WarningCode::NOT_A_SURFACE,
           fmt::format("{} sets of points or lines were left out", skipped_));
    if (model_.materials.empty()) model_.triangle_material.clear();
    return std::move(model_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& place, std::string_view what) const {
    return damaged(model_.path, place, what);
  }

  void warn(WarningCode code, std::string message) {
    model_.warnings.push_back({code, std::move(message), {InFile{model_.path.string()}}});
  }

  void warn_of_colours() {
    if (blended_colours_ > 0)
      warn(
          WarningCode::ALPHA_OVER_WHITE,
          fmt::format("{} vertices are transparent and were blended with white", blended_colours_));
    if (ignored_alphas_ > 0)
      warn(WarningCode::VERTEX_ALPHA_IGNORED,
           fmt::format("the alpha of {} vertices' colours was ignored", ignored_alphas_));
    if (broken_colours_ > 0)
      warn(WarningCode::COLOURS_NOT_NUMBERS,
           fmt::format("the colours of {} vertices are not numbers: they are white",
                       broken_colours_));
  }

  /// Returns the root nodes: those of the default scene, else of the first scene, else all nodes
  /// that are not children.
  [[nodiscard]] std::vector<int> roots() const {
    const auto* scene = entry(source_.scenes, std::max(source_.defaultScene, 0));
    if (scene != nullptr) return scene->nodes;
    std::vector<bool> is_child(source_.nodes.size(), false);
    for (const auto& node : source_.nodes)
      for (const int child : node.children)
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
          is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> result;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) result.push_back(static_cast<int>(i));
    return result;
  }

  Status visit(int index, const Eigen::Affine3d& parent, int depth) {
    const std::string place = fmt::format("node {}", index);
    const auto* node = entry(source_.nodes, index);
    if (node == nullptr) return bad(place, "does not exist");
    if (depth > kMaxDepth || ++visited_ > kMaxNodes)
      return bad(place, "contains itself or is nested too deeply, or the scene has too many nodes");
    const Eigen::Affine3d transform = parent * local_transform(*node);
    if (node->mesh >= 0) {
      skinned_ += node->skin >= 0 ? 1 : 0;
      HP_RETURN_IF_ERROR(add_mesh(node->mesh, transform));
    }
    for (const int child : node->children) HP_RETURN_IF_ERROR(visit(child, transform, depth + 1));
    return {};
  }

  Status add_mesh(int index, const Eigen::Affine3d& transform) {
    const auto* mesh = entry(source_.meshes, index);
    if (mesh == nullptr) return bad(fmt::format("mesh {}", index), "does not exist");
    for (std::size_t i = 0; i < mesh->primitives.size(); ++i)
      HP_RETURN_IF_ERROR(add_primitive(mesh->primitives[i], transform,
                                       fmt::format("mesh {} primitive {}", index, i)));
    return {};
  }

  Status add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                       const std::string& place) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      ++skipped_;
      return {};
    }
    HP_ASSIGN_OR_RETURN(const auto corners, corner_indices(primitive, mode, place));
    HP_RETURN_IF_ERROR(check_face_count(model_.triangles.size() + corners.size(), model_.path));
    const auto [colour, material] = colour_of(primitive);
    const auto first = static_cast<int>(model_.vertices.size());
    HP_RETURN_IF_ERROR(add_vertices(primitive, transform, place));
    HP_RETURN_IF_ERROR(add_vertex_colours(primitive, colour, place));
    const auto count = static_cast<int>(model_.vertices.size()) - first;
    const bool mirrored = transform.linear().determinant() < 0;
    HP_ASSIGN_OR_RETURN(const auto uvs, read_uvs(primitive, colour, place));
    for (auto c : corners) {
      if (c.minCoeff() < 0 || c.maxCoeff() >= count)
        return bad(place, fmt::format("uses a vertex out of range (the mesh has {})", count));
      if (mirrored) std::swap(c[1], c[2]);
      std::array<Eigen::Vector2f, 3> corner_uvs;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(c[static_cast<int>(k)]);
        corner_uvs[k] = at < uvs.size() ? uvs[at] : Eigen::Vector2f::Zero();
      }
      model_.triangles.push_back(c + Eigen::Vector3i::Constant(first));
      model_.corner_uvs.push_back(corner_uvs);
      model_.triangle_material.push_back(material);
    }
    ++primitives_;
    morphing_ += primitive.targets.empty() ? 0 : 1;
    with_uvs_ += uvs.empty() ? 0 : 1;
    return {};
  }

  /// Returns the triangles of the primitive, as indices of its own vertices.
  Result<std::vector<Eigen::Vector3i>> corner_indices(const tinygltf::Primitive& primitive,
                                                      int mode, const std::string& place) {
    std::vector<int> order;
    if (primitive.indices >= 0) {
      const auto accessor = GltfAccessor::open(source_, primitive.indices);
      if (!accessor) return bad(place, "its indices lie outside the file");
      HP_RETURN_IF_ERROR(check_face_count(accessor->size(), model_.path));
      for (std::size_t i = 0; i < accessor->size(); ++i)
        order.push_back(static_cast<int>(std::min<std::uint32_t>(accessor->index(i), INT32_MAX)));
    } else {
      const auto accessor = positions(primitive);
      if (!accessor) return bad(place, "its positions lie outside the file");
      HP_RETURN_IF_ERROR(check_face_count(accessor->size(), model_.path));
      for (std::size_t i = 0; i < accessor->size(); ++i) order.push_back(static_cast<int>(i));
    }
    if (mode == TINYGLTF_MODE_TRIANGLES && order.size() % 3 != 0)
      return bad(place, "the number of its indices is not a multiple of 3");
    std::vector<Eigen::Vector3i> result;
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t i = 0; i + 2 < order.size(); i += step) {
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        result.emplace_back(order[0], order[i + 1], order[i + 2]);
      } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1) {
        result.emplace_back(order[i + 1], order[i], order[i + 2]);
      } else {
        result.emplace_back(order[i], order[i + 1], order[i + 2]);
      }
    }
    return result;
  }

  [[nodiscard]] std::optional<GltfAccessor> attribute(const tinygltf::Primitive& primitive,
                                                      const std::string& name) const {
    const auto at = primitive.attributes.find(name);
    if (at == primitive.attributes.end()) return {};
    return GltfAccessor::open(source_, at->second);
  }

  [[nodiscard]] std::optional<GltfAccessor> positions(const tinygltf::Primitive& primitive) const {
    auto accessor = attribute(primitive, "POSITION");
    if (accessor && accessor->components() != 3) return {};
    return accessor;
  }

  Status add_vertices(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                      const std::string& place) {
    const auto accessor = positions(primitive);
    if (!accessor) return bad(place, "its positions lie outside the file");
    for (std::size_t i = 0; i < accessor->size(); ++i) {
      const auto p = accessor->values(i);
      const Eigen::Vector3d v = transform * Eigen::Vector3d(p[0], p[1], p[2]);
      if (!v.allFinite()) return bad(place, fmt::format("vertex {} is not a finite number", i));
      model_.vertices.push_back(v);
    }
    return {};
  }

  /// Adds the colours of the primitive's vertices, which have been added; white if it has none.
  Status add_vertex_colours(const tinygltf::Primitive& primitive, const GltfColour& colour,
                            const std::string& place) {
    const std::size_t first = model_.vertex_colours.size();
    model_.vertex_colours.resize(model_.vertices.size(), Eigen::Vector3f::Ones());
    if (!primitive.attributes.contains("COLOR_0")) return {};
    auto colours = attribute(primitive, "COLOR_0");
    if (!colours || colours->components() < 3 || colours->size() < model_.vertices.size() - first)
      return bad(place, "its COLOR_0 lies outside the file or is not a colour");
    colours->normalise();
    ++with_colours_;
    // Without a texture, the blend with white can be done here: it is linear in the colours.
    const bool blends =
        colour.material.alpha_mode == AlphaMode::kBlend && colour.material.texture.empty();
    for (std::size_t i = first; i < model_.vertices.size(); ++i) {
      const auto read = colours->values(i - first);
      Eigen::Vector4d c(read[0], read[1], read[2], read[3]);
      if (!c.allFinite()) {
        ++broken_colours_;
        continue;
      }
      if (blends) c = c.cwiseProduct(colour.blended_factor);
      if (c[3] < 1 && blends) ++blended_colours_;
      if (c[3] < 1 && !blends && colour.material.alpha_mode != AlphaMode::kOpaque)
        ++ignored_alphas_;
      const double opacity = blends ? std::clamp(c[3], 0.0, 1.0) : 1;
      for (int k = 0; k < 3; ++k)
        model_.vertex_colours[i][k] = srgb_of_linear(c[k] * opacity + 1 - opacity);
    }
    return {};
  }

  Result<std::vector<Eigen::Vector2f>> read_uvs(const tinygltf::Primitive& primitive,
                                                const GltfColour& colour,
                                                const std::string& place) {
    std::vector<Eigen::Vector2f> result;
    const std::string name = fmt::format("TEXCOORD_{}", colour.uv_set);
    if (!primitive.attributes.contains(name)) return result;
    const auto accessor = attribute(primitive, name);
    if (!accessor || accessor->components() != 2)
      return bad(place, "its texture coordinates lie outside the file");
    for (std::size_t i = 0; i < accessor->size(); ++i) {
      const auto values = accessor->values(i);
      const Eigen::Vector2d uv = colour.uv_transform * Eigen::Vector2d(values[0], values[1]);
      if (!uv.allFinite())
        return bad(place, fmt::format("texture coordinate {} is not a finite number", i));
      result.emplace_back(static_cast<float>(uv.x()), static_cast<float>(1 - uv.y()));  // v up
    }
    return result;
  }

  /// Returns the primitive's source of colour, and its index in the model's materials.
  std::pair<const GltfColour&, int> colour_of(const tinygltf::Primitive& primitive) {
    const bool vertex_colours = primitive.attributes.contains("COLOR_0");
    const auto [known, is_new] = colours_.try_emplace({primitive.material, vertex_colours});
    auto& [colour, index] = known->second;
    if (is_new) {
      colour = gltf_colour(source_, primitive.material, vertex_colours, model_.path);
      index = static_cast<int>(model_.materials.size());
      model_.materials.push_back(colour.material);
      std::ranges::copy(colour.not_understood, std::back_inserter(model_.not_understood));
      std::ranges::copy(colour.warnings, std::back_inserter(model_.warnings));
    }
    return {colour, index};
  }

  const tinygltf::Model& source_;
  Model model_;
  /// By the index of the material, and whether the primitive has colours of vertices.
  std::map<std::pair<int, bool>, std::pair<GltfColour, int>> colours_;
  std::size_t visited_ = 0;
  std::size_t primitives_ = 0;
  std::size_t with_uvs_ = 0;
  std::size_t with_colours_ = 0;
  std::size_t blended_colours_ = 0;
  std::size_t ignored_alphas_ = 0;
  std::size_t broken_colours_ = 0;
  std::size_t skipped_ = 0;
  std::size_t skinned_ = 0;
  std::size_t morphing_ = 0;
};

/// The folder of a model, and the names of its buffers that were taken for similar ones.
struct BufferFiles {
  std::filesystem::path folder;
  std::map<std::filesystem::path, std::filesystem::path> similar;
};

/// Returns the file of a buffer: itself, or the only one whose name differs in case or Unicode
/// form.
std::optional<std::filesystem::path> buffer_file(const std::string& name, BufferFiles& files) {
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error)) return name;
  auto similar = similar_file(name, files.folder);
  if (similar) files.similar.emplace(name, *similar);
  return similar;
}

/// Restricts the importer to buffers below the model's folder. The importer is compiled without
/// support for images; the texture loader opens the images that are needed.
tinygltf::FsCallbacks file_access(BufferFiles& files) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.user_data = &files;
  callbacks.FileExists = [](const std::string& name, void* data) {
    auto& own = *static_cast<BufferFiles*>(data);
    const auto within = std::filesystem::path(name).lexically_normal().lexically_relative(
        own.folder.lexically_normal());
    return !within.empty() && *within.begin() != ".." && buffer_file(name, own).has_value();
  };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                               const std::string& name, void* data) {
    const auto file = buffer_file(name, *static_cast<BufferFiles*>(data));
    auto bytes = read_file(file.value_or(name));
    if (!bytes) {
      *error = bytes.error().message;
      return false;
    }
    out->assign(bytes->begin(), bytes->end());
    return true;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                void*) { return false; };
  return callbacks;
}

/// Keeps the image file unchanged; the texture loader decodes it.
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  return true;
}

}  // namespace

Result<Model> read_gltf(std::string bytes, const std::filesystem::path& path,
                        const Context& context) try {
  HP_RETURN_IF_ERROR(check_gltf(bytes, path));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  const auto size = static_cast<unsigned int>(bytes.size());
  if (size != bytes.size()) return bad_input(path, "", "the file is too large; simplify the model");
  bytes.append(64, '\0');  // the importer's check of the last chunk is off by eight bytes

  BufferFiles files{path.has_parent_path() ? path.parent_path() : ".", {}};
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  loader.SetFsCallbacks(file_access(files));
  tinygltf::Model source;
  std::string error;
  std::string warning;
  const bool loaded =
      bytes.starts_with("glTF")
          ? loader.LoadBinaryFromMemory(&source, &error, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                        files.folder.string())
          : loader.LoadASCIIFromString(&source, &error, &warning, bytes.data(), size,
                                       files.folder.string());
  if (!loaded) return damaged(path, "", error.substr(0, 200));
  HP_ASSIGN_OR_RETURN(Model model, GltfImporter(source, path).run());
  for (const auto& [missing, found] : files.similar)
    model.warnings.push_back(similar_name(missing, found, path));
  return model;
} catch (const std::bad_alloc&) {
  throw;  // not a fault of the file
} catch (const std::exception& e) {
  return bad_input(path, "", e.what());
}

}  // namespace hydroprint::mesh
