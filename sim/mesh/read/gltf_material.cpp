#include "sim/mesh/read/gltf_material.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "sim/mesh/read/colours.h"
#include "sim/mesh/read/gltf_accessor.h"
#include "sim/mesh/read/names.h"

namespace hydroprint::mesh {
namespace {

constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";

/// A reference to a texture, with its coordinates.
struct TextureUse {
  int index = -1;
  int uv_set = 0;
  Eigen::Affine2d transform = Eigen::Affine2d::Identity();
};

/// A colour as a product; both factors are optional.
struct Product {
  std::optional<Eigen::Vector4d> factor;  ///< linear R G B and alpha
  std::optional<TextureUse> texture;
};

double number_or(const tinygltf::Value& value, double otherwise) {
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

Eigen::Vector2d pair_or(const tinygltf::Value& value, double otherwise) {
  if (!value.IsArray() || value.ArrayLen() != 2) return {otherwise, otherwise};
  return {number_or(value.Get(0), otherwise), number_or(value.Get(1), otherwise)};
}

/// Applies KHR_texture_transform: scaling, then rotation, then translation; and its own set of
/// texture coordinates.
void apply_transform(const tinygltf::Value& extension, TextureUse& use) {
  use.transform = Eigen::Affine2d::Identity();
  use.transform.translate(pair_or(extension.Get("offset"), 0));
  use.transform.rotate(Eigen::Rotation2Dd(-number_or(extension.Get("rotation"), 0)));
  use.transform.scale(pair_or(extension.Get("scale"), 1));
  const auto& set = extension.Get("texCoord");
  if (set.IsNumber()) use.uv_set = set.GetNumberAsInt();
}

std::optional<TextureUse> use_of(const tinygltf::TextureInfo& info) {
  if (info.index < 0) return {};
  TextureUse use{info.index, info.texCoord, Eigen::Affine2d::Identity()};
  const auto at = info.extensions.find("KHR_texture_transform");
  if (at != info.extensions.end()) apply_transform(at->second, use);
  return use;
}

/// Reads a texture reference in the JSON of an extension.
std::optional<TextureUse> use_of(const tinygltf::Value& info) {
  if (!info.IsObject() || !info.Get("index").IsNumber()) return {};
  TextureUse use;
  use.index = info.Get("index").GetNumberAsInt();
  use.uv_set = static_cast<int>(number_or(info.Get("texCoord"), 0));
  const auto& transform = info.Get("extensions").Get("KHR_texture_transform");
  if (transform.IsObject()) apply_transform(transform, use);
  return use;
}

/// Returns the base colour that the file itself gives (the importer fills in white).
Product base_colour(const tinygltf::Material& source) {
  const auto& pbr = source.pbrMetallicRoughness;
  Product out;
  if (source.values.contains("baseColorFactor") && pbr.baseColorFactor.size() == 4)
    out.factor = Eigen::Map<const Eigen::Vector4d>(pbr.baseColorFactor.data());
  out.texture = use_of(pbr.baseColorTexture);
  if (out.factor || out.texture) return out;
  const auto at = source.extensions.find(kGlossiness);
  if (at == source.extensions.end()) return out;
  const auto& factor = at->second.Get("diffuseFactor");
  if (factor.IsArray() && factor.ArrayLen() == 4) {
    out.factor.emplace();
    for (int k = 0; k < 4; ++k) (*out.factor)[k] = number_or(factor.Get(k), 1);
  }
  out.texture = use_of(at->second.Get("diffuseTexture"));
  return out;
}

/// Returns true if a base colour leaves the look to the emission: none, plain white or black.
bool leaves_look_to_emission(const Product& base) {
  if (base.texture) return false;
  if (!base.factor) return true;
  const Eigen::Vector3d rgb = base.factor->head<3>();
  return rgb.isZero() || rgb.isOnes();
}

/// Returns the emission; without factors if the material does not glow.
Product emission(const tinygltf::Material& source) {
  Product out;
  if (source.emissiveFactor.size() != 3) return out;
  const Eigen::Vector3d factor = Eigen::Map<const Eigen::Vector3d>(source.emissiveFactor.data());
  if (factor.isZero()) return out;
  out.factor.emplace();
  *out.factor << factor, 1;
  out.texture = use_of(source.emissiveTexture);
  return out;
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

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirror;
  return Wrap::kRepeat;
}

/// Builds the colour of one material.
class GltfColourReader {
 public:
  GltfColourReader(const tinygltf::Model& model, const std::filesystem::path& path)
      : model_(model), path_(path) {}

  GltfColour read(const tinygltf::Material* source, bool vertex_colours) {
    Material& material = out_.material;
    material.multiplies = true;
    material.texture_as_stored = true;
    material.alpha_mode = AlphaMode::kOpaque;
    material.uses_vertex_colours = vertex_colours;
    if (source == nullptr) return std::move(out_);
    material.name = source->name;
    set_alpha(*source);
    Product colour = base_colour(*source);
    if (!vertex_colours && leaves_look_to_emission(colour)) {
      const Product glow = emission(*source);
      if (glow.factor) {
        colour = glow;
        warn(WarningCode::EMISSIVE_COLOUR_USED, "has no colour but its emission, which was used");
      }
    }
    if (colour.factor) set_factor(*colour.factor);
    if (colour.texture) set_texture(*colour.texture);
    if (vertex_colours && material.alpha_mode == AlphaMode::kBlend && !colour.texture) {
      out_.blended_factor = colour.factor.value_or(Eigen::Vector4d::Ones());
      material.colour.setOnes();
      material.alpha = 1;
    }
    if (!vertex_colours && !colour.factor && !colour.texture) note_extensions(*source);
    return std::move(out_);
  }

 private:
  void warn(WarningCode code, const std::string& message) {
    out_.warnings.push_back({code,
                             fmt::format("material \"{}\" {}", out_.material.name, message),
                             {InFile{path_.string()}}});
  }

  void set_alpha(const tinygltf::Material& source) {
    Material& material = out_.material;
    if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::kMask;
    if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::kBlend;
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  }

  void set_factor(const Eigen::Vector4d& factor) {
    Material& material = out_.material;
    material.has_colour = true;
    for (int k = 0; k < 3; ++k) material.colour[k] = srgb_of_linear(factor[k]);
    material.alpha = static_cast<float>(std::clamp(factor[3], 0.0, 1.0));
  }

  void set_texture(const TextureUse& use) {
    const auto* texture = entry(model_.textures, use.index);
    const auto* image = texture == nullptr ? nullptr : entry(model_.images, texture->source);
    if (image == nullptr || (image->image.empty() && image->uri.empty())) {
      give_up_texture(texture);
      return;
    }
    Material& material = out_.material;
    out_.uv_set = use.uv_set;
    out_.uv_transform = use.transform;
    if (const auto* sampler = entry(model_.samplers, texture->sampler)) {
      material.wrap_u = wrap_of(sampler->wrapS);
      material.wrap_v = wrap_of(sampler->wrapT);
    }
    if (!image->image.empty()) {
      material.texture = fmt::format("{}#{}", path_.string(), texture->source);
      material.texture_bytes = image->image;
    } else {
      material.texture = resolve_texture(path_.parent_path(), unescape(image->uri));
    }
  }

  /// Without its texture, the factor alone would be a wrong colour.
  void give_up_texture(const tinygltf::Texture* texture) {
    out_.material.has_colour = false;
    out_.material.uses_vertex_colours = false;
    std::string why = "its texture does not exist";
    if (texture != nullptr && !texture->extensions.empty())
      why = fmt::format("its texture needs {}; export PNG or JPEG textures",
                        texture->extensions.begin()->first);
    out_.not_understood.push_back(fmt::format("material \"{}\": {}", out_.material.name, why));
  }

  /// Notes extensions that may define the colour.
  void note_extensions(const tinygltf::Material& source) {
    for (const auto& [name, value] : source.extensions)
      out_.not_understood.push_back(fmt::format("material \"{}\": {}", out_.material.name, name));
  }

  const tinygltf::Model& model_;
  const std::filesystem::path& path_;
  GltfColour out_;
};

}  // namespace

GltfColour gltf_colour(const tinygltf::Model& model, int index, bool vertex_colours,
                       const std::filesystem::path& path) {
  return GltfColourReader(model, path).read(entry(model.materials, index), vertex_colours);
}

}  // namespace hydroprint::mesh
