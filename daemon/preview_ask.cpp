#include "daemon/preview_ask.h"

#include <nlohmann/json.hpp>

#include "daemon/convert.h"
#include "daemon/spec.h"
#include "hydroprint/v1/preview_service.pb.h"

namespace hydroprint::daemon {
namespace {

bool is_polygon(const std::string& film) { return film.starts_with("polygon:"); }

/// What stays while the object is turned.
v1::SimulateSpec object_of(const v1::SimulateSpec& spec) {
  v1::SimulateSpec out;
  if (spec.has_mesh()) *out.mutable_mesh() = spec.mesh();
  *out.mutable_extra_files() = spec.extra_files();
  if (spec.has_profile()) *out.mutable_profile() = spec.profile();
  if (spec.has_scale()) out.set_scale(spec.scale());
  if (is_polygon(spec.film())) out.set_film(spec.film());
  return out;
}

/// What does not.
v1::SimulateSpec dip_of(const v1::SimulateSpec& spec) {
  v1::SimulateSpec out;
  if (spec.has_pose()) *out.mutable_pose() = spec.pose();
  if (spec.has_film() && !is_polygon(spec.film())) out.set_film(spec.film());
  if (spec.has_depth_mm()) out.set_depth_mm(spec.depth_mm());
  if (spec.has_dip_speed_mm_per_s()) out.set_dip_speed_mm_per_s(spec.dip_speed_mm_per_s());
  return out;
}

Result<Work> check(const v1::SimulateSpec& spec) {
  v1::Job job;
  *job.mutable_simulate() = spec;
  HP_ASSIGN_OR_RETURN(NewJob made, check_job(job));
  return std::move(made.work);
}

std::string keys_of(const v1::SimulateSpec& dip, const std::string& pose_json) {
  nlohmann::json out = nlohmann::json::object();
  if (dip.has_film()) out["film"] = dip.film();
  if (dip.has_depth_mm()) out["depth_mm"] = dip.depth_mm();
  if (dip.has_dip_speed_mm_per_s()) out["dip_speed_mm_per_s"] = dip.dip_speed_mm_per_s();
  if (!pose_json.empty()) out["pose"] = nlohmann::json::parse(pose_json);
  const std::string text = out.dump();
  return text.substr(1, text.size() - 2);
}

}  // namespace

Result<PreviewAsk> check_preview(const v1::ComputePreviewRequest& request) {
  const v1::SimulateSpec object = object_of(request.simulate()), dip = dip_of(request.simulate());
  v1::SimulateSpec both = object;
  both.MergeFrom(dip);
  HP_ASSIGN_OR_RETURN(const Work work, check(both));
  PreviewAsk ask;
  ask.key = deterministic_bytes(object);
  HP_ASSIGN_OR_RETURN(ask.object, check(object));
  ask.object.verb = "preview";
  ask.dip = keys_of(dip, work.pose_json);
  return ask;
}

}  // namespace hydroprint::daemon
