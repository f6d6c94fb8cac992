#include "sim/image/texture/paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

bool is_finite(const std::array<Eigen::Vector2f, 3>& uvs) {
  return uvs[0].allFinite() && uvs[1].allFinite() && uvs[2].allFinite();
}

}  // namespace

Brush::Brush(const Texture& texture, const Chart& chart, const Corners& at, const Corners& uv)
    : texture_(&texture), chart_(&chart), origin_(at[0]), uv_(uv[0]) {
  const BarycentricMap map(at);
  Eigen::Matrix<double, 2, 3> uvs;
  uvs << uv[0], uv[1], uv[2];
  uv_per_sample_ << uvs * map.per_x(), uvs * map.per_y();
  footprint_ = texture.footprint(uv_per_sample_);
  shortcut_ = texture.shortcut(uv_, uv_per_sample_, footprint_, chart);
}

Eigen::Vector3f Brush::at(double x, double y) const {
  const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - origin_;
  if (texture_) {
    Eigen::Vector3f colour;
    if (shortcut_.sample(offset, colour)) return colour;
    return texture_->sample(uv_ + uv_per_sample_ * offset, footprint_, *chart_);
  }
  return (colour_ + colour_per_sample_ * offset.cast<float>()).cwiseMax(0.0F).cwiseMin(1.0F);
}

Brush Paint::brush(int model_triangle, const Corners& at,
                   const std::array<Eigen::Vector3d, 3>& barycentric) const {
  const Ink& ink = inks_[ink_of_triangle_[model_triangle]];
  if (ink.kind == Ink::Kind::kTexture) {
    Corners uv;
    for (int i = 0; i < 3; ++i) {
      uv[i].setZero();
      for (int k = 0; k < 3; ++k) {
        uv[i] += barycentric[i][k] * corner_uvs_[model_triangle][k].cast<double>();
      }
    }
    return Brush(textures_[ink.texture], chart_of_triangle_[model_triangle], at, uv);
  }
  Brush brush;
  brush.colour_ = ink.colour;
  if (ink.kind != Ink::Kind::kVertices) return brush;
  const BarycentricMap map(at);
  Eigen::Matrix3d colours, corners;
  for (int i = 0; i < 3; ++i) {
    colours.col(i) = vertex_colours_[triangles_[model_triangle][i]].cast<double>();
    corners.col(i) = barycentric[i];
  }
  Eigen::Matrix<double, 3, 2> per_sample;
  per_sample << corners * map.per_x(), corners * map.per_y();
  brush.origin_ = at[0];
  brush.colour_ = (colours * barycentric[0]).cast<float>();
  brush.colour_per_sample_ = (colours * per_sample).cast<float>();
  return brush;
}

/// Builds a Paint step by step.
class PaintLoader {
 public:
  PaintLoader(const mesh::Model& model, const Context& context)
      : model_(model), context_(context) {}

  Result<Paint> load(const std::optional<std::filesystem::path>& texture) {
    paint_.ink_of_triangle_.assign(model_.triangles.size(), 0);
    HP_RETURN_IF_ERROR(texture ? lay_texture(*texture) : gather_materials());
    HP_RETURN_IF_ERROR(build_textures());
    for (const int ink : paint_.ink_of_triangle_) {
      paint_.has_colour_ = paint_.has_colour_ || paint_.inks_[ink].kind != Paint::Ink::Kind::kNone;
    }
    return std::move(paint_);
  }

 private:
  using Ink = Paint::Ink;
  struct Pending {
    Texels texels;
    mesh::Wrap wrap_u, wrap_v;
  };

  void warn(std::string code, std::string message, std::string where) {
    paint_.warnings_.push_back({std::move(code), std::move(message), std::move(where)});
  }

  bool has_uvs(std::size_t triangle) const {
    return !model_.corner_uvs.empty() && is_finite(model_.corner_uvs[triangle]);
  }

  /// Applies --texture FILE to all triangles that have coordinates.
  Status lay_texture(const std::filesystem::path& path) {
    const auto& uvs = model_.corner_uvs;
    if (std::none_of(uvs.begin(), uvs.end(), is_finite)) {
      return fail(Code::kInvalidArgument,
                  path.string() + ": cannot be applied to " + model_.path.string() +
                      ", which has no texture coordinates (UVs). Unwrap the model in a 3D editor, "
                      "or omit the texture");
    }
    HP_ASSIGN_OR_RETURN(ReadImage read, read_image(path, context_));
    HP_ASSIGN_OR_RETURN(const int index, add_texture(std::move(read), mesh::Wrap::kRepeat,
                                                     mesh::Wrap::kRepeat, path.string()));
    paint_.inks_ = {Ink{}, Ink{Ink::Kind::kTexture, Eigen::Vector3f::Ones(), index}};
    int without = 0;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      paint_.ink_of_triangle_[t] = has_uvs(t) ? 1 : 0;
      without += has_uvs(t) ? 0 : 1;
    }
    if (without > 0) {
      warn("uvs_missing_in_part",
           fmt::format("{} triangles have no texture coordinates and stay white", without),
           model_.path.string());
    }
    return {};
  }

  /// Returns the ink for triangles whose material defines no colour.
  Ink fallback() {
    if (model_.vertex_colours.empty()) return {};
    if (paint_.vertex_colours_.empty()) {
      paint_.triangles_ = model_.triangles;
      for (const auto& colour : model_.vertex_colours) {
        paint_.vertex_colours_.push_back(linear_from_srgb(colour));
      }
    }
    return Ink{Ink::Kind::kVertices, Eigen::Vector3f::Ones(), -1};
  }

  Status gather_materials() {
    // Ink 0 is the fallback. Ink 1 + 2 m is for triangles of material m with texture coordinates,
    // and ink 2 + 2 m for those without.
    const std::size_t materials = model_.materials.size();
    paint_.inks_.assign(1 + 2 * materials, fallback());
    std::vector<bool> is_ready(materials, false);
    for (std::size_t t = 0; t < model_.triangle_material.size(); ++t) {
      const int m = model_.triangle_material[t];
      if (m < 0 || static_cast<std::size_t>(m) >= materials) continue;
      if (!is_ready[m]) {
        is_ready[m] = true;
        HP_RETURN_IF_ERROR(mix_inks(m));
      }
      paint_.ink_of_triangle_[t] = has_uvs(t) ? 1 + 2 * m : 2 + 2 * m;
    }
    warn_of_materials();
    return {};
  }

  Status mix_inks(int m) {
    const mesh::Material& material = model_.materials[m];
    Ink& with_uvs = paint_.inks_[1 + 2 * m];
    Ink& without_uvs = paint_.inks_[2 + 2 * m];
    // Exporters write plain white as the material's colour if the vertices define the colours.
    const bool is_white = material.colour == Eigen::Vector3f::Ones();
    if (material.has_colour && !(is_white && !model_.vertex_colours.empty())) {
      without_uvs = {Ink::Kind::kColour, linear_from_srgb(material.colour), -1};
    }
    with_uvs = without_uvs;
    if (!has_texture(material) || model_.corner_uvs.empty()) return {};
    HP_ASSIGN_OR_RETURN(const int index, material_texture(material));
    with_uvs = {Ink::Kind::kTexture, Eigen::Vector3f::Ones(), index};
    return {};
  }

  static bool has_texture(const mesh::Material& material) {
    return !material.texture.empty() || !material.texture_bytes.empty();
  }

  /// Reads a material's texture, once for all materials with the same texture and wrap modes.
  Result<int> material_texture(const mesh::Material& material) {
    const auto& bytes = material.texture_bytes;
    const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Key key{material.texture, std::hash<std::string_view>()(content), material.wrap_u,
                  material.wrap_v};
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    const std::string name =
        model_.path.string() + ", material \"" + material.name + "\", " +
        (bytes.empty() ? "texture " + material.texture.string() : "embedded texture");
    auto read =
        bytes.empty() ? read_image(material.texture, context_) : read_image(bytes, name, context_);
    if (!read) {
      Error error = std::move(read).error();
      if (error.code == Code::kNotFound) {
        error.message = name +
                        ": no such file. Put the texture there, correct the path in the "
                        "material, or use --texture";
      }
      return tl::unexpected(std::move(error));
    }
    HP_ASSIGN_OR_RETURN(const int index,
                        add_texture(std::move(*read), material.wrap_u, material.wrap_v, name));
    known_.emplace(key, index);
    return index;
  }

  Result<int> add_texture(ReadImage read, mesh::Wrap wrap_u, mesh::Wrap wrap_v,
                          const std::string& name) {
    area_px_ += static_cast<std::int64_t>(read.image.texels.size());
    if (area_px_ > kMaxImageArea_px) {
      return fail(
          Code::kOutOfRange,
          fmt::format(
              "{}: the model's textures together have more than {} million pixels. Scale them down",
              name, kMaxImageArea_px / 1'000'000));
    }
    if (read.had_alpha) {
      warn("alpha_over_white", "the texture is transparent in places and was blended with white",
           name);
    }
    pending_.push_back({std::move(read.image), wrap_u, wrap_v});
    return static_cast<int>(pending_.size()) - 1;
  }

  void warn_of_materials() {
    std::size_t untextured = 0, uncoloured = 0;
    for (std::size_t t = 0; t < model_.triangle_material.size(); ++t) {
      const int m = model_.triangle_material[t];
      if (m < 0 || static_cast<std::size_t>(m) >= model_.materials.size()) continue;
      if (has_texture(model_.materials[m]) && !has_uvs(t)) ++untextured;
    }
    for (const int ink : paint_.ink_of_triangle_) {
      uncoloured += paint_.inks_[ink].kind == Ink::Kind::kNone ? 1 : 0;
    }
    if (untextured > 0) {
      warn("uvs_missing_in_part",
           fmt::format("{} triangles have a textured material but no texture coordinates; they "
                       "take its plain colour instead",
                       untextured),
           model_.path.string());
    }
    if (uncoloured > 0 && uncoloured < model_.triangles.size()) {
      warn("colour_missing_in_part",
           fmt::format("{} triangles have no colour at all and stay white", uncoloured),
           model_.path.string());
    }
  }

  Status build_textures() {
    if (pending_.empty()) return {};
    paint_.corner_uvs_ = model_.corner_uvs;
    paint_.chart_of_triangle_.resize(model_.triangles.size());
    for (std::size_t i = 0; i < pending_.size(); ++i) {
      Pending& pending = pending_[i];
      find_charts(static_cast<int>(i), pending);
      HP_ASSIGN_OR_RETURN(Texture texture, Texture::build(std::move(pending.texels), pending.wrap_u,
                                                          pending.wrap_v, context_));
      paint_.textures_.push_back(std::move(texture));
    }
    return {};
  }

  void find_charts(int texture, Pending& pending) {
    std::vector<std::size_t> users;
    std::vector<UvTriangle> triangles;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      const Ink& ink = paint_.inks_[paint_.ink_of_triangle_[t]];
      if (ink.kind != Ink::Kind::kTexture || ink.texture != texture) continue;
      UvTriangle triangle;
      for (int i = 0; i < 3; ++i) {
        triangle.uv[i] = model_.corner_uvs[t][i].cast<double>();
        triangle.position[i] = model_.vertices[model_.triangles[t][i]];
      }
      users.push_back(t);
      triangles.push_back(triangle);
    }
    const std::vector<Chart> charts =
        make_charts(triangles, pending.wrap_u, pending.wrap_v, pending.texels);
    for (std::size_t i = 0; i < users.size(); ++i) paint_.chart_of_triangle_[users[i]] = charts[i];
  }

  const mesh::Model& model_;
  const Context& context_;
  Paint paint_;
  std::vector<Pending> pending_;
  std::int64_t area_px_ = 0;
  /// A texture and its use: path, hash of the embedded content (if any), wrap modes.
  using Key = std::tuple<std::filesystem::path, std::size_t, mesh::Wrap, mesh::Wrap>;
  std::map<Key, int> known_;
};

Result<Paint> load_paint(const mesh::Model& model,
                         const std::optional<std::filesystem::path>& texture,
                         const Context& context) {
  return PaintLoader(model, context).load(texture);
}

}  // namespace hydroprint::image
