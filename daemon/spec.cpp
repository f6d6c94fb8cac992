#include "daemon/spec.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "daemon/dip_spec.h"
#include "daemon/names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostExtraFiles = 256;
constexpr int kMostNames = 32;

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
    for (const InputFile& a : work_.inputs) {
      for (const InputFile& b : work_.inputs) {
        if (&a == &b || (a.name != b.name && !b.name.starts_with(a.name + "/"))) continue;
        auto error = fail(
            Code::kInvalidArgument,
            kind() + ": the name \"" + a.name + "\" stands for two files; give each file its own",
            "NAME_INVALID");
        return error;
      }
    }
    return {};
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
  return invalid_field("job",
                       "has no spec; set simulate, predict, fit, validate, print_image, template, "
                       "print or dip");
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
        job.print().print_image_job()}) {
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
