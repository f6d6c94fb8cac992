// What is computed of a dip: simulate, predict, fit, and validate.
#include "daemon/spec_parts.h"
#include "daemon/spec_works.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

template <class Spec>
void add_choices(WorkBuilder& builder, const Spec& spec) {
  if (spec.model() != v1::MODEL_UNSPECIFIED) {
    if (!v1::Model_IsValid(spec.model())) {
      builder.refuse("model", "is not one of sheet, stokes");
    }
    builder.flag("model", spec.model() == v1::MODEL_SHEET ? "sheet" : "stokes");
  }
  if (spec.inertia()) {
    if (spec.model() == v1::MODEL_STOKES) {
      builder.refuse("inertia", "Stokes flow has none; leave it out or let the model be sheet");
    }
    builder.bare_flag("inertia");
  }
  if (spec.artifacts() != v1::ARTIFACT_SET_UNSPECIFIED) {
    if (!v1::ArtifactSet_IsValid(spec.artifacts())) {
      builder.refuse("artifacts", "is not one of all, map");
    }
    builder.flag("artifacts", spec.artifacts() == v1::ARTIFACT_SET_MAP ? "map" : "all");
  }
}

// What goes in which way through which film.
template <class Spec>
void add_dip(WorkBuilder& builder, const Spec& spec, NewJob& made) {
  add_object(builder, spec);
  if (spec.has_profile()) builder.file("profile", "profile", spec.profile());
  if (spec.has_ink_image()) builder.file("ink_image", "ink-image", spec.ink_image());
  if (spec.has_depth_mm()) builder.number("depth_mm", "depth-mm", spec.depth_mm(), 1e6);
  if (spec.has_dip_speed_mm_per_s()) {
    builder.number("dip_speed_mm_per_s", "dip-speed-mm-per-s", spec.dip_speed_mm_per_s(), 1000);
  }
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
}

// What simulate and predict have in common.
template <class Spec>
void add_common(WorkBuilder& builder, const Spec& spec, NewJob& made) {
  add_dip(builder, spec, made);
  if (spec.has_dpi()) add_dpi(builder, spec.dpi());
  if (spec.has_ink_passes()) builder.whole("ink_passes", "ink-passes", spec.ink_passes(), 0, 10);
  add_choices(builder, spec);
}

}  // namespace

Result<Work> work_of(const v1::SimulateSpec& spec, NewJob& made) {
  WorkBuilder builder("simulate");
  add_common(builder, spec, made);
  if (spec.has_texture()) builder.file("texture", "texture", spec.texture());
  return builder.build();
}

Result<Work> work_of(const v1::PredictSpec& spec, NewJob& made) {
  WorkBuilder builder("predict");
  add_common(builder, spec, made);
  add_film_image(builder, spec);
  if (spec.has_motion()) builder.file("motion", "motion", spec.motion());
  return builder.build();
}

Result<Work> work_of(const v1::FitSpec& spec, NewJob& made) {
  WorkBuilder builder("fit");
  add_dip(builder, spec, made);
  if (!spec.has_points()) builder.refuse("points", "is missing");
  if (spec.has_points()) builder.file("points", "points", spec.points());
  add_names(builder, "free", {spec.free().begin(), spec.free().end()}, '_');
  if (spec.drop_outliers()) builder.bare_flag("drop-outliers");
  return builder.build();
}

Result<Work> work_of(const v1::ValidateSpec& spec, NewJob& made) {
  WorkBuilder builder("validate");
  add_names(builder, "only", {spec.only().begin(), spec.only().end()}, '-');
  if (spec.quick()) builder.bare_flag("quick");
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
  return builder.build();
}

}  // namespace hydroprint::daemon
