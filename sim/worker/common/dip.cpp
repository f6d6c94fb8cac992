#include "sim/worker/common/dip.h"

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
                                            const std::filesystem::path& ink_image, Report& report,
                                            const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip, read_dip(options));
  HP_RETURN_IF_ERROR(add_inputs(report, {{"ink_icc_profile", dip.profile.ink_icc_profile}}));
  if (!ink_image.empty()) {
    HP_ASSIGN_OR_RETURN(dip.ink, ink::read_ink_image(ink_image, dip.outline,
                                                     {dip.profile.ink_icc_profile}, context));
  }
  return dip;
}

Json dip_parameters_json(const DipOptions& options, const pipeline::DipOptions& dip,
                         const Pose& X_FO, int threads) {
  Json out = {{"scale", options.object.scale},
              {"pose", pose_json(X_FO)},
              {"film", film_json(dip.outline)},
              {"profile", profile_json(dip.profile)},
              {"depth_mm", "full"},
              {"dip_speed_mm_per_s", options.dip_speed_mm_per_s},
              {"threads", threads}};
  if (options.depth_mm) out["depth_mm"] = *options.depth_mm;
  return out;
}

Json profile_json(const film::Profile& p) {
  return {{"thickness_mm", p.thickness_mm},
          {"ink_ratio_mm", p.ink_ratio_mm},
          {"ink_icc_profile", p.ink_icc_profile.string()},
          {"swelling", pair_of(p.swelling)},
          {"drag_length_mm", p.drag_length_mm},
          {"tear_stretch", p.tear_stretch},
          {"wrinkle_stretch", p.wrinkle_stretch},
          {"young_modulus_mpa", p.young_modulus_mpa},
          {"density_kg_per_m3", p.density_kg_per_m3},
          {"poisson_ratio", p.poisson_ratio},
          {"activator_ml_per_m2", p.activator_ml_per_m2},
          {"soak_s", p.soak_s},
          {"activator_wait_s", p.activator_wait_s}};
}

Json stretch_json(const pipeline::DipFigures& figures) {
  return {{"p50", figures.stretch_p50}, {"p95", figures.stretch_p95}, {"max", figures.stretch_max}};
}

}  // namespace hydroprint::worker
