#include "daemon/spec.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "daemon/dip_spec.h"
#include "daemon/names.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostExtraFiles = 256;
constexpr int kMostNames = 32;
constexpr int kMostFrames = 5000;

// The shortest text that reads back as the same number.
std::string text_of(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

// Collects the flags and files of one work, and the first thing that is wrong with them.
class WorkBuilder {
 public:
  explicit WorkBuilder(std::string verb) { work_.verb = std::move(verb); }

  void require(const Status& status) {
    if (status_ && !status) status_ = status;
  }
  void flag(const std::string& name, const std::string& value) {
    work_.flags.push_back("--" + name + "=" + value);
  }
  // One that takes no value.
  void bare_flag(const std::string& name) { work_.flags.push_back("--" + name); }
  void pose(std::string json) { work_.pose_json = std::move(json); }
  // Above 0 where there is no least value.
  void number(const std::string& field, const std::string& name, double value, double most,
              double least = 0) {
    if (!std::isfinite(value) || value <= 0 || value < least || value > most) {
      const std::string from = least > 0 ? "must be at least " : "must be above ";
      require(invalid_field(path(field), from + text_of(least) + " and at most " + text_of(most)));
    }
    flag(name, text_of(value));
  }
  void whole(const std::string& field, const std::string& name, std::int32_t value,
             std::int32_t least, std::int32_t most) {
    check_whole(field, value, least, most);
    flag(name, std::to_string(value));
  }
  void check_whole(const std::string& field, std::int32_t value, std::int32_t least,
                   std::int32_t most) {
    if (value >= least && value <= most) return;
    require(invalid_field(path(field),
                          "must be from " + std::to_string(least) + " to " + std::to_string(most)));
  }
  // A file that goes with a flag (an empty one: with none, others refer to it).
  void file(const std::string& field, const std::string& name, const v1::InputFile& input) {
    require(check_file_name(path(field) + ".name", input.name()));
    const auto asset = parse_asset_name(input.asset());
    if (!asset) {
      Error error = asset.error();
      error.message = path(field) + ".asset: " + error.message;
      require(tl::unexpected(error));
      return;
    }
    work_.inputs.push_back({input.name(), *asset});
    if (!name.empty()) flag(name, input.name());
  }
  [[nodiscard]] std::string path(const std::string& field) const { return kind() + "." + field; }
  [[nodiscard]] const std::vector<InputFile>& inputs() const { return work_.inputs; }

  Result<Work> build() {
    require(check_names_differ());
    if (!status_) return tl::unexpected(status_.error());
    return std::move(work_);
  }

 private:
  // The verb as the API has it.
  [[nodiscard]] std::string kind() const {
    std::string out = work_.verb;
    std::replace(out.begin(), out.end(), '-', '_');
    return out;
  }
  // No name twice, and none that is another one's folder.
  [[nodiscard]] Status check_names_differ() const {
    std::set<std::string> names;
    for (const InputFile& file : work_.inputs) {
      if (!names.insert(file.name).second) return twice(file.name);
    }
    for (const std::string& name : names) {
      for (std::size_t end = name.find('/'); end != std::string::npos;
           end = name.find('/', end + 1)) {
        if (names.contains(name.substr(0, end))) return twice(name.substr(0, end));
      }
    }
    return {};
  }
  [[nodiscard]] Status twice(const std::string& name) const {
    return fail(Code::kInvalidArgument,
                kind() + ": the name \"" + name + "\" stands for two files; give each file its own",
                "NAME_INVALID");
  }

  Work work_;
  Status status_;
};

Status check_numbers(const std::string& field,
                     const google::protobuf::RepeatedField<double>& numbers, int count) {
  if (numbers.size() == count &&
      std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    return {};
  }
  return invalid_field(field, "must be " + std::to_string(count) + " finite numbers");
}

std::string list_of(const google::protobuf::RepeatedField<double>& numbers) {
  std::string out;
  for (const double number : numbers) out += (out.empty() ? "" : ",") + text_of(number);
  return "[" + out + "]";
}

void add_pose(WorkBuilder& builder, const v1::Pose& pose) {
  builder.require(check_numbers(builder.path("pose.rotation_wxyz"), pose.rotation_wxyz(), 4));
  builder.require(check_numbers(builder.path("pose.translation_mm"), pose.translation_mm(), 3));
  double square = 0;
  for (const double x : pose.rotation_wxyz()) square += x * x;
  if (!(std::abs(std::sqrt(square) - 1) <= 1e-3)) {
    builder.require(invalid_field(builder.path("pose.rotation_wxyz"), "must have length 1"));
  }
  builder.pose("{\"rotation_wxyz\":" + list_of(pose.rotation_wxyz()) +
               ",\"translation_mm\":" + list_of(pose.translation_mm()) + "}");
}

void add_film(WorkBuilder& builder, const std::string& film) {
  builder.require(check_text(builder.path("film"), film, 300));
  if (film.empty()) builder.require(invalid_field(builder.path("film"), "is empty; leave it out"));
  if (film.starts_with("polygon:")) {
    const auto& inputs = builder.inputs();
    if (std::none_of(inputs.begin(), inputs.end(),
                     [&](const InputFile& file) { return file.name == film.substr(8); })) {
      builder.require(
          invalid_field(builder.path("film"), "names a polygon that is not in extra_files"));
    }
  }
  builder.flag("film", film);
}

template <class Spec>
void add_choices(WorkBuilder& builder, const Spec& spec) {
  if (spec.model() != v1::MODEL_UNSPECIFIED) {
    if (!v1::Model_IsValid(spec.model())) {
      builder.require(invalid_field(builder.path("model"), "is not one of sheet, stokes"));
    }
    builder.flag("model", spec.model() == v1::MODEL_SHEET ? "sheet" : "stokes");
  }
  if (spec.inertia()) {
    if (spec.model() == v1::MODEL_STOKES) {
      builder.require(invalid_field(
          builder.path("inertia"), "Stokes flow has none; leave it out or let the model be sheet"));
    }
    builder.bare_flag("inertia");
  }
  if (spec.artifacts() != v1::ARTIFACT_SET_UNSPECIFIED) {
    if (!v1::ArtifactSet_IsValid(spec.artifacts())) {
      builder.require(invalid_field(builder.path("artifacts"), "is not one of all, map"));
    }
    builder.flag("artifacts", spec.artifacts() == v1::ARTIFACT_SET_MAP ? "map" : "all");
  }
}

void add_threads(WorkBuilder& builder, std::int32_t threads, NewJob& made) {
  builder.check_whole("threads", threads, 1, 256);
  made.threads = threads;
}

template <class Spec>
void add_extra_files(WorkBuilder& builder, const Spec& spec) {
  if (spec.extra_files_size() > kMostExtraFiles) {
    builder.require(invalid_field(builder.path("extra_files"), "has more than 256 files"));
    return;
  }
  for (const v1::InputFile& file : spec.extra_files()) builder.file("extra_files", "", file);
}

template <class Spec>
void add_film_image(WorkBuilder& builder, const Spec& spec) {
  if (!spec.has_film_image()) {
    builder.require(invalid_field(builder.path("film_image"), "is missing"));
    return;
  }
  builder.file("film_image", "film-image", spec.film_image());
}

// An object as it is held over its film.
template <class Spec>
void add_object(WorkBuilder& builder, const Spec& spec) {
  if (!spec.has_mesh()) builder.require(invalid_field(builder.path("mesh"), "is missing"));
  if (spec.has_mesh()) builder.file("mesh", "mesh", spec.mesh());
  add_extra_files(builder, spec);
  if (spec.has_scale()) builder.number("scale", "scale", spec.scale(), 1e9);
  if (spec.has_pose()) add_pose(builder, spec.pose());
  if (spec.has_film()) add_film(builder, spec.film());
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

void add_dpi(WorkBuilder& builder, double dpi) { builder.number("dpi", "dpi", dpi, 2400, 20); }

// What simulate and predict have in common.
template <class Spec>
void add_common(WorkBuilder& builder, const Spec& spec, NewJob& made) {
  add_dip(builder, spec, made);
  if (spec.has_dpi()) add_dpi(builder, spec.dpi());
  if (spec.has_ink_passes()) builder.whole("ink_passes", "ink-passes", spec.ink_passes(), 0, 10);
  add_choices(builder, spec);
}

// A flag with names made of letters and a joint ("-" or "_"), which the worker knows or refuses.
void add_names(WorkBuilder& builder, const std::string& field,
               const google::protobuf::RepeatedPtrField<std::string>& given, char joint) {
  if (given.size() > kMostNames) {
    builder.require(invalid_field(builder.path(field), "has more than 32 names"));
    return;
  }
  std::string names;
  for (const std::string& name : given) {
    const bool is_name = !name.empty() && name.size() <= 64 &&
                         std::all_of(name.begin(), name.end(), [joint](char c) {
                           return (c >= 'a' && c <= 'z') || c == joint;
                         });
    if (!is_name) {
      builder.require(invalid_field(builder.path(field),
                                    std::string("must be names made of a to z and ") + joint));
    }
    names += (names.empty() ? "" : ",") + name;
  }
  if (!names.empty()) builder.flag(field, names);
}

void add_fit(WorkBuilder& builder, const v1::FitSpec& spec, NewJob& made) {
  add_dip(builder, spec, made);
  if (!spec.has_points()) builder.require(invalid_field(builder.path("points"), "is missing"));
  if (spec.has_points()) builder.file("points", "points", spec.points());
  add_names(builder, "free", spec.free(), '_');
  if (spec.drop_outliers()) builder.bare_flag("drop-outliers");
}

void add_validation(WorkBuilder& builder, const v1::ValidateSpec& spec, NewJob& made) {
  add_names(builder, "only", spec.only(), '-');
  if (spec.quick()) builder.bare_flag("quick");
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
}

// A length that may be 0.
void add_length(WorkBuilder& builder, const std::string& field, const std::string& name,
                double length_mm, double most_mm) {
  if (!(length_mm >= 0 && length_mm <= most_mm)) {
    builder.require(invalid_field(builder.path(field), "must be from 0 to " + text_of(most_mm)));
  }
  builder.flag(name, text_of(length_mm));
}

void add_text(WorkBuilder& builder, const std::string& field, const std::string& name,
              const std::string& text) {
  builder.require(check_text(builder.path(field), text, 200));
  if (!text.empty()) builder.flag(name, text);
}

// The paper, and what stands on it.
template <class Spec>
void add_page(WorkBuilder& builder, const Spec& spec, NewJob& made) {
  if (spec.has_paper()) {
    builder.require(check_text(builder.path("paper"), spec.paper(), 300));
    builder.flag("paper", spec.paper());
  }
  if (spec.has_printer_margin_mm()) {
    add_length(builder, "printer_margin_mm", "printer-margin-mm", spec.printer_margin_mm(), 1000);
  }
  add_text(builder, "job_name", "job-name", spec.job_name());
  add_text(builder, "date", "date", spec.date());
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
}

void add_colours(WorkBuilder& builder, const v1::PrintImageSpec& spec) {
  if (spec.colours() != v1::COLOURS_UNSPECIFIED) {
    if (!v1::Colours_IsValid(spec.colours())) {
      builder.require(invalid_field(builder.path("colours"), "is not one of rgb, cmyk"));
    }
    builder.flag("colours", spec.colours() == v1::COLOURS_CMYK ? "cmyk" : "rgb");
  }
  if (spec.has_icc_profile()) builder.file("icc_profile", "icc-profile", spec.icc_profile());
  if (spec.has_ink_limit()) builder.number("ink_limit", "ink-limit", spec.ink_limit(), 4);
}

void add_print_image(WorkBuilder& builder, const v1::PrintImageSpec& spec, NewJob& made) {
  add_film_image(builder, spec);
  add_extra_files(builder, spec);
  if (spec.has_film()) add_film(builder, spec.film());
  if (spec.has_dpi()) add_dpi(builder, spec.dpi());
  add_page(builder, spec, made);
  if (spec.has_bar_mm()) add_length(builder, "bar_mm", "bar-mm", spec.bar_mm(), 2000);
  if (spec.has_overlap_mm()) {
    add_length(builder, "overlap_mm", "overlap-mm", spec.overlap_mm(), 100);
  }
  if (spec.mirror()) builder.bare_flag("mirror");
  if (spec.no_marks()) builder.bare_flag("no-marks");
  add_colours(builder, spec);
  add_names(builder, "formats", spec.formats(), '-');
}

// Frames as hydroprint-capture wrote them: for each view a folder with frames.json.
void add_frames(WorkBuilder& builder,
                const google::protobuf::RepeatedPtrField<v1::InputFile>& frames, int most_views) {
  constexpr std::string_view kListing = "/frames.json";
  if (frames.size() > kMostFrames) {
    builder.require(invalid_field(builder.path("frames"), "are more than 5000 files"));
    return;
  }
  int views = 0;
  for (const v1::InputFile& file : frames) {
    builder.file("frames", "", file);
    if (!file.name().ends_with(kListing)) continue;
    builder.flag("frames", file.name().substr(0, file.name().size() - kListing.size()));
    ++views;
  }
  if (views == 0 || views > most_views) {
    builder.require(invalid_field(builder.path("frames"),
                                  views == 0
                                      ? "have no FOLDER/frames.json; name captures, or upload "
                                        "what hydroprint-capture wrote"
                                      : "are of more views than " + std::to_string(most_views)));
  }
}

void add_calibrate(WorkBuilder& builder, const v1::CalibrateSpec& spec, NewJob& made) {
  add_object(builder, spec);
  add_frames(builder, spec.frames(), 1);
  if (spec.has_layout()) {
    builder.file("layout", "layout", spec.layout());
  } else {
    builder.require(invalid_field(builder.path("layout"), "is missing"));
  }
  if (spec.has_camera()) builder.file("camera", "camera", spec.camera());
  if (spec.has_gripper_mm()) {
    if (!(spec.gripper_mm() >= -1000 && spec.gripper_mm() <= 5000)) {
      builder.require(invalid_field(builder.path("gripper_mm"), "must be from -1000 to 5000"));
    }
    builder.flag("gripper-mm", text_of(spec.gripper_mm()));
  }
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
  made.use_cache = false;  // each leaves its calibration
}

void add_calibrate_camera(WorkBuilder& builder, const v1::CalibrateCameraSpec& spec, NewJob& made) {
  add_frames(builder, spec.frames(), 30);
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
  made.use_cache = false;
}

Status check_capture(const v1::CaptureSpec& spec) {
  if (!spec.has_seconds() || (spec.seconds() >= 0.1 && spec.seconds() <= 20)) return {};
  return invalid_field("capture.seconds", "must be from 0.1 to 20");
}

Result<Work> work_of(const v1::Job& job, NewJob& made) {
  if (job.has_simulate()) {
    WorkBuilder builder("simulate");
    const auto& spec = job.simulate();
    add_common(builder, spec, made);
    if (spec.has_texture()) builder.file("texture", "texture", spec.texture());
    return builder.build();
  }
  if (job.has_predict()) {
    WorkBuilder builder("predict");
    const auto& spec = job.predict();
    add_common(builder, spec, made);
    add_film_image(builder, spec);
    if (spec.has_motion()) builder.file("motion", "motion", spec.motion());
    return builder.build();
  }
  if (job.has_fit()) {
    WorkBuilder builder("fit");
    add_fit(builder, job.fit(), made);
    return builder.build();
  }
  if (job.has_validate()) {
    WorkBuilder builder("validate");
    add_validation(builder, job.validate(), made);
    return builder.build();
  }
  if (job.has_print_image()) {
    WorkBuilder builder("print-image");
    add_print_image(builder, job.print_image(), made);
    return builder.build();
  }
  if (job.has_template_()) {
    WorkBuilder builder("template");
    add_object(builder, job.template_());
    add_page(builder, job.template_(), made);
    return builder.build();
  }
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
  if (job.has_calibrate()) {
    WorkBuilder builder("calibrate");
    add_calibrate(builder, job.calibrate(), made);
    return builder.build();
  }
  if (job.has_calibrate_camera()) {
    WorkBuilder builder("calibrate-camera");
    add_calibrate_camera(builder, job.calibrate_camera(), made);
    return builder.build();
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

// The verb, and what it goes on from: an earlier job, or its first file.
std::string default_name(const v1::Job& job, const Work& work) {
  for (const std::string& earlier :
       {job.dip().simulate_job(), job.print_image().simulate_job(), job.template_().simulate_job(),
        job.print().print_image_job(), job.calibrate().capture_job()}) {
    if (!earlier.empty()) return work.verb + " " + earlier;
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

Result<v1::Calibration> check_calibration(const v1::Calibration& entered) {
  WorkBuilder builder("calibration");
  builder.require(check_text(builder.path("display_name"), entered.display_name(), 200));
  if (!entered.has_mesh()) builder.require(invalid_field(builder.path("mesh"), "is missing"));
  if (entered.has_mesh()) builder.file("mesh", "mesh", entered.mesh());
  if (!entered.has_pose()) builder.require(invalid_field(builder.path("pose"), "is missing"));
  if (entered.has_pose()) add_pose(builder, entered.pose());
  const double scale = entered.scale() == 0 ? 1 : entered.scale();
  builder.number("scale", "scale", scale, 1e9);
  if (entered.film().starts_with("polygon:")) {
    builder.require(
        invalid_field(builder.path("film"), "cannot be a polygon here; give its box as WxH"));
  } else if (!entered.film().empty()) {
    add_film(builder, entered.film());
  }
  const int spread = entered.covariance_size();
  if (spread != 0 || entered.centre_mm_size() != 0) {
    builder.require(check_numbers(builder.path("covariance"), entered.covariance(), 36));
    builder.require(check_numbers(builder.path("centre_mm"), entered.centre_mm(), 3));
  }
  HP_RETURN_IF_ERROR(builder.build());
  v1::Calibration out;
  out.set_display_name(entered.display_name().empty() ? "by hand: " + entered.mesh().name()
                                                      : entered.display_name());
  *out.mutable_mesh() = entered.mesh();
  *out.mutable_pose() = entered.pose();
  out.set_scale(scale);
  out.set_film(entered.film());
  *out.mutable_covariance() = entered.covariance();
  *out.mutable_centre_mm() = entered.centre_mm();
  return out;
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
