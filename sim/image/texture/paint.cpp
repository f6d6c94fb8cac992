#include "sim/image/texture/paint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

bool is_finite(const std::array<Eigen::Vector2f, 3>& uvs) {
  return uvs[0].allFinite() && uvs[1].allFinite() && uvs[2].allFinite();
}

bool all_white(const std::vector<Eigen::Vector3f>& some, const std::vector<Eigen::Vector3f>& more) {
  const auto is_white = [](const Eigen::Vector3f& colour) { return colour.isOnes(); };
  return std::ranges::all_of(some, is_white) && std::ranges::all_of(more, is_white);
}

/// Returns how the texture of a material is decoded. White under transparent parts must stay white,
/// so the factors are applied there if anything can be transparent.
Decoding decoding_of(const mesh::Material& material) {
  Decoding out;
  out.as_stored = material.texture_as_stored;
  if (material.alpha_mode == mesh::AlphaMode::kOpaque) out.alpha = Alpha::kIgnored;
  if (material.alpha_mode == mesh::AlphaMode::kMask) out.alpha = Alpha::kCutOut;
  if (out.alpha == Alpha::kIgnored) return out;
  out.opacity = material.alpha;
  out.cutoff = material.alpha_cutoff;
  if (material.multiplies) out.tint = linear_from_srgb(material.colour);
  return out;
}

/// Returns the linear colour of a material without its texture: blended with white as its alpha
/// says.
Eigen::Vector3f plain_colour(const mesh::Material& material) {
  const Eigen::Vector3f colour = linear_from_srgb(material.colour);
  if (!material.multiplies || material.alpha_mode == mesh::AlphaMode::kOpaque) return colour;
  if (material.alpha_mode == mesh::AlphaMode::kMask)
    return material.alpha < material.alpha_cutoff ? Eigen::Vector3f::Ones() : colour;
  return material.alpha * colour + Eigen::Vector3f::Constant(1 - material.alpha);
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
  if (texture_ == nullptr) return plain(offset);
  Eigen::Vector3f colour;
  if (!shortcut_.sample(offset, colour))
    colour = texture_->sample(uv_ + uv_per_sample_ * offset, footprint_, *chart_);
  return tinted_ ? Eigen::Vector3f(colour.cwiseProduct(plain(offset))) : colour;
}

Eigen::Vector3f Brush::plain(const Eigen::Vector2d& offset) const {
  return (colour_ + colour_per_sample_ * offset.cast<float>()).cwiseMax(0.0F).cwiseMin(1.0F);
}

Brush Paint::brush(int model_triangle, const Corners& at,
                   const std::array<Eigen::Vector3d, 3>& barycentric) const {
  const Ink& ink = inks_[ink_of_triangle_[model_triangle]];
  Brush brush;
  if (ink.texture >= 0) {
    Corners uv;
    for (int i = 0; i < 3; ++i) {
      uv[i].setZero();
      for (int k = 0; k < 3; ++k) {
        uv[i] += barycentric[i][k] * corner_uvs_[model_triangle][k].cast<double>();
      }
    }
    brush = Brush(textures_[ink.texture], chart_of_triangle_[model_triangle], at, uv);
  }
  brush.origin_ = at[0];
  brush.tinted_ = ink.of_surface || !ink.colour.isOnes();
  brush.colour_ = ink.colour;
  if (ink.of_surface) tint(model_triangle, at, barycentric, brush);
  return brush;
}

void Paint::tint(int model_triangle, const Corners& at,
                 const std::array<Eigen::Vector3d, 3>& barycentric, Brush& brush) const {
  if (vertex_colours_.empty()) {
    brush.colour_ = brush.colour_.cwiseProduct(triangle_colours_[model_triangle]);
    return;
  }
  const BarycentricMap map(at);
  const Eigen::Vector3d factor = brush.colour_.cast<double>();
  Eigen::Matrix3d colours, corners;
  for (int i = 0; i < 3; ++i) {
    const auto& colour = vertex_colours_[triangles_[model_triangle][i]];
    colours.col(i) = factor.cwiseProduct(colour.cast<double>());
    corners.col(i) = barycentric[i];
  }
  Eigen::Matrix<double, 3, 2> per_sample;
  per_sample << corners * map.per_x(), corners * map.per_y();
  brush.colour_ = (colours * barycentric[0]).cast<float>();
  brush.colour_per_sample_ = (colours * per_sample).cast<float>();
}

/// Builds a Paint step by step.
class PaintLoader {
 public:
  PaintLoader(const mesh::Model& model, const Context& context) : model_(model), context_(context) {
    paint_.ink_of_triangle_.assign(model_.triangles.size(), 0);
  }

  Result<Paint> load(const std::optional<std::filesystem::path>& texture, const TextureUse& use) {
    HP_RETURN_IF_ERROR(texture ? lay_texture(*texture, use) : gather_materials());
    HP_RETURN_IF_ERROR(build_textures());
    return finish();
  }

  /// Takes the colours of vertices or triangles alone.
  Paint load_surface() {
    paint_.inks_ = {fallback()};
    return finish();
  }

  Paint load_nothing() {
    paint_.inks_ = {Ink{}};
    return finish();
  }

 private:
  using Ink = Paint::Ink;
  struct Pending {
    Texels texels;
    mesh::Wrap wrap_u, wrap_v;
  };

  Paint finish() {
    const bool surface_shows = !all_white(paint_.vertex_colours_, paint_.triangle_colours_);
    paint_.has_colour_ = std::ranges::any_of(paint_.ink_of_triangle_, [&](int index) {
      const Ink& ink = paint_.inks_[index];
      return ink.is_known &&
             (ink.texture >= 0 || !ink.colour.isOnes() || (ink.of_surface && surface_shows));
    });
    return std::move(paint_);
  }

  void warn(WarningCode code, std::string message, std::string file) {
    paint_.warnings_.push_back({code, std::move(message), {InFile{std::move(file)}}});
  }

  bool has_uvs(std::size_t triangle) const {
    return !model_.corner_uvs.empty() && is_finite(model_.corner_uvs[triangle]);
  }

  /// Applies --texture FILE to all triangles that have coordinates.
  Status lay_texture(const std::filesystem::path& path, const TextureUse& use) {
    const auto& uvs = model_.corner_uvs;
    if (std::none_of(uvs.begin(), uvs.end(), is_finite)) {
      return fail(Code::kInvalidArgument,
                  path.string() + ": cannot be applied to " + model_.path.string() +
                      ", which has no texture coordinates (UVs). Choose a projection, "
                      "or unwrap the model in a 3D editor");
    }
    HP_ASSIGN_OR_RETURN(ReadImage read, read_image(path, context_, use.decoding));
    paint_.shows_white_ = read.had_alpha;
    const mesh::Wrap wrap = use.repeats ? mesh::Wrap::kRepeat : mesh::Wrap::kClamp;
    HP_ASSIGN_OR_RETURN(const int index, add_texture(std::move(read), wrap, wrap, path.string()));
    paint_.inks_ = {Ink{}, Ink{true, Eigen::Vector3f::Ones(), index, false}};
    int without = 0;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      paint_.ink_of_triangle_[t] = has_uvs(t) ? 1 : 0;
      without += has_uvs(t) ? 0 : 1;
    }
    if (without > 0) {
      paint_.shows_white_ = true;
      warn(WarningCode::UVS_MISSING_IN_PART,
           fmt::format("{} triangles have no texture coordinates and stay white", without),
           model_.path.string());
    }
    return {};
  }

  /// Returns the ink for triangles whose material defines no colour.
  Ink fallback() {
    if (model_.vertex_colours.empty() && model_.triangle_colours.empty()) return {};
    use_surface_colours();
    return Ink{true, Eigen::Vector3f::Ones(), -1, true};
  }

  void use_surface_colours() {
    if (!paint_.triangles_.empty()) return;
    paint_.triangles_ = model_.triangles;
    // Exporters write plain white for the vertices if the faces have colours.
    if (!all_white(model_.vertex_colours, {}) || model_.triangle_colours.empty())
      append_linear(model_.vertex_colours, paint_.vertex_colours_);
    if (paint_.vertex_colours_.empty())
      append_linear(model_.triangle_colours, paint_.triangle_colours_);
  }

  static void append_linear(const std::vector<Eigen::Vector3f>& from,
                            std::vector<Eigen::Vector3f>& to) {
    to.reserve(from.size());
    for (const auto& colour : from) to.push_back(linear_from_srgb(colour));
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
    without_uvs = plain_ink(material, without_uvs);
    with_uvs = without_uvs;
    if (!has_texture(material) || model_.corner_uvs.empty()) return {};
    const Decoding decoding = decoding_of(material);
    HP_ASSIGN_OR_RETURN(const int index, material_texture(material, decoding));
    if (!material.multiplies) {
      with_uvs = {true, Eigen::Vector3f::Ones(), index, false};
      return {};
    }
    with_uvs.is_known = true;
    with_uvs.texture = index;
    // The factor that the decoder has applied.
    with_uvs.colour = decoding.alpha == Alpha::kIgnored ? linear_from_srgb(material.colour)
                                                        : Eigen::Vector3f::Ones().eval();
    return {};
  }

  /// Returns the ink of a material without its texture.
  Ink plain_ink(const mesh::Material& material, const Ink& otherwise) {
    if (material.multiplies) {
      if (material.uses_vertex_colours) use_surface_colours();
      return {material.has_colour || material.uses_vertex_colours, plain_colour(material), -1,
              material.uses_vertex_colours};
    }
    // Exporters write plain white as the material's colour if the vertices define the colours.
    const bool is_white = material.colour.isOnes();
    if (!material.has_colour || (is_white && otherwise.of_surface)) return otherwise;
    return {true, plain_colour(material), -1, false};
  }

  static bool has_texture(const mesh::Material& material) {
    return !material.texture.empty() || !material.texture_bytes.empty();
  }

  /// Reads a material's texture, once for all materials with the same texture and wrap modes.
  Result<int> material_texture(const mesh::Material& material, const Decoding& decoding) {
    const auto& bytes = material.texture_bytes;
    const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Key key{material.texture,
                  std::hash<std::string_view>()(content),
                  material.wrap_u,
                  material.wrap_v,
                  {static_cast<float>(decoding.as_stored), static_cast<float>(decoding.alpha),
                   decoding.opacity, decoding.cutoff, decoding.tint.x(), decoding.tint.y(),
                   decoding.tint.z()}};
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
    const std::string name =
        model_.path.string() + ", material \"" + material.name + "\", " +
        (bytes.empty() ? "texture " + material.texture.string() : "embedded texture");
    auto read = bytes.empty() ? read_image(material.texture, context_, decoding)
                              : read_image(bytes, name, context_, decoding);
    if (!read) {
      Error error = std::move(read).error();
      if (error.code == Code::kNotFound) {
        error.message = name +
                        ": no such file. Put the texture there, correct the path in the "
                        "material, or name a picture";
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
      warn(WarningCode::ALPHA_OVER_WHITE,
           "the texture is transparent in places and was blended with white", name);
    }
    std::ranges::move(read.warnings, std::back_inserter(paint_.warnings_));
    pending_.push_back({std::move(read.image), wrap_u, wrap_v});
    return static_cast<int>(pending_.size()) - 1;
  }

  void warn_of_materials() {
    std::size_t untextured = 0;
    for (std::size_t t = 0; t < model_.triangle_material.size(); ++t) {
      const mesh::Material* material = model_.material_of(t);
      if (material != nullptr && has_texture(*material) && !has_uvs(t)) ++untextured;
    }
    if (untextured > 0) {
      warn(WarningCode::UVS_MISSING_IN_PART,
           fmt::format("{} triangles have a textured material but no texture coordinates; they "
                       "take its plain colour instead",
                       untextured),
           model_.path.string());
    }
    warn_of_missing_colour();
  }

  /// Warns if some of the triangles have no colour, with their share of the surface.
  void warn_of_missing_colour() {
    std::size_t uncoloured = 0;
    double area_mm2 = 0, missing_mm2 = 0;
    std::set<std::string> names;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      const double mm2 = area_of(model_.triangles[t]);
      area_mm2 += mm2;
      if (paint_.inks_[paint_.ink_of_triangle_[t]].is_known) continue;
      ++uncoloured;
      missing_mm2 += mm2;
      const mesh::Material* material = model_.material_of(t);
      if (material != nullptr && names.size() < 3) names.insert("\"" + material->name + "\"");
    }
    if (uncoloured == 0 || uncoloured == model_.triangles.size()) return;
    std::string message =
        fmt::format("{} triangles, {} of the surface, have no colour at all and stay white",
                    uncoloured, percent(area_mm2 > 0 ? missing_mm2 / area_mm2 : 0));
    if (!names.empty()) message += fmt::format("; their materials: {}", fmt::join(names, ", "));
    if (!model_.not_understood.empty())
      message += "; found, but not understood: " + model_.not_understood.front();
    warn(WarningCode::COLOUR_MISSING_IN_PART, message, model_.path.string());
  }

  [[nodiscard]] double area_of(const Eigen::Vector3i& triangle) const {
    const auto& p = model_.vertices;
    return (p[triangle[1]] - p[triangle[0]]).cross(p[triangle[2]] - p[triangle[0]]).norm() / 2;
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
      if (ink.texture != texture) continue;
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
  /// A texture and its use: path, hash of the embedded content (if any), wrap modes, decoding.
  using Key =
      std::tuple<std::filesystem::path, std::size_t, mesh::Wrap, mesh::Wrap, std::array<float, 7>>;
  std::map<Key, int> known_;
};

Result<Paint> load_paint(const mesh::Model& model,
                         const std::optional<std::filesystem::path>& texture,
                         const Context& context, const TextureUse& use) {
  return PaintLoader(model, context).load(texture, use);
}

Paint load_surface_colours(const mesh::Model& model) {
  return PaintLoader(model, Context{}).load_surface();
}

Paint blank_paint(const mesh::Model& model) { return PaintLoader(model, Context{}).load_nothing(); }

}  // namespace hydroprint::image
