#include "sim/plan/seam_shift.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace hydroprint::plan {
namespace {

constexpr std::size_t kSamplesPerTask = 256;

bool is_of(const SeamSegment& segment, int dip) {
  return segment.dip == dip || segment.other_dip == dip;
}

std::vector<Eigen::Vector3d> points_of(const std::vector<SeamSegment>& seam, int dip) {
  std::vector<Eigen::Vector3d> out;
  for (const SeamSegment& segment : seam) {
    if (!is_of(segment, dip)) continue;
    const Eigen::Vector3d along = segment.to - segment.from;
    const int parts = std::max(1, static_cast<int>(std::ceil(along.norm() / kSeamSample_mm)));
    for (int i = 0; i <= parts; ++i) out.emplace_back(segment.from + along * i / parts);
  }
  return out;
}

double segment_distance_mm(const Eigen::Vector3d& point, const SeamSegment& segment) {
  const Eigen::Vector3d along = segment.to - segment.from;
  const double squared = along.squaredNorm();
  const double at =
      squared > 0 ? std::clamp((point - segment.from).dot(along) / squared, 0.0, 1.0) : 0;
  return (point - segment.from - at * along).norm();
}

}  // namespace

Result<double> seam_shift_mm(const std::vector<SeamSegment>& seam,
                             const std::vector<SeamSegment>& from, int dip,
                             const Context& context) {
  const std::vector<Eigen::Vector3d> points = points_of(seam, dip);
  std::vector<SeamSegment> own;
  std::copy_if(from.begin(), from.end(), std::back_inserter(own),
               [dip](const SeamSegment& segment) { return is_of(segment, dip); });
  std::vector<double> nearest_mm(points.size(), std::numeric_limits<double>::infinity());
  const std::size_t tasks = (points.size() + kSamplesPerTask - 1) / kSamplesPerTask;
  HP_RETURN_IF_ERROR(parallel_for(context, "", tasks, [&](std::size_t task) -> Status {
    const std::size_t end = std::min(points.size(), (task + 1) * kSamplesPerTask);
    for (std::size_t i = task * kSamplesPerTask; i < end; ++i) {
      for (const SeamSegment& segment : own)
        nearest_mm[i] = std::min(nearest_mm[i], segment_distance_mm(points[i], segment));
    }
    return {};
  }));
  return points.empty() ? 0.0 : *std::max_element(nearest_mm.begin(), nearest_mm.end());
}

}  // namespace hydroprint::plan
