#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/mesh/surface.h"
#include "sim/registration/film_frame/film_frame.h"
#include "sim/registration/object/object_points.h"
#include "sim/registration/visibility.h"

namespace hydroprint::registration {

/// Where the object hangs, and how well that is known.
struct ObjectPose {
  Pose X_FO = Pose::Identity();
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< film frame; the covariance is about it
  /// Of the twist (film frame) between X_FO and the truth: noise in the object's and in the
  /// markers' depths, the camera's uncertainty, the nominal pose's along weak directions.
  Matrix6 covariance = Matrix6::Zero();
  PoseFit fit;                    ///< in the camera frame
  std::vector<std::string> weak;  ///< what the scan does not tell, in words, film frame
  double misfit_mm = 0;  ///< rms distance of scan from mesh beyond noise: of means over 16 pixels
  double on_share = 0;   ///< of the scan's points that lie within 4 mm of the mesh
  Sight sight;
  Warnings warnings;  ///< `object_partly_out_of_view`, `object_partly_hidden`, `pose_unconstrained`
};

/// What find_object() is given beside the scan.
struct ObjectTask {
  mesh::Surface surface;  ///< frame O
  Pose nominal_FO = Pose::Identity();
  Surroundings surroundings;
  FitOptions fit;
};

/// Finds the object: points that cannot be its own masked, rough alignments from many starts, each
/// fitted; of those that explain the scan about equally well (a board turned by a quarter does) the
/// one nearest to the nominal pose. What no point tells is taken from the nominal pose, and said.
/// Refuses with kFailedPrecondition: NO_OBJECT; WRONG_UNITS where the mesh is as much too small or
/// large as a unit explains, naming the unit; TWO_OBJECTS where a good part of the scan belongs to
/// something beside the object; MIRRORED where the mesh fits in a mirror only; NOT_THIS_OBJECT.
[[nodiscard]] Result<ObjectPose> find_object(const scan::Cloud& cloud,
                                             const scan::DepthFrame& depth,
                                             const FilmFrame& film_frame, const ObjectTask& task,
                                             const Context& context);

}  // namespace hydroprint::registration
