#include "daemon/workers/preview_request.h"

#include <google/protobuf/util/json_util.h>

#include "daemon/jobs/job_request.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/preview_service.pb.h"

namespace hydroprint::daemon {
namespace {

bool is_polygon(const std::string& film) { return film.starts_with("polygon:"); }

/// Returns the parts of a spec that stay the same while the object is rotated.
v1::SimulateSpec object_of(const v1::SimulateSpec& spec) {
  v1::SimulateSpec out;
  if (spec.has_mesh()) *out.mutable_mesh() = spec.mesh();
  *out.mutable_extra_files() = spec.extra_files();
  if (spec.has_profile()) *out.mutable_profile() = spec.profile();
  if (spec.has_scale()) out.set_scale(spec.scale());
  if (is_polygon(spec.film())) out.set_film(spec.film());
  return out;
}

/// Returns the parts of a spec that may change while the object is rotated.
v1::SimulateSpec dip_of(const v1::SimulateSpec& spec) {
  v1::SimulateSpec out;
  if (spec.has_pose()) *out.mutable_pose() = spec.pose();
  if (spec.has_film() && !is_polygon(spec.film())) out.set_film(spec.film());
  if (spec.has_depth_mm()) out.set_depth_mm(spec.depth_mm());
  if (spec.has_dip_speed_mm_per_s()) out.set_dip_speed_mm_per_s(spec.dip_speed_mm_per_s());
  return out;
}

Result<NewJob> check(const v1::SimulateSpec& spec) {
  v1::Job job;
  *job.mutable_simulate() = spec;
  return check_job(job);
}

/// Returns a request for this object, without a dip.
Result<PreviewRequest> request_for(const v1::SimulateSpec& object) {
  HP_ASSIGN_OR_RETURN(const NewJob of_object, check(object));
  PreviewRequest ask;
  ask.key = deterministic_bytes(object);
  ask.spec = of_object.work.spec;
  ask.inputs = of_object.work.inputs;
  return ask;
}

/// Returns the members of a JSON object, without braces, with the proto field names.
Result<std::string> keys_of(const v1::SimulateSpec& dip) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(dip, &json, options).ok()) {
    return invalid_field("simulate", "cannot be written as JSON");
  }
  return json.substr(1, json.size() - 2);
}

}  // namespace

Result<PreviewRequest> check_read(const v1::ReadModelRequest& request) {
  const v1::InspectSpec& spec = request.inspect();
  v1::SimulateSpec object;
  if (spec.has_mesh()) *object.mutable_mesh() = spec.mesh();
  *object.mutable_extra_files() = spec.extra_files();
  if (spec.has_scale()) object.set_scale(spec.scale());
  HP_ASSIGN_OR_RETURN(PreviewRequest ask, request_for(object));
  ask.dip = spec.shape_only() ? R"("read":true,"shape_only":true)" : R"("read":true)";
  return ask;
}

Result<PreviewRequest> check_preview(const v1::ComputePreviewRequest& request) {
  const v1::SimulateSpec object = object_of(request.simulate()), dip = dip_of(request.simulate());
  v1::SimulateSpec both = object;
  both.MergeFrom(dip);
  HP_RETURN_IF_ERROR(check(both));
  HP_ASSIGN_OR_RETURN(PreviewRequest ask, request_for(object));
  HP_ASSIGN_OR_RETURN(ask.dip, keys_of(dip));
  return ask;
}

}  // namespace hydroprint::daemon
