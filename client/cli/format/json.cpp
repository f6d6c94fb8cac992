#include "client/cli/format/json.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <string>

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

Json value_of(const client::InputFile& file) {
  return {{"name", file.name}, {"asset", file.asset}};
}

Json value_of(const client::PoseSpec& pose) {
  return {{"rotation_wxyz", pose.rotation_wxyz}, {"translation_mm", pose.translation_mm}};
}

Json value_of(client::Time time) { return format_rfc3339(time); }

Json value_of(const auto& value) { return value; }

template <class T>
void put(Json& json, const char* key, const std::optional<T>& value) {
  if (value) json[key] = value_of(*value);
}

void put(Json& json, const char* key, const std::string& value) {
  if (!value.empty()) json[key] = value;
}

Json error_json(const client::JobError& error) {
  Json json{{"code", error.code}, {"reason", error.reason}, {"message", error.message}};
  put(json, "exit_status", error.exit_status);
  put(json, "signal", error.signal);
  return json;
}

Json motion_json(const client::Motion& motion) {
  Json json{{"number", motion.number},
            {"kind", motion.kind},
            {"outcome", client::name_of(motion.outcome)}};
  put(json, "cause", motion.cause);
  json["at_rest"] = motion.at_rest;
  json["begin_mm"] = motion.begin_mm;
  json["end_mm"] = motion.end_mm;
  return json;
}

Json axis_json(const client::Axis& axis) {
  return {{"drive", axis.drive},
          {"is_virtual", axis.is_virtual},
          {"min_mm", axis.min_mm},
          {"max_mm", axis.max_mm},
          {"max_speed_mm_per_s", axis.max_speed_mm_per_s},
          {"stopping_distance_mm", axis.stopping_distance_mm},
          {"watchdog_s", axis.watchdog_s}};
}

Json link_json(const client::LinkQuality& link) {
  return {{"missed_polls", link.missed_polls},
          {"connects", link.connects},
          {"polls", link.polls},
          {"skipped_polls", link.skipped_polls},
          {"largest_lateness_s", link.largest_lateness_s},
          {"rms_lateness_s", link.rms_lateness_s}};
}

void put(Json& json, const client::PageSpec& page) {
  put(json, "paper", page.paper);
  put(json, "printer_margin_mm", page.printer_margin_mm);
  put(json, "job_name", page.job_name);
  put(json, "date", page.date);
  put(json, "bar_mm", page.bar_mm);
  put(json, "overlap_mm", page.overlap_mm);
  if (page.mirror) json["mirror"] = true;
  if (page.no_marks) json["no_marks"] = true;
  put(json, "colours", page.colours);
  put(json, "icc_profile", page.icc_profile);
  put(json, "ink_limit", page.ink_limit);
  if (!page.formats.empty()) json["formats"] = page.formats;
}

void put(Json& json, const char* key, const std::vector<std::string>& values) {
  if (!values.empty()) json[key] = values;
}

void put(Json& json, const client::ScanSpec& scan, client::Verb verb) {
  if (verb == client::Verb::kCalibrateCamera) put(json, "capture_jobs", scan.capture_jobs);
  if (verb == client::Verb::kCalibrate && !scan.capture_jobs.empty())
    json["capture_job"] = scan.capture_jobs.front();
  for (const auto& file : scan.frames) json["frames"].push_back(value_of(file));
  put(json, "layout", scan.layout);
  put(json, "camera_calibration", scan.camera_calibration);
  put(json, "camera", scan.camera);
  put(json, "gripper_mm", scan.gripper_mm);
}

std::string text_of(const Json& value) {
  return printable(value.is_string() ? value.get<std::string>() : value.dump());
}

Json marker_json(const client::CalibrationMarker& marker) {
  Json json{{"name", marker.name}, {"used", marker.used}};
  put(json, "why_not", marker.why_not);
  if (!marker.used) return json;
  json["rms_mm"] = marker.rms_mm;
  json["residual_mm"] = marker.residual_mm;
  return json;
}

void put_found(Json& json, const client::Calibration& found) {
  put(json, "pose", found.pose);
  put(json, "error_p50_mm", found.error_p50_mm);
  put(json, "error_p95_mm", found.error_p95_mm);
  put(json, "error_max_mm", found.error_max_mm);
  put(json, "from_nominal_pose", found.from_nominal_pose);
  for (const auto& marker : found.markers) json["markers"].push_back(marker_json(marker));
  put(json, "water_z_mm", found.water_z_mm);
  put(json, "water_sigma_mm", found.water_sigma_mm);
  put(json, "height_mm", found.height_mm);
  put(json, "axis_mm", found.axis_mm);
  put(json, "contact_mm", found.contact_mm);
  if (!found.covariance.empty()) json["covariance"] = found.covariance;
  if (!found.centre_mm.empty()) json["centre_mm"] = found.centre_mm;
}

// The job kind as in the API's Job.
std::string kind_of(client::Verb verb) {
  std::string out(client::name_of(verb));
  std::replace(out.begin(), out.end(), '-', '_');
  return out;
}

}  // namespace

Json spec_json(const client::Spec& spec) {
  Json json = Json::object();
  put(json, "simulate_job", spec.simulate_job);
  if (!spec.mesh.name.empty()) json["mesh"] = value_of(spec.mesh);
  put(json, "texture", spec.texture);
  put(json, "film_image", spec.film_image);
  put(json, "motion", spec.motion);
  put(json, "points", spec.points);
  for (const auto& file : spec.extra_files) json["extra_files"].push_back(value_of(file));
  put(json, "profile", spec.profile);
  put(json, "scale", spec.scale);
  put(json, "pose", spec.pose);
  put(json, "film", spec.film);
  put(json, "dpi", spec.dpi);
  put(json, "model", spec.model);
  if (spec.inertia) json["inertia"] = true;
  put(json, "ink_passes", spec.ink_passes);
  put(json, "ink_image", spec.ink_image);
  put(json, "depth_mm", spec.depth_mm);
  put(json, "dip_speed_mm_per_s", spec.dip_speed_mm_per_s);
  put(json, "threads", spec.threads);
  put(json, "artifacts", spec.artifacts);
  if (!spec.only.empty()) json["only"] = spec.only;
  if (spec.quick) json["quick"] = true;
  if (!spec.free.empty()) json["free"] = spec.free;
  if (spec.drop_outliers) json["drop_outliers"] = true;
  put(json, spec.page);
  put(json, spec.scan, spec.verb);
  put(json, "calibration", spec.calibration);
  if (spec.allow_stale_calibration) json["allow_stale_calibration"] = true;
  return json;
}

Json to_json(const client::Job& job) {
  Json json;
  put(json, "name", job.name);
  put(json, "uid", job.uid);
  json["display_name"] = job.display_name;
  json["owner"] = job.owner;
  json["priority"] = job.priority;
  if (!job.labels.empty()) json["labels"] = job.labels;
  json["state"] = client::name_of(job.state);
  json["progress_fraction"] = job.progress_fraction;
  put(json, "phase", job.phase);
  put(json, "eta_time", job.eta_time);
  put(json, "create_time", job.create_time);
  put(json, "start_time", job.start_time);
  put(json, "end_time", job.end_time);
  if (job.error) json["error"] = error_json(*job.error);
  put(json, "retry_of", job.retry_of);
  put(json, "input_digest", job.input_digest);
  json["cache_hit"] = job.cache_hit;
  json["shared"] = job.shared;
  json["pinned"] = job.pinned;
  put(json, "purge_time", job.purge_time);
  if (job.spec) json[kind_of(job.spec->verb)] = spec_json(*job.spec);
  if (job.print_image_job) json["print"] = {{"print_image_job", *job.print_image_job}};
  if (job.capture_s) json["capture"] = {{"seconds", *job.capture_s}};
  if (job.dip) json["dip"] = to_json(*job.dip);
  if (job.dip_status) json["dip_status"] = to_json(*job.dip_status);
  return json;
}

Json to_json(const client::JobEvent& event) {
  Json json{{"seq", event.seq}, {"job", event.job}, {"kind", event.kind}};
  put(json, "time", event.time);
  json["state"] = client::name_of(event.state);
  json["progress_fraction"] = event.progress_fraction;
  put(json, "phase", event.phase);
  json["phase_fraction"] = event.phase_fraction;
  put(json, "eta_time", event.eta_time);
  put(json, "message", event.message);
  return json;
}

Json to_json(const client::DipSpec& spec) {
  Json json = Json::object();
  put(json, "simulate_job", spec.simulate_job);
  put(json, "depth_mm", spec.depth_mm);
  put(json, "speed_mm_per_s", spec.speed_mm_per_s);
  put(json, "hold_s", spec.hold_s);
  put(json, "retract_speed_mm_per_s", spec.retract_speed_mm_per_s);
  put(json, "clearance_mm", spec.clearance_mm);
  put(json, "film_area_mm2", spec.film_area_mm2);
  put(json, "activator_ml_per_m2", spec.activator_ml_per_m2);
  put(json, "soak_s", spec.soak_s);
  put(json, "activator_wait_s", spec.activator_wait_s);
  put(json, "activation_window_s", spec.activation_window_s);
  put(json, "water_temperature_c", spec.water_temperature_c);
  put(json, "calibration", spec.calibration);
  if (spec.allow_stale_calibration) json["allow_stale_calibration"] = true;
  if (spec.yes_to_all) json["yes_to_all"] = true;
  return json;
}

Json to_json(const client::DipStatus& status) {
  Json json{{"step", client::name_of(status.step)}};
  put(json, "instruction", status.instruction);
  put(json, "step_end_time", status.step_end_time);
  put(json, "activation_end_time", status.activation_end_time);
  put(json, "contact_mm", status.contact_mm);
  if (!status.warnings.empty()) json["warnings"] = status.warnings;
  return json;
}

Json to_json(const client::Lease& lease) {
  Json json = Json::object();
  put(json, "lease_id", lease.lease_id);
  put(json, "holder", lease.holder);
  put(json, "purpose", lease.purpose);
  put(json, "acquire_time", lease.acquire_time);
  put(json, "expire_time", lease.expire_time);
  return json;
}

Json to_json(const client::Rig& rig) {
  Json json{{"state", client::name_of(rig.state)}};
  put(json, "cause", rig.cause);
  put(json, "trouble", rig.trouble);
  json["homed"] = rig.homed;
  json["stop_button"] = rig.stop_button;
  json["enabled"] = rig.enabled;
  put(json, "position_mm", rig.position_mm);
  put(json, "velocity_mm_per_s", rig.velocity_mm_per_s);
  if (rig.alarm_code != 0) json["alarm_code"] = rig.alarm_code;
  put(json, "alarm_text", rig.alarm_text);
  put(json, "sample_time", rig.sample_time);
  if (rig.motion) json["motion"] = motion_json(*rig.motion);
  if (rig.axis) json["axis"] = axis_json(*rig.axis);
  json["link_quality"] = link_json(rig.link_quality);
  if (rig.lease) json["lease"] = to_json(*rig.lease);
  put(json, "dip", rig.dip);
  return json;
}

Json to_json(const client::Queue& queue) {
  return {{"paused", queue.paused},
          {"pause_reason", queue.pause_reason},
          {"queued_jobs", queue.queued_jobs},
          {"queued_count", queue.queued_count},
          {"running_jobs", queue.running_jobs},
          {"worker_slots", queue.worker_slots},
          {"daemon_version", queue.daemon_version}};
}

Json to_json(const client::Asset& asset) {
  Json json{{"name", asset.name}, {"sha256", asset.sha256}, {"size_bytes", asset.size_bytes}};
  put(json, "media_type", asset.media_type);
  put(json, "create_time", asset.create_time);
  json["owners"] = asset.owners;
  return json;
}

Json to_json(const client::Artifact& artifact) {
  return {{"name", artifact.name},
          {"size_bytes", artifact.size_bytes},
          {"sha256", artifact.sha256},
          {"media_type", artifact.media_type}};
}

Json to_json(const client::Calibration& calibration) {
  Json json{{"name", calibration.name}, {"kind", calibration.kind}};
  json["display_name"] = calibration.display_name;
  json["owner"] = calibration.owner;
  put(json, "create_time", calibration.create_time);
  put(json, "capture_time", calibration.capture_time);
  json["active"] = calibration.active;
  put(json, "stale", calibration.stale);
  put(json, "job", calibration.job);
  put(json, "picture", calibration.picture);
  if (calibration.kind == "CAMERA") {
    json["views"] = calibration.views;
    json["rms_mm"] = calibration.rms_mm;
    return json;
  }
  json["mesh"] = value_of(calibration.mesh);
  json["scale"] = calibration.scale;
  put(json, "film", calibration.film);
  put_found(json, calibration);
  return json;
}

Json to_json(const Error& error) {
  Json json{{"code", code_name(error.code)}};
  put(json, "reason", error.reason);
  json["message"] = error.message;
  if (!error.metadata.empty()) json["metadata"] = error.metadata;
  return json;
}

void print_tree(const Json& json, const std::string& indent) {
  for (const auto& [key, value] : json.items()) {
    std::cout << indent << std::left << std::setw(20) << key;
    if (value.is_object()) {
      std::cout << "\n";
      print_tree(value, indent + "  ");
    } else if (value.is_array() && !value.empty() && !value.front().is_number()) {
      for (const Json& line : value)  // one below the other
        std::cout << (&line == &value.front() ? "" : indent + std::string(20, ' ')) << text_of(line)
                  << "\n";
    } else {
      std::cout << text_of(value) << "\n";
    }
  }
}

void print(const Json& json) {
  // File names need not be UTF-8.
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

}  // namespace hydroprint::cli
