#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/texture/raster.h"
#include "sim/image/texture/texture.h"
#include "sim/mesh/model.h"

namespace hydroprint::image {

/// The colour of a small piece of the surface, sampled through an affine map from a sample grid and
/// filtered for that grid.
class Brush {
 public:
  /// White everywhere.
  Brush() = default;
  /// Samples a patch of a texture. Texture and chart must outlive the brush.
  /// @param at  three points on the sample grid
  /// @param uv  their texture coordinates
  Brush(const Texture& texture, const Chart& chart, const Corners& at, const Corners& uv);

  /// Returns the mean colour in linear light over the sample at this grid point.
  [[nodiscard]] Eigen::Vector3f at(double x, double y) const;

 private:
  friend class Paint;
  /// Returns the colour, linear in the position, that a texture is multiplied with.
  [[nodiscard]] Eigen::Vector3f plain(const Eigen::Vector2d& offset) const;

  const Texture* texture_ = nullptr;  ///< nullptr: the brush uses colour_ and colour_per_sample_
  bool tinted_ = false;               ///< they multiply the texture
  const Chart* chart_ = nullptr;
  Texture::Footprint footprint_;
  Texture::Shortcut shortcut_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d uv_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d uv_per_sample_ = Eigen::Matrix2d::Zero();
  Eigen::Vector3f colour_ = Eigen::Vector3f::Ones();
  Eigen::Matrix<float, 3, 2> colour_per_sample_ = Eigen::Matrix<float, 3, 2>::Zero();
};

/// The desired look of the object: a colour for every point of its surface.
class Paint {
 public:
  /// The colour of a triangle as a product in linear light; several triangles may share one.
  struct Ink {
    bool is_known = false;                             ///< false: nothing defines the colour
    Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< linear
    int texture = -1;                                  ///< index into textures(); -1: none
    bool of_surface = false;  ///< one factor is the colour of the vertices, or of the triangle
  };

  /// False if the film would stay white everywhere: the model defines no colours, or only plain
  /// white without a texture.
  [[nodiscard]] bool has_colour() const { return has_colour_; }
  /// True if `texture` was given and shows white in places: it is transparent there, or triangles
  /// have no coordinates.
  [[nodiscard]] bool shows_white() const { return shows_white_; }
  [[nodiscard]] const Warnings& warnings() const { return warnings_; }

  /// Returns the parts of a triangle's colour.
  [[nodiscard]] const Ink& ink(std::size_t model_triangle) const {
    return inks_[ink_of_triangle_[model_triangle]];
  }
  /// Returns a number that triangles have in common if and only if they have the same ink().
  [[nodiscard]] int ink_index(std::size_t model_triangle) const {
    return ink_of_triangle_[model_triangle];
  }
  [[nodiscard]] const std::vector<Texture>& textures() const { return textures_; }
  /// The colours of the surface, linear: of the model's vertices, or else of its triangles. Empty
  /// if no ink uses them.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& vertex_colours() const {
    return vertex_colours_;
  }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& triangle_colours() const {
    return triangle_colours_;
  }

  /// @param model_triangle  index into Model::triangles
  /// @param at           three points of that triangle on the sample grid (sample (i, j) at (i +
  ///                     1/2, j + 1/2))
  /// @param barycentric  the three points as barycentric coordinates in that triangle
  [[nodiscard]] Brush brush(int model_triangle, const Corners& at,
                            const std::array<Eigen::Vector3d, 3>& barycentric) const;

 private:
  friend class PaintLoader;
  /// Multiplies the brush's colour with that of the surface.
  void tint(int model_triangle, const Corners& at,
            const std::array<Eigen::Vector3d, 3>& barycentric, Brush& brush) const;

  bool has_colour_ = false, shows_white_ = false;
  Warnings warnings_;
  std::vector<Ink> inks_;
  std::vector<int> ink_of_triangle_;
  std::vector<Texture> textures_;
  std::vector<Chart> chart_of_triangle_;  ///< empty: the model has no textures
  std::vector<std::array<Eigen::Vector2f, 3>> corner_uvs_;
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<Eigen::Vector3f> vertex_colours_;    ///< linear; empty: not used
  std::vector<Eigen::Vector3f> triangle_colours_;  ///< linear; empty: not used
};

/// How a texture is read and continued beyond its edges.
struct TextureUse {
  Decoding decoding;
  bool repeats = true;  ///< false: its edge continues
};

/// Loads a model's colours: `texture` on its UVs if given, otherwise its materials' textures and
/// colours, otherwise those of its vertices or triangles; for materials that multiply, their
/// product. `use` applies to `texture` only. Returns the errors of read_image(). Other errors name
/// file and remedy: kInvalidArgument for a texture on a model without UVs, kNotFound for a
/// material's missing texture, kOutOfRange for more than kMaxImageArea_px in all textures together.
[[nodiscard]] Result<Paint> load_paint(const mesh::Model& model,
                                       const std::optional<std::filesystem::path>& texture,
                                       const Context& context, const TextureUse& use = {});

/// Takes only the colours of the model's vertices, otherwise those of its triangles.
[[nodiscard]] Paint load_surface_colours(const mesh::Model& model);

/// Returns a paint without any colour.
[[nodiscard]] Paint blank_paint(const mesh::Model& model);

}  // namespace hydroprint::image
