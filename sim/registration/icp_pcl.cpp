#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "sim/registration/icp.h"

namespace hydroprint::registration {
namespace {

using Point = pcl::PointNormal;
using Points = pcl::PointCloud<Point>;

constexpr double kMostTurn_rad = 60 * std::numbers::pi / 180;
constexpr std::size_t kFewestPairs = 6;
/// Steps with a larger translation are dropped, because PCL's search aborts the program on NaN and
/// infinity.
constexpr double kFarthest_mm = 1e4;
constexpr double kLever_mm = 50;           ///< lever arm by which turns are compared with shifts
constexpr double kLeastEigenvalue = 2e-3;  ///< smallest eigenvalue used, relative to the largest
/// PCL stops when the squared step is smaller, in rad^2 and in mm^2.
constexpr double kSettled = 1e-8;

Points::Ptr to_pcl(std::span<const SurfacePoint> points) {
  auto out = pcl::make_shared<Points>();
  out->reserve(points.size());
  for (const SurfacePoint& p : points) {
    Point q;
    q.getVector3fMap() = p.point_mm.cast<float>();
    q.getNormalVector3fMap() = p.normal.cast<float>();
    out->push_back(q);
  }
  return out;
}

Pose to_pose(const Eigen::Matrix4f& matrix) {
  Pose pose = Pose::Identity();
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>().cast<double>();
  pose.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>().cast<double>();
  return pose;
}

/// Minimises the distances along the target's normals by least squares. If the pairs do not
/// determine the whole motion, the shortest solution is used. PCL's own estimation inverts a matrix
/// that is singular if all pairs lie on one flat face, as is common with boards; ICP would then
/// never rotate a board.
class Estimation : public pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point> {
 public:
  using Base = pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point>;
  using Base::estimateRigidTransformation;
  void estimateRigidTransformation(const Points& scan, const Points& target,
                                   const pcl::Correspondences& pairs,
                                   Matrix4& motion) const override {
    motion.setIdentity();
    if (pairs.size() < kFewestPairs) return;
    const Eigen::Vector3d centre = middle(scan, pairs);
    const auto [turn, shift] = step(scan, target, pairs, centre);
    const Eigen::Matrix3d about =
        Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
    Eigen::Matrix4d out = Eigen::Matrix4d::Identity();
    out.topLeftCorner<3, 3>() = about;
    out.topRightCorner<3, 1>() = centre - about * centre + shift;
    if (out.allFinite() && out.cwiseAbs().maxCoeff() < kFarthest_mm) motion = out.cast<float>();
  }

 private:
  static Eigen::Vector3d place(const Points& points, int i) {
    return points[static_cast<std::size_t>(i)].getVector3fMap().cast<double>();
  }
  static Eigen::Vector3d middle(const Points& scan, const pcl::Correspondences& pairs) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& pair : pairs) sum += place(scan, pair.index_query);
    return sum / static_cast<double>(pairs.size());
  }
  /// Returns the rotation (radians) about the centre, and the translation.
  static std::pair<Eigen::Vector3d, Eigen::Vector3d> step(const Points& scan, const Points& target,
                                                          const pcl::Correspondences& pairs,
                                                          const Eigen::Vector3d& centre) {
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> squares = Eigen::Matrix<double, 6, 6>::Zero();
    Vector6 pull = Vector6::Zero();
    for (const auto& pair : pairs) {
      const Eigen::Vector3d from = place(scan, pair.index_query);
      const Eigen::Vector3d normal =
          target[static_cast<std::size_t>(pair.index_match)].getNormalVector3fMap().cast<double>();
      Vector6 row;
      row << (from - centre).cross(normal) / kLever_mm, normal;
      squares += row * row.transpose();
      pull += normal.dot(place(target, pair.index_match) - from) * row;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> axes(squares);
    const double least = kLeastEigenvalue * axes.eigenvalues()[5];
    Vector6 along = axes.eigenvectors().transpose() * pull;
    for (int k = 0; k < 6; ++k)
      along[k] = axes.eigenvalues()[k] > least ? along[k] / axes.eigenvalues()[k] : 0;
    const Vector6 out = axes.eigenvectors() * along;
    return {out.head<3>() / kLever_mm, out.tail<3>()};
  }
};

class PclIcp final : public Icp {
 public:
  explicit PclIcp(std::span<const SurfacePoint> target)
      : target_(to_pcl(target)), tree_(pcl::make_shared<pcl::search::KdTree<Point>>()) {
    // No warnings, because it is normal that some starts fail.
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    tree_->setInputCloud(target_);
  }

  [[nodiscard]] Aligned align(std::span<const SurfacePoint> scan, const Pose& start,
                              double distance_mm, int iterations) const override {
    auto alike = pcl::make_shared<pcl::registration::CorrespondenceRejectorSurfaceNormal>();
    alike->setThreshold(std::cos(kMostTurn_rad));
    pcl::IterativeClosestPointWithNormals<Point, Point> icp;
    icp.setSearchMethodTarget(tree_, true);
    icp.setInputTarget(target_);
    icp.setInputSource(to_pcl(scan));
    icp.setTransformationEstimation(pcl::make_shared<Estimation>());
    icp.addCorrespondenceRejector(alike);
    icp.setMaxCorrespondenceDistance(distance_mm);
    icp.setMaximumIterations(iterations);
    icp.setTransformationEpsilon(kSettled);
    Points out;
    icp.align(out, start.matrix().cast<float>());
    if (!icp.getFinalTransformation().allFinite()) return {start, false};
    return {to_pose(icp.getFinalTransformation()), icp.hasConverged()};
  }

 private:
  Points::Ptr target_;
  pcl::search::KdTree<Point>::Ptr tree_;
};

}  // namespace
}  // namespace hydroprint::registration

extern "C" hydroprint::registration::Icp* hydroprint_icp(
    std::span<const hydroprint::registration::SurfacePoint> target) {
  return new hydroprint::registration::PclIcp(target);
}
