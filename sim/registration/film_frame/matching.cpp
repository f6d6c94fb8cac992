#include "sim/registration/film_frame/matching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/check.h"

namespace hydroprint::registration {
namespace {

constexpr double kNear_mm = 4;  ///< maximum distance of a marker from its place
/// Maximum difference in rms error between equally good matchings.
constexpr double kAsGood_mm = 0.7;
/// Maximum difference of side lengths between two triangles of markers.
constexpr double kTriangle_mm = 8;
constexpr double kThin_mm = 30;  ///< minimum height of a triangle of markers

Pose between(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  HP_CHECK(from.size() == to.size());
  HP_CHECK(from.size() >= 3);
  const auto count = static_cast<Eigen::Index>(from.size());
  Eigen::Matrix3Xd a(3, count), b(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    a.col(i) = from[static_cast<std::size_t>(i)];
    b.col(i) = to[static_cast<std::size_t>(i)];
  }
  Pose out = Pose::Identity();
  out.matrix() = Eigen::umeyama(a, b, false);
  return out;
}

class Matcher {
 public:
  Matcher(const std::vector<FoundMarker>& found, const MarkerLayout& layout) : layout_(layout) {
    for (const FoundMarker& f : found) places_.push_back(f.place_C());
  }

  [[nodiscard]] std::vector<Matching> all() const {
    std::vector<Matching> out;
    const auto n = static_cast<int>(places_.size());
    const auto m = static_cast<int>(layout_.markers.size());
    for (int a = 0; a < m; ++a)
      for (int b = a + 1; b < m; ++b)
        for (int c = b + 1; c < m; ++c)
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
              for (int k = 0; k < n; ++k)
                if (i != j && j != k && k != i) try_triple({a, b, c}, {i, j, k}, out);
    return out;
  }

 private:
  using Triple = std::array<int, 3>;

  [[nodiscard]] const Eigen::Vector3d& at(int i) const {
    return places_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Eigen::Vector3d layout_at(int a) const {
    return layout_.markers[static_cast<std::size_t>(a)].X_FM.translation();
  }

  void try_triple(const Triple& of_layout, const Triple& found, std::vector<Matching>& out) const {
    std::vector<Eigen::Vector3d> from, to;
    for (std::size_t s = 0; s < 3; ++s) {
      from.push_back(layout_at(of_layout[s]));
      to.push_back(at(found[s]));
    }
    for (std::size_t s = 0; s < 3; ++s) {
      const std::size_t t = (s + 1) % 3;
      const double differ = (from[s] - from[t]).norm() - (to[s] - to[t]).norm();
      if (std::abs(differ) > kTriangle_mm) return;
    }
    const Eigen::Vector3d side = from[1] - from[0];
    if (side.cross(from[2] - from[0]).norm() < kThin_mm * side.norm()) return;
    const Matching grown = grow(between(from, to));
    if (grown.count() >= 3) out.push_back(grown);
  }

  /// Assigns all markers that are near their places at the given pose, and recomputes the pose from
  /// them.
  [[nodiscard]] Matching grow(Pose pose) const {
    Matching out;
    for (int round = 0; round < 2; ++round) {
      out = {std::vector<int>(layout_.markers.size(), -1), pose};
      std::vector<Eigen::Vector3d> from, to;
      double squares = 0;
      for (std::size_t a = 0; a < layout_.markers.size(); ++a) {
        const Eigen::Vector3d place = pose * layout_at(static_cast<int>(a));
        for (std::size_t i = 0; i < places_.size(); ++i) {
          const double off = (places_[i] - place).squaredNorm();
          if (off > kNear_mm * kNear_mm) continue;
          out.found[a] = static_cast<int>(i);
          from.push_back(layout_at(static_cast<int>(a)));
          to.push_back(places_[i]);
          squares += off;
        }
      }
      if (from.size() < 3) return out;
      out.rms_mm = std::sqrt(squares / static_cast<double>(from.size()));
      pose = between(from, to);
    }
    return out;
  }

  const MarkerLayout& layout_;
  std::vector<Eigen::Vector3d> places_;
};

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

}  // namespace

int Matching::count() const {
  return static_cast<int>(std::count_if(found.begin(), found.end(), [](int i) { return i >= 0; }));
}

Matching match(const std::vector<FoundMarker>& found, const MarkerLayout& layout,
               const Pose& nominal_CF) {
  std::vector<Matching> all = Matcher(found, layout).all();
  int most = 0;
  for (const Matching& m : all) most = std::max(most, m.count());
  std::erase_if(all, [&](const Matching& m) { return m.count() < most; });
  double least_rms = 1e9;
  for (const Matching& m : all) least_rms = std::min(least_rms, m.rms_mm);
  std::erase_if(all, [&](const Matching& m) { return m.rms_mm > least_rms + kAsGood_mm; });
  if (all.empty()) return {std::vector<int>(layout.markers.size(), -1), nominal_CF};
  return *std::min_element(all.begin(), all.end(), [&](const Matching& a, const Matching& b) {
    return turn_between(a.X_CF, nominal_CF) < turn_between(b.X_CF, nominal_CF);
  });
}

}  // namespace hydroprint::registration
