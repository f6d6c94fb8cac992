#include "sim/mesh/uv_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/base/number_text.h"

namespace hydroprint::mesh {
namespace {

using Uvs = std::array<Eigen::Vector2f, 3>;

constexpr int kSide = 1024;
constexpr double kReportedShare = 0.005;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Counts the uses of each point of one texture, up to two.
class Coverage {
 public:
  void add(const Uvs& uvs) {
    std::array<Eigen::Vector2d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = kSide * uvs[k].cast<double>();
    const Eigen::Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Eigen::Vector2d high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    if ((high - low).maxCoeff() > kSide) {  // the texture is tiled
      ++everywhere_;
      return;
    }
    const double sign = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
    const auto inside = [&](const Eigen::Vector2d& q) {
      for (std::size_t k = 0; k < 3; ++k)
        if (!(sign * cross(p[(k + 1) % 3] - p[k], q - p[k]) > 0)) return false;
      return true;
    };
    for (double y = std::ceil(low.y() - 0.5); y + 0.5 <= high.y(); ++y)
      for (double x = std::ceil(low.x() - 0.5); x + 0.5 <= high.x(); ++x)
        if (inside({x + 0.5, y + 0.5})) use(x, y);
  }

  void count(double& used, double& twice) const {
    for (const int uses : uses_) {
      const int all = uses + everywhere_;
      used += all > 0 ? 1 : 0;
      twice += all > 1 ? 1 : 0;
    }
  }

 private:
  void use(double x, double y) {
    const auto wrapped = [](double c) {
      return static_cast<std::size_t>(c - kSide * std::floor(c / kSide)) % kSide;
    };
    auto& uses = uses_[wrapped(y) * kSide + wrapped(x)];
    if (uses < 2) ++uses;
  }

  std::vector<std::uint8_t> uses_ = std::vector<std::uint8_t>(std::size_t{kSide} * kSide, 0);
  int everywhere_ = 0;
};

/// Returns the fraction of the used texture, over all materials, that is used more than once.
double overlapping_share(const Model& model) {
  double used = 0;
  double twice = 0;
  const std::size_t materials = model.triangle_material.empty() ? 1 : model.materials.size();
  for (std::size_t m = 0; m < materials; ++m) {
    Coverage coverage;
    for (std::size_t t = 0; t < model.corner_uvs.size(); ++t)
      if (model.triangle_material.empty() || model.triangle_material[t] == static_cast<int>(m))
        coverage.add(model.corner_uvs[t]);
    coverage.count(used, twice);
  }
  return used > 0 ? twice / used : 0;
}

double mirrored_share(const Model& model) {
  double mirrored = 0;
  double total = 0;
  for (const auto& uvs : model.corner_uvs) {
    const double area = cross((uvs[1] - uvs[0]).cast<double>(), (uvs[2] - uvs[0]).cast<double>());
    mirrored += area < 0 ? -area : 0;
    total += std::abs(area);
  }
  return total > 0 ? mirrored / total : 0;
}

}  // namespace

Warnings uv_warnings(const Model& model) {
  Warnings warnings;
  if (model.corner_uvs.empty()) return warnings;
  const double overlapping = overlapping_share(model);
  const double mirrored = mirrored_share(model);
  if (overlapping > kReportedShare)
    warnings.push_back({WarningCode::UV_OVERLAPPING,
                        percent(overlapping) + " of the used texture area is shared by several "
                                               "faces, which all get the same picture",
                        {InFile{model.path.string()}}});
  if (mirrored > kReportedShare)
    warnings.push_back({WarningCode::UV_MIRRORED,
                        percent(mirrored) + " of the used texture area is mirrored on the "
                                            "object and is printed that way",
                        {InFile{model.path.string()}}});
  return warnings;
}

}  // namespace hydroprint::mesh
