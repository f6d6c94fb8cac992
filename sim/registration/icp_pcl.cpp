#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_rejection_surface_normal.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

#include <cmath>
#include <numbers>

#include "sim/registration/icp.h"

namespace hydroprint::registration {
namespace {

using Point = pcl::PointNormal;
using Points = pcl::PointCloud<Point>;

constexpr double kMostTurn_rad = 60 * std::numbers::pi / 180;
constexpr std::size_t kFewestPairs = 6;
constexpr float kFarthest_mm = 1e4;
constexpr double kSettled = 1e-8;  ///< PCL's: of squared steps, radian and mm alike

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

/// Stands still where the pairs do not tell a motion: numbers that are none end the program in
/// PCL's search.
class Estimation : public pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point> {
 public:
  using Base = pcl::registration::TransformationEstimationPointToPlaneLLS<Point, Point>;
  using Base::estimateRigidTransformation;
  void estimateRigidTransformation(const Points& scan, const Points& target,
                                   const pcl::Correspondences& pairs,
                                   Matrix4& motion) const override {
    if (pairs.size() >= kFewestPairs)
      Base::estimateRigidTransformation(scan, target, pairs, motion);
    if (pairs.size() < kFewestPairs || !motion.allFinite() ||
        motion.cwiseAbs().maxCoeff() > kFarthest_mm)
      motion.setIdentity();
  }
};

class PclIcp final : public Icp {
 public:
  explicit PclIcp(std::span<const SurfacePoint> target)
      : target_(to_pcl(target)), tree_(pcl::make_shared<pcl::search::KdTree<Point>>()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // a start that fails is no news
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
