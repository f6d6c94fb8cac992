#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/base/context.h"
#include "sim/image/io/image_file.h"
#include "sim/image/texture/charts.h"
#include "sim/mesh/model.h"

namespace hydroprint::image {

/// An image that can be sampled at any resolution: linear light, a mipmap pyramid, and averages
/// that stay within one chart.
class Texture {
 public:
  /// Uses the texels as level 0 and builds the other levels. Takes 8 bytes per texel, plus a third
  /// for the pyramid.
  [[nodiscard]] static Result<Texture> build(Texels texels, mesh::Wrap wrap_u, mesh::Wrap wrap_v,
                                             const Context& context);

  /// The shape of a sample's neighbourhood in the texture; constant over an affine patch.
  struct Footprint {
    int level = 0;
    float blend = 0;  ///< weight of the next coarser level
    int probes = 1;   ///< number of probes along the longer axis of the footprint
    Eigen::Vector2d step_uv = Eigen::Vector2d::Zero();
  };
  /// @param uv_per_sample  columns: change of (u, v) from one sample to the next in x and in y
  [[nodiscard]] Footprint footprint(const Eigen::Matrix2d& uv_per_sample) const;

  /// Returns the mean colour, linear light, of the footprint around a point (v up).
  [[nodiscard]] Eigen::Vector3f sample(const Eigen::Vector2d& uv, const Footprint& footprint,
                                       const Chart& chart) const;

  /// A fast path for samples of an affine patch. It applies to the common case: samples of at most
  /// a texel in size that lie among four texels of their chart, away from the edge of the texture.
  /// The texture must outlive it, and must not be moved.
  class Shortcut {
   public:
    /// Creates a shortcut that never applies.
    Shortcut() = default;
    /// Same as Texture::sample(), up to rounding.
    /// @param offset  from the patch's origin, in samples
    /// @param colour  output: linear light, in [0, 1]
    /// @return false, without a colour, if Texture::sample() has to be used
    [[nodiscard]] bool sample(const Eigen::Vector2d& offset, Eigen::Vector3f& colour) const;

   private:
    friend class Texture;
    const Texels* image_ = nullptr;
    std::uint16_t chart_ = 0;
    /// In texels; (0, 0) is the centre of the upper left texel.
    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
    Eigen::Matrix2d per_sample_ = Eigen::Matrix2d::Zero();
  };
  /// @param uv  texture coordinates of the patch's origin
  [[nodiscard]] Shortcut shortcut(const Eigen::Vector2d& uv, const Eigen::Matrix2d& uv_per_sample,
                                  const Footprint& footprint, const Chart& chart) const;

  [[nodiscard]] int width() const { return levels_[0].width; }
  [[nodiscard]] int height() const { return levels_[0].height; }
  /// The images, each half as large as the one before (rounded up), down to one texel.
  [[nodiscard]] const std::vector<Texels>& levels() const { return levels_; }
  /// The continuation beyond the edges, for u and v.
  [[nodiscard]] const std::array<mesh::Wrap, 2>& wrap() const { return wrap_; }

 private:
  struct Sum {
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    float weight = 0;
  };
  [[nodiscard]] Eigen::Vector2d fold(const Eigen::Vector2d& uv, const Chart& chart) const;
  [[nodiscard]] Sum bilinear(const Eigen::Vector2d& folded, int level, const Chart& chart) const;
  [[nodiscard]] Sum trilinear(const Eigen::Vector2d& folded, const Footprint& footprint,
                              const Chart& chart) const;
  [[nodiscard]] Eigen::Vector3f finer(const Eigen::Vector2d& uv, const Footprint& footprint,
                                      const Chart& chart) const;
  [[nodiscard]] Eigen::Vector3f nearest(const Eigen::Vector2d& folded) const;

  std::vector<Texels> levels_;
  std::array<mesh::Wrap, 2> wrap_ = {mesh::Wrap::kRepeat, mesh::Wrap::kRepeat};
};

}  // namespace hydroprint::image
