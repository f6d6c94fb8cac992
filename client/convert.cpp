#include "client/convert.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace hydroprint::client {
namespace {

namespace v1 = ::hydroprint::v1;

JobState from_proto(v1::Job::State state) {
  switch (state) {
    case v1::Job::QUEUED:
      return JobState::kQueued;
    case v1::Job::WAITING_FOR_OPERATOR:
      return JobState::kWaitingForOperator;
    case v1::Job::RUNNING:
      return JobState::kRunning;
    case v1::Job::CANCELLING:
      return JobState::kCancelling;
    case v1::Job::SUCCEEDED:
      return JobState::kSucceeded;
    case v1::Job::FAILED:
      return JobState::kFailed;
    case v1::Job::CANCELLED:
      return JobState::kCancelled;
    case v1::Job::INTERRUPTED:
      return JobState::kInterrupted;
    default:
      return JobState::kUnknown;
  }
}

InputFile from_proto(const v1::InputFile& file) { return {file.name(), file.asset()}; }

std::optional<InputFile> from_proto(bool is_set, const v1::InputFile& file) {
  if (!is_set) return std::nullopt;
  return from_proto(file);
}

void to_proto(const InputFile& file, v1::InputFile* message) {
  message->set_name(file.name);
  message->set_asset(file.asset);
}

std::optional<std::string> from_proto(v1::Model model) {
  if (model == v1::MODEL_SHEET) return "sheet";
  if (model == v1::MODEL_STOKES) return "stokes";
  return std::nullopt;
}

std::optional<std::string> from_proto(v1::ArtifactSet artifacts) {
  if (artifacts == v1::ARTIFACT_SET_ALL) return "all";
  if (artifacts == v1::ARTIFACT_SET_MAP) return "map";
  return std::nullopt;
}

std::optional<std::string> from_proto(v1::Colours colours) {
  if (colours == v1::COLOURS_RGB) return "rgb";
  if (colours == v1::COLOURS_CMYK) return "cmyk";
  return std::nullopt;
}

// Fields shared by all specs except ValidateSpec.
template <class Message>
Spec film_from_proto(const Message& message) {
  Spec spec;
  for (const auto& file : message.extra_files()) spec.extra_files.push_back(from_proto(file));
  spec.film = given(message.has_film(), message.film());
  spec.threads = given(message.has_threads(), static_cast<int>(message.threads()));
  return spec;
}

// Fields of the specs that describe an object.
template <class Message>
Spec object_from_proto(const Message& message) {
  Spec spec = film_from_proto(message);
  spec.mesh = from_proto(message.mesh());
  spec.scale = given(message.has_scale(), message.scale());
  if (message.has_pose()) spec.pose = pose_from_proto(message.pose());
  return spec;
}

// Fields shared by SimulateSpec, PredictSpec and FitSpec.
template <class Message>
Spec dip_from_proto(const Message& message) {
  Spec spec = object_from_proto(message);
  spec.profile = from_proto(message.has_profile(), message.profile());
  spec.ink_image = from_proto(message.has_ink_image(), message.ink_image());
  spec.depth_mm = given(message.has_depth_mm(), message.depth_mm());
  spec.dip_speed_mm_per_s = given(message.has_dip_speed_mm_per_s(), message.dip_speed_mm_per_s());
  return spec;
}

// Fields shared by SimulateSpec and PredictSpec.
template <class Message>
Spec common_from_proto(const Message& message) {
  Spec spec = dip_from_proto(message);
  spec.dpi = given(message.has_dpi(), message.dpi());
  spec.model = from_proto(message.model());
  spec.inertia = message.inertia();
  spec.ink_passes = given(message.has_ink_passes(), static_cast<int>(message.ink_passes()));
  spec.artifacts = from_proto(message.artifacts());
  return spec;
}

// Fields shared by PrintImageSpec and TemplateSpec.
template <class Message>
PageSpec page_from_proto(const Message& message) {
  PageSpec page;
  page.paper = given(message.has_paper(), message.paper());
  page.printer_margin_mm = given(message.has_printer_margin_mm(), message.printer_margin_mm());
  page.job_name = message.job_name();
  page.date = message.date();
  return page;
}

Spec print_image_from_proto(const v1::PrintImageSpec& message) {
  Spec spec = film_from_proto(message);
  spec.verb = Verb::kPrintImage;
  spec.simulate_job = message.simulate_job();
  spec.film_image = from_proto(message.has_film_image(), message.film_image());
  spec.dpi = given(message.has_dpi(), message.dpi());
  spec.page = page_from_proto(message);
  spec.page.bar_mm = given(message.has_bar_mm(), message.bar_mm());
  spec.page.overlap_mm = given(message.has_overlap_mm(), message.overlap_mm());
  spec.page.mirror = message.mirror();
  spec.page.no_marks = message.no_marks();
  spec.page.colours = from_proto(message.colours());
  spec.page.icc_profile = from_proto(message.has_icc_profile(), message.icc_profile());
  spec.page.ink_limit = given(message.has_ink_limit(), message.ink_limit());
  spec.page.formats.assign(message.formats().begin(), message.formats().end());
  return spec;
}

Spec calibrate_from_proto(const v1::CalibrateSpec& message) {
  Spec spec = object_from_proto(message);
  spec.verb = Verb::kCalibrate;
  if (!message.capture_job().empty()) spec.scan.capture_jobs = {message.capture_job()};
  for (const auto& file : message.frames()) spec.scan.frames.push_back(from_proto(file));
  spec.scan.layout = from_proto(message.has_layout(), message.layout());
  spec.scan.camera_calibration = message.camera_calibration();
  spec.scan.camera = from_proto(message.has_camera(), message.camera());
  spec.scan.gripper_mm = given(message.has_gripper_mm(), message.gripper_mm());
  return spec;
}

std::optional<Spec> spec_from_proto(const v1::Job& job) {
  if (job.has_simulate()) {
    Spec spec = common_from_proto(job.simulate());
    spec.texture = from_proto(job.simulate().has_texture(), job.simulate().texture());
    spec.calibration = job.simulate().calibration();
    spec.allow_stale_calibration = job.simulate().allow_stale_calibration();
    return spec;
  }
  if (job.has_predict()) {
    Spec spec = common_from_proto(job.predict());
    spec.verb = Verb::kPredict;
    spec.film_image = from_proto(job.predict().has_film_image(), job.predict().film_image());
    spec.motion = from_proto(job.predict().has_motion(), job.predict().motion());
    return spec;
  }
  if (job.has_fit()) {
    const v1::FitSpec& message = job.fit();
    Spec spec = dip_from_proto(message);
    spec.verb = Verb::kFit;
    spec.points = from_proto(message.has_points(), message.points());
    spec.free.assign(message.free().begin(), message.free().end());
    spec.drop_outliers = message.drop_outliers();
    return spec;
  }
  if (job.has_validate()) {
    const v1::ValidateSpec& message = job.validate();
    Spec spec;
    spec.verb = Verb::kValidate;
    spec.only.assign(message.only().begin(), message.only().end());
    spec.quick = message.quick();
    spec.threads = given(message.has_threads(), static_cast<int>(message.threads()));
    return spec;
  }
  if (job.has_calibrate()) return calibrate_from_proto(job.calibrate());
  if (job.has_calibrate_camera()) {
    const v1::CalibrateCameraSpec& message = job.calibrate_camera();
    Spec spec;
    spec.verb = Verb::kCalibrateCamera;
    spec.scan.capture_jobs.assign(message.capture_jobs().begin(), message.capture_jobs().end());
    for (const auto& file : message.frames()) spec.scan.frames.push_back(from_proto(file));
    spec.threads = given(message.has_threads(), static_cast<int>(message.threads()));
    return spec;
  }
  if (job.has_print_image()) return print_image_from_proto(job.print_image());
  if (job.has_template_()) {
    Spec spec = object_from_proto(job.template_());
    spec.verb = Verb::kTemplate;
    spec.simulate_job = job.template_().simulate_job();
    spec.page = page_from_proto(job.template_());
    return spec;
  }
  return std::nullopt;
}

// Names of google.rpc.Code, indexed by number.
constexpr std::array<std::string_view, 17> kCodeNames{
    "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
    "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
    "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
    "DATA_LOSS", "UNAUTHENTICATED"};

JobError from_proto(const v1::JobError& error) {
  JobError result;
  result.code = kCodeNames.at(error.code() < 0 || error.code() > 16 ? 2 : error.code());
  result.reason = error.reason();
  result.message = error.message();
  if (error.has_exit_status()) result.exit_status = error.exit_status();
  if (error.has_signal()) result.signal = error.signal();
  return result;
}

template <class Message>
Status names_to_proto(const Spec& spec, Message& message) {
  if (spec.model == "sheet") message.set_model(v1::MODEL_SHEET);
  if (spec.model == "stokes") message.set_model(v1::MODEL_STOKES);
  if (spec.model && message.model() == v1::MODEL_UNSPECIFIED)
    return fail(Code::kInvalidArgument,
                "model '" + *spec.model + "' is unknown; use sheet or stokes");
  if (spec.artifacts == "all") message.set_artifacts(v1::ARTIFACT_SET_ALL);
  if (spec.artifacts == "map") message.set_artifacts(v1::ARTIFACT_SET_MAP);
  if (spec.artifacts && message.artifacts() == v1::ARTIFACT_SET_UNSPECIFIED)
    return fail(Code::kInvalidArgument,
                "artifacts '" + *spec.artifacts + "' is unknown; use all or map");
  return {};
}

template <class Message>
void film_to_proto(const Spec& spec, Message& message) {
  for (const InputFile& file : spec.extra_files) to_proto(file, message.add_extra_files());
  if (spec.film) message.set_film(*spec.film);
  if (spec.threads) message.set_threads(*spec.threads);
}

template <class Message>
void object_to_proto(const Spec& spec, Message& message) {
  film_to_proto(spec, message);
  if (!spec.mesh.name.empty()) to_proto(spec.mesh, message.mutable_mesh());
  if (spec.scale) message.set_scale(*spec.scale);
  if (spec.pose) *message.mutable_pose() = pose_to_proto(*spec.pose);
}

template <class Message>
void dip_to_proto(const Spec& spec, Message& message) {
  object_to_proto(spec, message);
  if (spec.profile) to_proto(*spec.profile, message.mutable_profile());
  if (spec.ink_image) to_proto(*spec.ink_image, message.mutable_ink_image());
  if (spec.depth_mm) message.set_depth_mm(*spec.depth_mm);
  if (spec.dip_speed_mm_per_s) message.set_dip_speed_mm_per_s(*spec.dip_speed_mm_per_s);
}

template <class Message>
Status common_to_proto(const Spec& spec, Message& message) {
  dip_to_proto(spec, message);
  if (spec.dpi) message.set_dpi(*spec.dpi);
  message.set_inertia(spec.inertia);
  if (spec.ink_passes) message.set_ink_passes(*spec.ink_passes);
  return names_to_proto(spec, message);
}

template <class Message>
void page_to_proto(const PageSpec& page, Message& message) {
  if (page.paper) message.set_paper(*page.paper);
  if (page.printer_margin_mm) message.set_printer_margin_mm(*page.printer_margin_mm);
  message.set_job_name(page.job_name);
  message.set_date(page.date);
}

void calibrate_to_proto(const Spec& spec, v1::CalibrateSpec& message) {
  const ScanSpec& scan = spec.scan;
  object_to_proto(spec, message);
  if (!scan.capture_jobs.empty()) message.set_capture_job(scan.capture_jobs.front());
  for (const InputFile& file : scan.frames) to_proto(file, message.add_frames());
  if (scan.layout) to_proto(*scan.layout, message.mutable_layout());
  message.set_camera_calibration(scan.camera_calibration);
  if (scan.camera) to_proto(*scan.camera, message.mutable_camera());
  if (scan.gripper_mm) message.set_gripper_mm(*scan.gripper_mm);
}

void calibrate_camera_to_proto(const Spec& spec, v1::CalibrateCameraSpec& message) {
  for (const std::string& job : spec.scan.capture_jobs) message.add_capture_jobs(job);
  for (const InputFile& file : spec.scan.frames) to_proto(file, message.add_frames());
  if (spec.threads) message.set_threads(*spec.threads);
}

Status print_image_to_proto(const Spec& spec, v1::PrintImageSpec& message) {
  const PageSpec& page = spec.page;
  message.set_simulate_job(spec.simulate_job);
  film_to_proto(spec, message);
  if (spec.film_image) to_proto(*spec.film_image, message.mutable_film_image());
  if (spec.dpi) message.set_dpi(*spec.dpi);
  page_to_proto(page, message);
  if (page.bar_mm) message.set_bar_mm(*page.bar_mm);
  if (page.overlap_mm) message.set_overlap_mm(*page.overlap_mm);
  message.set_mirror(page.mirror);
  message.set_no_marks(page.no_marks);
  if (page.colours == "rgb") message.set_colours(v1::COLOURS_RGB);
  if (page.colours == "cmyk") message.set_colours(v1::COLOURS_CMYK);
  if (page.colours && message.colours() == v1::COLOURS_UNSPECIFIED)
    return fail(Code::kInvalidArgument,
                "colours '" + *page.colours + "' is unknown; use rgb or cmyk");
  if (page.icc_profile) to_proto(*page.icc_profile, message.mutable_icc_profile());
  if (page.ink_limit) message.set_ink_limit(*page.ink_limit);
  for (const std::string& name : page.formats) message.add_formats(name);
  return {};
}

}  // namespace

std::optional<Time> from_proto(bool is_set, const google::protobuf::Timestamp& time) {
  if (!is_set) return std::nullopt;
  return Time(std::chrono::duration_cast<Time::duration>(
      std::chrono::nanoseconds(google::protobuf::util::TimeUtil::TimestampToNanoseconds(time))));
}

std::optional<PoseSpec> pose_from_proto(const v1::Pose& pose) {
  PoseSpec result;
  if (pose.rotation_wxyz_size() != 4 || pose.translation_mm_size() != 3) return std::nullopt;
  std::copy(pose.rotation_wxyz().begin(), pose.rotation_wxyz().end(), result.rotation_wxyz.begin());
  std::copy(pose.translation_mm().begin(), pose.translation_mm().end(),
            result.translation_mm.begin());
  return result;
}

v1::Pose pose_to_proto(const PoseSpec& pose) {
  v1::Pose message;
  for (const double x : pose.rotation_wxyz) message.add_rotation_wxyz(x);
  for (const double x : pose.translation_mm) message.add_translation_mm(x);
  return message;
}

Job from_proto(const v1::Job& message) {
  Job job;
  job.name = message.name();
  job.uid = message.uid();
  job.display_name = message.display_name();
  job.owner = message.owner();
  job.priority = message.priority();
  job.labels.insert(message.labels().begin(), message.labels().end());
  job.state = from_proto(message.state());
  job.progress_fraction = message.progress_fraction();
  job.phase = message.phase();
  job.eta_time = from_proto(message.has_eta_time(), message.eta_time());
  job.create_time = from_proto(message.has_create_time(), message.create_time());
  job.start_time = from_proto(message.has_start_time(), message.start_time());
  job.end_time = from_proto(message.has_end_time(), message.end_time());
  if (message.has_error()) job.error = from_proto(message.error());
  job.retry_of = message.retry_of();
  job.input_digest = message.input_digest();
  job.cache_hit = message.cache_hit();
  job.shared = message.shared();
  job.pinned = message.pinned();
  job.purge_time = from_proto(message.has_purge_time(), message.purge_time());
  job.spec = spec_from_proto(message);
  if (message.has_dip()) job.dip = from_proto(message.dip());
  if (message.has_print()) job.print_image_job = message.print().print_image_job();
  if (message.has_capture()) job.capture_s = message.capture().seconds();
  if (message.has_dip_status()) job.dip_status = from_proto(message.dip_status());
  return job;
}

JobEvent from_proto(const v1::JobEvent& message) {
  JobEvent event;
  event.seq = message.seq();
  event.time = from_proto(message.has_time(), message.time());
  event.job = message.job();
  event.kind = v1::JobEvent::Kind_Name(message.kind());
  event.state = from_proto(message.state());
  event.progress_fraction = message.progress_fraction();
  event.phase = message.phase();
  event.phase_fraction = message.phase_fraction();
  event.eta_time = from_proto(message.has_eta_time(), message.eta_time());
  event.message = message.message();
  return event;
}

Queue from_proto(const v1::Queue& message) {
  Queue queue;
  queue.paused = message.paused();
  queue.pause_reason = message.pause_reason();
  queue.queued_jobs.assign(message.queued_jobs().begin(), message.queued_jobs().end());
  queue.queued_count = message.queued_count();
  queue.running_jobs.assign(message.running_jobs().begin(), message.running_jobs().end());
  queue.worker_slots = message.worker_slots();
  queue.daemon_version = message.daemon_version();
  return queue;
}

Asset from_proto(const v1::Asset& message) {
  return {message.name(),
          message.sha256(),
          message.size_bytes(),
          message.media_type(),
          from_proto(message.has_create_time(), message.create_time()),
          {message.owners().begin(), message.owners().end()}};
}

Artifact from_proto(const v1::Artifact& message) {
  return {message.name(), message.size_bytes(), message.sha256(), message.media_type()};
}

Status to_proto(const Spec& spec, v1::Job& job) {
  if (spec.verb == Verb::kSimulate) {
    auto& message = *job.mutable_simulate();
    if (spec.texture) to_proto(*spec.texture, message.mutable_texture());
    message.set_calibration(spec.calibration);
    message.set_allow_stale_calibration(spec.allow_stale_calibration);
    return common_to_proto(spec, message);
  }
  if (spec.verb == Verb::kFit) {
    auto& message = *job.mutable_fit();
    dip_to_proto(spec, message);
    if (spec.points) to_proto(*spec.points, message.mutable_points());
    for (const std::string& name : spec.free) message.add_free(name);
    message.set_drop_outliers(spec.drop_outliers);
    return {};
  }
  if (spec.verb == Verb::kValidate) {
    auto& message = *job.mutable_validate();
    for (const std::string& name : spec.only) message.add_only(name);
    message.set_quick(spec.quick);
    if (spec.threads) message.set_threads(*spec.threads);
    return {};
  }
  if (spec.verb == Verb::kCalibrate) {
    calibrate_to_proto(spec, *job.mutable_calibrate());
    return {};
  }
  if (spec.verb == Verb::kCalibrateCamera) {
    calibrate_camera_to_proto(spec, *job.mutable_calibrate_camera());
    return {};
  }
  if (spec.verb == Verb::kPrintImage) return print_image_to_proto(spec, *job.mutable_print_image());
  if (spec.verb == Verb::kTemplate) {
    auto& message = *job.mutable_template_();
    message.set_simulate_job(spec.simulate_job);
    object_to_proto(spec, message);
    page_to_proto(spec.page, message);
    return {};
  }
  auto& message = *job.mutable_predict();
  if (spec.film_image) to_proto(*spec.film_image, message.mutable_film_image());
  if (spec.motion) to_proto(*spec.motion, message.mutable_motion());
  return common_to_proto(spec, message);
}

v1::Job::State to_proto(JobState state) {
  v1::Job::State result = v1::Job::STATE_UNSPECIFIED;
  v1::Job::State_Parse(std::string(name_of(state)), &result);
  return result;
}

}  // namespace hydroprint::client
