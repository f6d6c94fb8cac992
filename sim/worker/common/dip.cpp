#include "sim/worker/common/dip.h"

#include "hydroprint/v1/report.pb.h"
#include "sim/film/outline.h"
#include "sim/film/profile.h"
#include "sim/ink/ink_of.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {

Result<pipeline::DipOptions> read_dip(const DipOptions& options) {
  pipeline::DipOptions dip;
  HP_ASSIGN_OR_RETURN(dip.outline, film::parse_outline(options.object.film));
  dip.X_FO = options.object.X_FO;
  if (!options.profile.empty()) {
    HP_ASSIGN_OR_RETURN(dip.profile, film::read_profile(options.profile));
  }
  dip.depth_mm = options.depth_mm;
  dip.dip_speed_mm_per_s = options.dip_speed_mm_per_s;
  return dip;
}

Result<pipeline::DipOptions> read_inked_dip(const DipOptions& options,
                                            const std::filesystem::path& ink_image,
                                            v1::RunFacts& run, const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip, read_dip(options));
  HP_RETURN_IF_ERROR(add_inputs(run, {{"ink_icc_profile", dip.profile.ink_icc_profile}}));
  if (!ink_image.empty()) {
    HP_ASSIGN_OR_RETURN(dip.ink, ink::read_ink_image(ink_image, dip.outline,
                                                     {dip.profile.ink_icc_profile}, context));
  }
  return dip;
}

void set_dip(const DipOptions& options, const pipeline::DipOptions& dip, const Pose& X_FO,
             v1::DipFacts& out) {
  out.set_scale(options.object.scale);
  set_pose(X_FO, *out.mutable_pose());
  set_film(dip.outline, *out.mutable_film());
  set_profile(dip.profile, *out.mutable_profile());
  if (options.depth_mm) out.set_depth_mm(*options.depth_mm);
  out.set_dip_speed_mm_per_s(options.dip_speed_mm_per_s);
}

void set_profile(const film::Profile& profile, v1::ProfileFacts& out) {
  out.set_thickness_mm(profile.thickness_mm);
  out.set_ink_ratio_mm(profile.ink_ratio_mm);
  out.set_ink_icc_profile(profile.ink_icc_profile.string());
  add_all(profile.swelling, out.mutable_swelling());
  out.set_drag_length_mm(profile.drag_length_mm);
  out.set_tear_stretch(profile.tear_stretch);
  out.set_wrinkle_stretch(profile.wrinkle_stretch);
  out.set_young_modulus_mpa(profile.young_modulus_mpa);
  out.set_density_kg_per_m3(profile.density_kg_per_m3);
  out.set_poisson_ratio(profile.poisson_ratio);
  out.set_activator_ml_per_m2(profile.activator_ml_per_m2);
  out.set_soak_s(profile.soak_s);
  out.set_activator_wait_s(profile.activator_wait_s);
}

}  // namespace hydroprint::worker
