#include "sim/registration/pairs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "sim/base/check.h"
#include "sim/scan/camera_errors.h"

namespace hydroprint::registration {
namespace {

constexpr double kLeastCosine = 0.2;  ///< minimum cosine between normal and line of sight
constexpr double kLeastAlike = 0.4;   ///< minimum cosine between the normals of surface and scan
constexpr double kSurfaceError_mm = 0.1;  ///< error of meshes and of pixel positions
constexpr std::size_t kAtOnce = 256;

std::optional<SurfacePoint> partner(const Shape& shape, const scan::ScanPoint& scan,
                                    const Pose& X_BC, Pairing pairing) {
  if (pairing == Pairing::kNearest) return shape.closest(X_BC * scan.point_mm);
  return shape.hit(X_BC.translation(), X_BC * scan.point_mm);
}

bool make_pair(const scan::ScanPoint& scan, const SurfacePoint& on_B, const Pose& X_CB,
               double reach_mm, Pair& out) {
  out.scan = &scan;
  out.on_mm = X_CB * on_B.point_mm;
  out.normal = X_CB.linear() * on_B.normal;
  const Eigen::Vector3d away = scan.point_mm - out.on_mm;
  if (!(away.squaredNorm() <= reach_mm * reach_mm)) return false;
  if (out.normal.dot(scan.normal) < kLeastAlike) return false;
  const Eigen::Vector3d ray = scan.point_mm / scan.point_mm.z();
  const double across = -out.normal.dot(ray);
  if (across < kLeastCosine * ray.norm()) return false;
  out.residual_mm = out.normal.dot(away);
  out.changing_sigma_mm = across * scan.sigma_mm;
  out.constant_sigma_mm = across * scan.constant_sigma_mm;
  out.usual_constant_mm = across * scan.usual_constant_mm;
  return true;
}

double weight_of(const Pair& pair, double robust) {
  const double sigma = pair.sigma_mm();
  return robust / (sigma * sigma);
}

}  // namespace

double Pair::sigma_mm() const { return std::hypot(own_sigma_mm(), constant_sigma_mm); }

double Pair::usual_sigma_mm() const { return std::hypot(own_sigma_mm(), usual_constant_mm); }

double Pair::own_sigma_mm() const { return std::hypot(changing_sigma_mm, kSurfaceError_mm); }

Result<std::vector<Pair>> pair_up(const Shape& shape, std::span<const scan::ScanPoint> points,
                                  const Pose& X_CB, Pairing pairing, double reach_mm,
                                  const Context& context) {
  const Pose X_BC = X_CB.inverse();
  const std::size_t blocks = (points.size() + kAtOnce - 1) / kAtOnce;
  std::vector<std::vector<Pair>> found(blocks);
  const auto pair_block = [&](std::size_t b) -> Status {
    Pair pair;
    for (std::size_t i = b * kAtOnce; i < std::min(points.size(), (b + 1) * kAtOnce); ++i) {
      const auto on_B = partner(shape, points[i], X_BC, pairing);
      if (on_B && make_pair(points[i], *on_B, X_CB, reach_mm, pair)) found[b].push_back(pair);
    }
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "", blocks, pair_block));
  std::vector<Pair> out;
  out.reserve(points.size());
  for (const auto& block : found) out.insert(out.end(), block.begin(), block.end());
  return out;
}

Vector6 direction(const Pair& pair, const Eigen::Vector3d& centre, double length_mm) {
  Vector6 out;
  out << (pair.on_mm - centre).cross(pair.normal) / length_mm, pair.normal;
  return out;
}

Normals normal_equations(std::span<const Pair> pairs, std::span<const double> weights,
                         const Eigen::Vector3d& centre, double length_mm) {
  HP_CHECK(weights.size() == pairs.size());
  HP_CHECK(length_mm > 0);
  Normals out;
  std::unordered_map<int, Vector6> patches;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i];
    const double w = weight_of(pair, weights[i]);
    if (w == 0) continue;
    const Vector6 j = direction(pair, centre, length_mm);
    out.information += w * j * j.transpose();
    out.pull += w * pair.residual_mm * j;
    const Vector6 changing = w * pair.changing_sigma_mm * j;
    out.scatter += changing * changing.transpose();
    patches.try_emplace(pair.scan->patch, Vector6::Zero()).first->second +=
        w * pair.constant_sigma_mm * j;
  }
  for (const auto& [patch, sum] : patches) out.scatter += sum * sum.transpose();
  return out;
}

void add_camera(Normals& normals, std::span<const Pair> pairs, std::span<const double> weights,
                const Eigen::Vector3d& centre, double length_mm, const scan::Camera& camera) {
  HP_CHECK(weights.size() == pairs.size());
  const scan::CameraErrors errors(camera);
  normals.camera = CameraGain::Zero(6, errors.count());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i];
    const double w = weight_of(pair, weights[i]);
    if (w == 0) continue;
    normals.camera +=
        w * direction(pair, centre, length_mm) * errors.along(pair.normal, *pair.scan);
  }
}

}  // namespace hydroprint::registration
