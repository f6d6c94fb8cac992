#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/mesh/surface.h"
#include "sim/registration/film_frame/film_frame.h"
#include "sim/registration/object/object_points.h"
#include "sim/registration/visibility.h"

namespace hydroprint::registration {

/// Pose of the object and its uncertainty.
struct ObjectPose {
  Pose X_FO = Pose::Identity();
  /// Film frame; origin of the covariance's twist.
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  /// Covariance of the twist (film frame) between X_FO and the true pose. It includes noise in the
  /// depths of object and markers, the camera's uncertainty and, along weak directions, the nominal
  /// pose's uncertainty.
  Matrix6 covariance = Matrix6::Zero();
  PoseFit fit;                    ///< pose in the camera frame
  std::vector<std::string> weak;  ///< motions that the scan does not determine (describe())
  std::string symmetry;           ///< turns that carry the mesh onto itself (describe_symmetry())
  double misfit_mm = 0;  ///< rms, over blocks of 16 x 16 pixels, of the mean distance from the mesh
  double on_share = 0;   ///< fraction of the scan's points within 4 mm of the mesh
  Sight sight;
  Warnings warnings;  ///< `OBJECT_PARTLY_OUT_OF_VIEW`, `OBJECT_PARTLY_HIDDEN`
};

/// Input of find_object() besides the scan.
struct ObjectTask {
  mesh::Surface surface;  ///< frame O
  Pose nominal_FO = Pose::Identity();
  Surroundings surroundings;
  FitOptions fit;
};

/// Finds the object. Removes points that cannot belong to it, then fits rough alignments from many
/// initial poses. If several explain the scan equally well within noise, as quarter turns of a
/// board do, returns the one nearest to the nominal pose. Motions that the scan does not determine,
/// and turns that carry the mesh onto itself, are taken from the nominal pose. Fails with
/// kFailedPrecondition: NO_OBJECT; WRONG_UNITS if the mesh would have the right size in another
/// unit, which the message names; TWO_OBJECTS if a large part of the scan belongs to something
/// else; MIRRORED if only the mirrored mesh fits; otherwise NOT_THIS_OBJECT.
[[nodiscard]] Result<ObjectPose> find_object(const scan::Cloud& cloud,
                                             const scan::DepthFrame& depth,
                                             const FilmFrame& film_frame, const ObjectTask& task,
                                             const Context& context);

}  // namespace hydroprint::registration
