#include "daemon/spec.h"

#include <algorithm>

#include "daemon/dip_spec.h"
#include "daemon/names.h"
#include "daemon/spec_works.h"
#include "daemon/work_builder.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

Status check_capture(const v1::CaptureSpec& spec) {
  if (!spec.has_seconds() || (spec.seconds() >= 0.1 && spec.seconds() <= 20)) return {};
  return invalid_field("capture.seconds", "must be from 0.1 to 20");
}

Result<Work> work_of(const v1::Job& job, NewJob& made) {
  if (job.has_simulate()) return work_of(job.simulate(), made);
  if (job.has_predict()) return work_of(job.predict(), made);
  if (job.has_fit()) return work_of(job.fit(), made);
  if (job.has_validate()) return work_of(job.validate(), made);
  if (job.has_print_image()) return work_of(job.print_image(), made);
  if (job.has_template_()) return work_of(job.template_(), made);
  if (job.has_calibrate()) return work_of(job.calibrate(), made);
  if (job.has_calibrate_camera()) return work_of(job.calibrate_camera(), made);
  // These are the daemon's own.
  if (job.has_dip()) {
    HP_RETURN_IF_ERROR(check_dip_spec(job.dip()));
    return WorkBuilder("dip").build();
  }
  if (job.has_print()) {
    HP_RETURN_IF_ERROR(parse_job_name(job.print().print_image_job()));
    return WorkBuilder("print").build();
  }
  if (job.has_capture()) {
    HP_RETURN_IF_ERROR(check_capture(job.capture()));
    return WorkBuilder("capture").build();
  }
  return invalid_field("job",
                       "has no spec; set simulate, predict, fit, validate, print_image, template, "
                       "print, dip, capture, calibrate_camera or calibrate");
}

Status check_labels(const v1::Job& job) {
  if (job.labels_size() > 32) return invalid_field("labels", "are more than 32");
  for (const auto& [key, value] : job.labels()) {
    if (key.empty()) return invalid_field("labels", "have an empty key");
    HP_RETURN_IF_ERROR(check_text("labels", key, 200));
    HP_RETURN_IF_ERROR(check_text("labels", value, 200));
  }
  return {};
}

// The verb, and what it goes on from: an earlier job, views, or its first file.
std::string default_name(const v1::Job& job, const Work& work) {
  for (const std::string& earlier :
       {job.dip().simulate_job(), job.print_image().simulate_job(), job.template_().simulate_job(),
        job.print().print_image_job(), job.calibrate().capture_job()}) {
    if (!earlier.empty()) return work.verb + " " + earlier;
  }
  if (job.has_calibrate_camera()) {
    const auto views = std::count_if(work.flags.begin(), work.flags.end(), [](const auto& flag) {
      return flag.starts_with("--frames=");
    });
    return work.verb + " of " + std::to_string(views) + (views == 1 ? " view" : " views");
  }
  return work.inputs.empty() ? work.verb : work.verb + " " + work.inputs.front().name;
}

}  // namespace

std::string body_of(const v1::Job& job) {
  v1::Job body;
  body.set_display_name(job.display_name());
  *body.mutable_labels() = job.labels();
  if (job.has_simulate()) *body.mutable_simulate() = job.simulate();
  if (job.has_predict()) *body.mutable_predict() = job.predict();
  if (job.has_fit()) *body.mutable_fit() = job.fit();
  if (job.has_validate()) *body.mutable_validate() = job.validate();
  if (job.has_print_image()) *body.mutable_print_image() = job.print_image();
  if (job.has_template_()) *body.mutable_template_() = job.template_();
  if (job.has_print()) *body.mutable_print() = job.print();
  if (job.has_capture()) *body.mutable_capture() = job.capture();
  if (job.has_calibrate()) *body.mutable_calibrate() = job.calibrate();
  if (job.has_calibrate_camera()) *body.mutable_calibrate_camera() = job.calibrate_camera();
  if (job.has_dip()) *body.mutable_dip() = job.dip();
  return body.SerializeAsString();
}

Result<NewJob> check_job(const v1::Job& job) {
  NewJob made;
  HP_RETURN_IF_ERROR(check_text("display_name", job.display_name(), 200));
  HP_RETURN_IF_ERROR(check_labels(job));
  if (job.priority() < 0 || job.priority() > 9) {
    return invalid_field("priority", "must be from 0 to 9");
  }
  HP_ASSIGN_OR_RETURN(made.work, work_of(job, made));
  made.priority = job.priority();
  made.display_name = job.display_name();
  if (made.display_name.empty()) made.display_name = default_name(job, made.work);
  made.body = body_of(job);
  return made;
}

}  // namespace hydroprint::daemon
