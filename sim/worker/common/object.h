#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "sim/base/pose_uncertainty.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class Pose;
}

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Options of an object and of the film below it.
struct ObjectOptions {
  std::filesystem::path mesh;
  double scale = 1;                 ///< millimetres per model unit
  std::optional<Pose> X_FO;         ///< nullopt: as in the mesh file, centred on the film
  std::filesystem::path pose_file;  ///< file of X_FO; empty: not from a file
  Warnings pose_warnings;           ///< of pose_warnings_of()
  std::string film = "A4";          ///< name for film::parse_outline()
};

/// Returns the input file of a film for report.json: the file of a polygon; for other films an
/// empty path.
[[nodiscard]] InputPath film_file(const std::string& film);

/// Reads the field `pose`. Returns fail_field() if it is not a rigid transform.
[[nodiscard]] Result<Pose> pose_of(const v1::Pose& pose);

/// Returns the warnings of pose_warnings() for the field `pose`.
[[nodiscard]] Warnings pose_warnings_of(const v1::Pose& pose);

/// Reads the field `film`.
template <class Spec>
Result<std::string> film_of(const Spec& spec, const InputFolder& inputs) {
  return inputs.film(spec.has_film() ? spec.film() : ObjectOptions{}.film);
}

template <class Spec>
Result<ObjectOptions> object_options(const Spec& spec, const InputFolder& inputs) {
  ObjectOptions out;
  HP_ASSIGN_OR_RETURN(out.mesh, inputs.required("mesh", spec.mesh()));
  if (spec.has_scale()) out.scale = spec.scale();
  if (spec.has_pose()) {
    HP_ASSIGN_OR_RETURN(out.X_FO, pose_of(spec.pose()));
    out.pose_file = inputs.pose_file();
    out.pose_warnings = pose_warnings_of(spec.pose());
  }
  HP_ASSIGN_OR_RETURN(out.film, film_of(spec, inputs));
  return out;
}

}  // namespace hydroprint::worker
