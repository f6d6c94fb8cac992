#include "sim/scan/cloud.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "sim/scan/point_grid.h"

namespace hydroprint::scan {
namespace {

constexpr double kJump_mm = 12;         ///< depth difference of neighbours at the edge of a surface
constexpr double kSameSurface_mm = 15;  ///< maximum depth difference of pixels for a normal
constexpr int kReach_px = 5, kEvery_px = 2;  ///< every second pixel, because neighbours share noise
constexpr int kFewest = 6;                   ///< minimum number of pixels for a normal

bool on_a_surface(const PointGrid& grid, int u, int v) {
  if (!grid.holds(u, v)) return false;
  const double depth = grid.at(u, v).z();
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      if (!grid.holds(u + du, v + dv)) return false;
      if (std::abs(grid.at(u + du, v + dv).z() - depth) > kJump_mm) return false;
    }
  }
  return true;
}

/// Returns the normal at a pixel; zero if there are too few pixels around it.
Eigen::Vector3d normal_at(const PointGrid& grid, int u, int v) {
  const Eigen::Vector3d& centre = grid.at(u, v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (int dv = -kReach_px; dv <= kReach_px; dv += kEvery_px) {
    for (int du = -kReach_px; du <= kReach_px; du += kEvery_px) {
      if (!grid.holds(u + du, v + dv)) continue;
      const Eigen::Vector3d d = grid.at(u + du, v + dv) - centre;
      if (std::abs(d.z()) > kSameSurface_mm) continue;
      sum += d;
      squares += d * d.transpose();
      ++count;
    }
  }
  if (count < kFewest) return Eigen::Vector3d::Zero();
  const Eigen::Matrix3d spread = squares - sum * sum.transpose() / count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  return normal.dot(centre) > 0 ? Eigen::Vector3d(-normal) : normal;
}

ScanPoint point_at(const PointGrid& grid, const FusedFrame& fused, const Camera& camera,
                   const DepthNoise& noise, int u, int v) {
  const std::size_t i = fused.mean.index(u, v);
  const int patches_across = (grid.width_px + noise.patch_px - 1) / noise.patch_px;
  const double scale = camera.lens.depth_scale;
  const double reported = grid.at(u, v).z() / scale;
  const double usual = scale * noise.constant_sigma_mm(reported);
  return {grid.at(u, v),
          normal_at(grid, u, v),
          reported,
          scale * fused.sigma_mm[i],
          usual * camera.pattern.left(u, v),
          usual,
          u,
          v,
          v / noise.patch_px * patches_across + u / noise.patch_px};
}

PointGrid points_of(const DepthFrame& mean, const Camera& camera, const DepthNoise& noise) {
  PointGrid out{mean.width_px, mean.height_px, camera.lens.rays()};
  for (int v = 0; v < mean.height_px; ++v) {
    for (int u = 0; u < mean.width_px; ++u) {
      const std::size_t i = mean.index(u, v);
      const double reported = mean.depth_mm[i];
      out.points[i] *=
          reported > 0
              ? camera.lens.true_depth_mm(camera.pattern.taken_off_mm(u, v, reported, noise))
              : 0;
    }
  }
  return out;
}

}  // namespace

const ScanPoint* Cloud::at(int u, int v) const {
  if (u < 0 || v < 0 || u >= camera.lens.width_px || v >= camera.lens.height_px) return nullptr;
  const int i =
      at_pixel[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.lens.width_px) +
               static_cast<std::size_t>(u)];
  return i < 0 ? nullptr : &points[static_cast<std::size_t>(i)];
}

Result<Cloud> make_cloud(const FusedFrame& fused, const Camera& camera, const DepthNoise& noise,
                         const Context& context) {
  const DepthFrame& mean = fused.mean;
  const Lens& lens = camera.lens;
  if (mean.width_px != lens.width_px || mean.height_px != lens.height_px)
    return fail(Code::kInvalidArgument,
                fmt::format("the lens model is for {} x {} pixels, but the frames have {} x {}. "
                            "Calibrate the camera at the resolution of the frames",
                            lens.width_px, lens.height_px, mean.width_px, mean.height_px));
  HP_RETURN_IF_ERROR(camera.pattern.check_for(mean.width_px, mean.height_px, noise));
  const PointGrid grid = points_of(mean, camera, noise);
  std::vector<std::vector<ScanPoint>> rows(static_cast<std::size_t>(grid.height_px));
  const auto find_row = [&](std::size_t v) -> Status {
    for (int u = 0; u < grid.width_px; ++u) {
      if (!on_a_surface(grid, u, static_cast<int>(v))) continue;
      ScanPoint p = point_at(grid, fused, camera, noise, u, static_cast<int>(v));
      if (p.normal.squaredNorm() > 0) rows[v].push_back(std::move(p));
    }
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "normals", rows.size(), find_row));
  Cloud cloud{camera, {}, std::vector<int>(grid.points.size(), -1)};
  for (const auto& row : rows) {
    for (const ScanPoint& p : row) {
      cloud.at_pixel[mean.index(p.u, p.v)] = static_cast<int>(cloud.points.size());
      cloud.points.push_back(p);
    }
  }
  return cloud;
}

}  // namespace hydroprint::scan
