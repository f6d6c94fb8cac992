#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <cmath>
#include <exception>
#include <fstream>
#include <map>
#include <new>
#include <optional>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/gltf_accessor.h"
#include "sim/mesh/read/gltf_check.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/read/textures.h"

namespace hydroprint::mesh {
namespace {

constexpr int kMaxDepth = 256;              // maximum depth of nodes
constexpr std::size_t kMaxNodes = 100'000;  // maximum number of visited nodes

/// Converts to sRGB, because glTF's colours are linear light.
float to_srgb(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirror;
  return Wrap::kRepeat;
}

template <class T>
const T* entry(const std::vector<T>& values, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= values.size()) return nullptr;
  return &values[static_cast<std::size_t>(index)];
}

std::string unescape(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
        std::isxdigit(static_cast<unsigned char>(uri[i + 2]))) {
      text += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

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
      warn("faces_without_uv",
           "some parts have no texture coordinates: they take the colour of the texture's "
           "lower left corner");
    if (skinned_ > 0)
      warn("skin_ignored",
           fmt::format("{} parts are deformed by a skeleton, which is not supported: they are used "
                       "in their modelled shape, at their node's position",
                       skinned_));
    if (morphing_ > 0)
      warn("morph_ignored",
           fmt::format(
               "{} parts have morph targets, which are not supported: their base shape is used",
               morphing_));
    if (skipped_ > 0)
      warn("not_a_surface", fmt::format("{} sets of points or lines were left out", skipped_));
    if (model_.materials.empty()) model_.triangle_material.clear();
    return std::move(model_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& place, std::string_view what) const {
    return damaged(model_.path, place, what);
  }

  void warn(std::string code, std::string message) {
    model_.warnings.push_back({std::move(code), std::move(message), model_.path.string()});
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
    const auto first = static_cast<int>(model_.vertices.size());
    HP_RETURN_IF_ERROR(add_vertices(primitive, transform, place));
    const auto count = static_cast<int>(model_.vertices.size()) - first;
    const int material = material_index(primitive.material);
    const bool mirrored = transform.linear().determinant() < 0;
    HP_ASSIGN_OR_RETURN(const auto uvs, read_uvs(primitive, place));
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
    const auto colours = attribute(primitive, "COLOR_0");
    with_colours_ += colours ? 1 : 0;
    for (std::size_t i = 0; i < accessor->size(); ++i) {
      const auto p = accessor->values(i);
      const Eigen::Vector3d v = transform * Eigen::Vector3d(p[0], p[1], p[2]);
      if (!v.allFinite()) return bad(place, fmt::format("vertex {} is not a finite number", i));
      model_.vertices.push_back(v);
      const auto c =
          colours && i < colours->size() ? colours->values(i) : std::array<double, 4>{1, 1, 1, 1};
      model_.vertex_colours.emplace_back(to_srgb(c[0]), to_srgb(c[1]), to_srgb(c[2]));
    }
    return {};
  }

  Result<std::vector<Eigen::Vector2f>> read_uvs(const tinygltf::Primitive& primitive,
                                                const std::string& place) {
    std::vector<Eigen::Vector2f> result;
    const auto* material = entry(source_.materials, primitive.material);
    const int set =
        material == nullptr ? 0 : material->pbrMetallicRoughness.baseColorTexture.texCoord;
    const std::string name = fmt::format("TEXCOORD_{}", set);
    if (!primitive.attributes.contains(name)) return result;
    const auto accessor = attribute(primitive, name);
    if (!accessor || accessor->components() != 2)
      return bad(place, "its texture coordinates lie outside the file");
    const Eigen::Affine2d transform = texture_transform(material);
    for (std::size_t i = 0; i < accessor->size(); ++i) {
      const auto values = accessor->values(i);
      const Eigen::Vector2d uv = transform * Eigen::Vector2d(values[0], values[1]);
      if (!uv.allFinite())
        return bad(place, fmt::format("texture coordinate {} is not a finite number", i));
      result.emplace_back(static_cast<float>(uv.x()), static_cast<float>(1 - uv.y()));  // v up
    }
    return result;
  }

  /// Returns the transform of KHR_texture_transform: scaling, then rotation, then translation.
  static Eigen::Affine2d texture_transform(const tinygltf::Material* material) {
    Eigen::Affine2d result = Eigen::Affine2d::Identity();
    if (material == nullptr) return result;
    const auto& extensions = material->pbrMetallicRoughness.baseColorTexture.extensions;
    const auto at = extensions.find("KHR_texture_transform");
    if (at == extensions.end()) return result;
    const auto number = [](const tinygltf::Value& v) { return v.GetNumberAsDouble(); };
    const auto pair = [&](const char* key, double otherwise) {
      const auto& value = at->second.Get(key);
      if (!value.IsArray() || value.ArrayLen() != 2) return Eigen::Vector2d(otherwise, otherwise);
      return Eigen::Vector2d(number(value.Get(0)), number(value.Get(1)));
    };
    const auto& rotation = at->second.Get("rotation");
    result.translate(pair("offset", 0));
    if (rotation.IsNumber()) result.rotate(Eigen::Rotation2Dd(-number(rotation)));
    result.scale(pair("scale", 1));
    return result;
  }

  int material_index(int source) {
    const auto known = material_of_.find(source);
    if (known != material_of_.end()) return known->second;
    const int index = static_cast<int>(model_.materials.size());
    material_of_.emplace(source, index);
    model_.materials.push_back(make_material(source));
    return index;
  }

  [[nodiscard]] Material make_material(int index) const {
    Material material;
    const auto* source = entry(source_.materials, index);
    if (source == nullptr) return material;
    material.name = source->name;
    const auto& pbr = source->pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() >= 3) {
      material.has_colour = true;
      for (int k = 0; k < 3; ++k)
        material.colour[k] = to_srgb(pbr.baseColorFactor[static_cast<std::size_t>(k)]);
    }
    const auto* texture = entry(source_.textures, pbr.baseColorTexture.index);
    if (texture != nullptr) set_texture(*texture, material);
    return material;
  }

  void set_texture(const tinygltf::Texture& texture, Material& material) const {
    const auto* image = entry(source_.images, texture.source);
    if (image == nullptr) return;
    if (const auto* sampler = entry(source_.samplers, texture.sampler)) {
      material.wrap_u = wrap_of(sampler->wrapS);
      material.wrap_v = wrap_of(sampler->wrapT);
    }
    if (!image->image.empty()) {
      material.texture = fmt::format("{}#{}", model_.path.string(), texture.source);
      material.texture_bytes = image->image;
    } else if (!image->uri.empty()) {
      material.texture = resolve_texture(model_.path.parent_path(), unescape(image->uri));
    }
  }

  const tinygltf::Model& source_;
  Model model_;
  std::map<int, int> material_of_;
  std::size_t visited_ = 0;
  std::size_t primitives_ = 0;
  std::size_t with_uvs_ = 0;
  std::size_t with_colours_ = 0;
  std::size_t skipped_ = 0;
  std::size_t skinned_ = 0;
  std::size_t morphing_ = 0;
};

/// Restricts the importer to buffers below the model's folder. The importer is compiled without
/// support for images; the texture loader opens the images that are needed.
tinygltf::FsCallbacks file_access(std::filesystem::path& folder) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.user_data = &folder;
  callbacks.FileExists = [](const std::string& name, void* data) {
    const auto& root = *static_cast<const std::filesystem::path*>(data);
    const auto within =
        std::filesystem::path(name).lexically_normal().lexically_relative(root.lexically_normal());
    std::error_code error;
    return !within.empty() && *within.begin() != ".." &&
           std::filesystem::is_regular_file(name, error);
  };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error,
                               const std::string& name, void*) {
    auto bytes = read_file(name);
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

  std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  loader.SetFsCallbacks(file_access(folder));
  tinygltf::Model source;
  std::string error;
  std::string warning;
  const bool loaded =
      bytes.starts_with("glTF")
          ? loader.LoadBinaryFromMemory(&source, &error, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                        folder.string())
          : loader.LoadASCIIFromString(&source, &error, &warning, bytes.data(), size,
                                       folder.string());
  if (!loaded) return damaged(path, "", error.substr(0, 200));
  return GltfImporter(source, path).run();
} catch (const std::bad_alloc&) {
  throw;  // not a fault of the file
} catch (const std::exception& e) {
  return bad_input(path, "", e.what());
}

}  // namespace hydroprint::mesh
