#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/pipeline/pipeline.h"
#include "sim/worker/common/object.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class DipFacts;
class ProfileFacts;
}  // namespace hydroprint::v1

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Options of the dip of an object through a film.
struct DipOptions {
  ObjectOptions object;
  std::filesystem::path profile;   ///< empty: the defaults of film::Profile
  std::optional<double> depth_mm;  ///< nullopt: full depth
  double dip_speed_mm_per_s = 5;
};

template <class Spec>
Result<DipOptions> dip_options(const Spec& spec, const InputFolder& inputs) {
  DipOptions out;
  HP_ASSIGN_OR_RETURN(out.object, object_options(spec, inputs));
  out.profile = inputs.path(spec.profile());
  if (spec.has_depth_mm()) out.depth_mm = spec.depth_mm();
  if (spec.has_dip_speed_mm_per_s()) out.dip_speed_mm_per_s = spec.dip_speed_mm_per_s();
  return out;
}

/// Reads the film and its profile.
[[nodiscard]] Result<pipeline::DipOptions> read_dip(const DipOptions& options);

/// Same as read_dip(). Also reads the ink on the film if `ink_image` is not empty, and adds the ICC
/// profile that the film profile names to the inputs of the run.
[[nodiscard]] Result<pipeline::DipOptions> read_inked_dip(const DipOptions& options,
                                                          const std::filesystem::path& ink_image,
                                                          v1::RunFacts& run,
                                                          const Context& context);

/// Sets the parameters in report.json that all verbs with a dip share.
/// @param dip   the result of read_dip() or read_inked_dip()
/// @param X_FO  the pose of the computed dip
void set_dip(const DipOptions& options, const pipeline::DipOptions& dip, const Pose& X_FO,
             v1::DipFacts& out);

void set_profile(const film::Profile& profile, v1::ProfileFacts& out);

}  // namespace hydroprint::worker
