#include "client/cli/job_io/submit_flags.h"

#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/pose_file.h"

namespace hydroprint::cli {
namespace {

// Adds a flag for a field of the spec.
CLI::Option* add(CLI::App& command, const char* flag, SubmitOptions& options, const char* field,
                 const std::string& help) {
  return add_field(command, flag, spec_of(options.job), field, help);
}

// Adds a flag for a file, which is uploaded after the parsing.
CLI::Option* add_file(CLI::App& command, const char* flag, SubmitOptions& options,
                      const char* field, const char* help) {
  const auto take = [&options, field](const std::string& path) {
    options.files.emplace_back(field, path);
  };
  return command.add_option_function<std::string>(flag, take, help)->type_name("FILE");
}

// Adds a flag for the name of a job or calibration, completed by `name`.
CLI::Option* add_name(CLI::App& command, const char* flag, SubmitOptions& options,
                      const char* field, std::string (*name)(const std::string&),
                      const char* help) {
  const auto take = [&options, field, name](const std::string& text) {
    set_text(spec_of(options.job), field, name(text));
  };
  return command.add_option_function<std::string>(flag, take, help);
}

void add_threads_flag(CLI::App& command, SubmitOptions& options) {
  add(command, "--threads", options, "threads",
      field_help("SimulateSpec.threads", "Threads of the computation"))
      ->type_name("N");
}

void add_validation_flags(CLI::App& command, SubmitOptions& options) {
  add(command, "--only", options, "only",
      field_help("ValidateSpec.only", "Experiments to run; default: all"))
      ->type_name("NAME[,NAME]");
  add(command, "--quick", options, "quick", "Run coarsely, to check that everything works");
  add_threads_flag(command, options);
}

void add_film_flag(CLI::App& command, SubmitOptions& options) {
  command
      .add_option("--film", options.film,
                  field_help("SimulateSpec.film",
                             "A4, A3, letter, WxH, circle:RADIUS or polygon:FILE.json, in mm"))
      ->type_name("FILM");
}

void add_dpi_flag(CLI::App& command, SubmitOptions& options) {
  add(command, "--dpi", options, "dpi",
      field_help(options.job.has_print_image() ? "PrintImageSpec.dpi" : "SimulateSpec.dpi",
                 "Resolution of the film image"))
      ->type_name("DPI");
}

// Flags for an object and its place over the film.
void add_object_flags(CLI::App& command, SubmitOptions& options) {
  command.add_option("--mesh", options.mesh, "The object: OBJ, STL, PLY, glTF or GLB")
      ->type_name("FILE");
  add(command, "--scale", options, "scale",
      field_help("SimulateSpec.scale", "Size of a model unit"))
      ->type_name("FACTOR");
  command
      .add_option(
          "--pose", options.pose,
          R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: centred on the film)")
      ->type_name("FILE");
  add_film_flag(command, options);
}

// Flags for the dip: profile, depth and speed.
void add_dip_flags(CLI::App& command, SubmitOptions& options) {
  add_object_flags(command, options);
  command.get_option("--mesh")->required();
  add_file(command, "--profile", options, "profile", "Film profile, TOML");
  command
      .add_option("--depth-mm", options.depth,
                  field_help("SimulateSpec.depth_mm", "Depth at the end of the dip"))
      ->type_name("D");
  add(command, "--dip-speed-mm-per-s", options, "dip_speed_mm_per_s",
      field_help("SimulateSpec.dip_speed_mm_per_s", "Speed of the dip"))
      ->type_name("V");
}

void add_fit_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
  add_threads_flag(command, options);
  add_file(command, "--points", options, "points", "Measured landing points, CSV")->required();
  add_file(command, "--ink-image", options, "ink_image",
           "Image printed on the film; needed to fit the ink ratio");
  add(command, "--free", options, "free",
      field_help("FitSpec.free", "Parameters to fit; default: all that the points determine"))
      ->type_name("NAME[,NAME]");
  add(command, "--drop-outliers", options, "drop_outliers", "Exclude outliers");
}

// Flags for the sources of colour of simulate, which may use a calibration.
void add_simulate_flags(CLI::App& command, SubmitOptions& options) {
  add_file(command, "--texture", options, "texture",
           "The texture: PNG, JPEG or TIFF; default: the model's own materials");
  add_name(command, "--calibration", options, "calibration", calibration_name,
           "Use this calibration instead of --pose, --film and --scale: calibrations/3, 3 or "
           "active")
      ->type_name("CALIBRATION")
      ->excludes("--pose", "--film", "--scale");
  add_stale_flag(command, spec_of(options.job));
}

void add_predict_flags(CLI::App& command, SubmitOptions& options) {
  add_file(command, "--film-image", options, "film_image", "The film image as printed")->required();
  add_file(command, "--motion", options, "motion",
           "Path of the axis: CSV with t_s, x_mm, y_mm, z_mm");
}

// Flags of simulate and predict.
void add_worker_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
  add_threads_flag(command, options);
  if (options.job.has_simulate()) {
    add_simulate_flags(command, options);
  } else {
    add_predict_flags(command, options);
  }
  add_dpi_flag(command, options);
  add(command, "--model", options, "model",
      field_help("SimulateSpec.model", "Model of the film's motion"))
      ->type_name("MODEL");
  add(command, "--inertia", options, "inertia", "Include the sheet's inertia; slower");
  add(command, "--ink-passes", options, "ink_passes",
      field_help("SimulateSpec.ink_passes", "Passes that take the ink into account"))
      ->type_name("N");
  add_file(command, "--ink-image", options, "ink_image", "Ink given directly, as a film image");
  add(command, "--artifacts", options, "artifacts",
      field_help("SimulateSpec.artifacts", "map: surface_map.ply and report.json only"))
      ->type_name("SET");
}

// Adds --simulate-job, which replaces flags that the simulation already determines.
void add_simulate_job_flag(CLI::App& command, SubmitOptions& options, const std::string& file,
                           const std::vector<std::string>& taken, const char* help) {
  auto* job = add_name(command, "--simulate-job", options, "simulate_job", job_name, help)
                  ->type_name("JOB");
  for (const std::string& flag : taken) job->excludes(command.get_option(flag));
  command.parse_complete_callback([&command, job, file] {
    if (job->count() == 0 && command.get_option(file)->count() == 0)
      throw CLI::RequiredError(file + " or --simulate-job");
  });
}

// Flags for the page layout.
void add_page_flags(CLI::App& command, SubmitOptions& options) {
  add(command, "--paper", options, "paper",
      field_help("PrintImageSpec.paper", "A4, A3, letter or WxH, in mm"))
      ->type_name("PAPER");
  add(command, "--printer-margin-mm", options, "printer_margin_mm",
      field_help("PrintImageSpec.printer_margin_mm",
                 "Unprintable margin along the edges of the paper"))
      ->type_name("D");
  add(command, "--job-name", options, "job_name", "Job name to print beside the film, as given")
      ->type_name("TEXT");
  add(command, "--date", options, "date", "Date to print beside the film, as given")
      ->type_name("TEXT");
  add_threads_flag(command, options);
}

// Flags for the contents of the pages of print-image.
void add_layout_flags(CLI::App& command, SubmitOptions& options) {
  add(command, "--bar-mm", options, "bar_mm",
      field_help("PrintImageSpec.bar_mm", "Length of the bars that hold the film"))
      ->type_name("D");
  add(command, "--overlap-mm", options, "overlap_mm",
      field_help("PrintImageSpec.overlap_mm", "Overlap of adjoining sheets"))
      ->type_name("D");
  add(command, "--mirror", options, "mirror", "Mirror the image; default: ink side up");
  add(command, "--no-marks", options, "no_marks", "Print only the film image");
  add(command, "--colours", options, "colours",
      field_help("PrintImageSpec.colours", "rgb: sRGB; cmyk: plain CMYK"))
      ->type_name("COLOURS");
  add_file(command, "--icc-profile", options, "icc_profile",
           "The printer's ICC output profile; replaces --colours");
  add(command, "--ink-limit", options, "ink_limit",
      field_help("PrintImageSpec.ink_limit", "Limit of C + M + Y + K per pixel; CMYK only"))
      ->type_name("T");
  add(command, "--formats", options, "formats",
      field_help("PrintImageSpec.formats",
                 "File formats; default: pdf, and png for RGB or tiff for CMYK"))
      ->type_name("FORMAT[,FORMAT]");
}

void add_print_image_flags(CLI::App& command, SubmitOptions& options) {
  add_file(command, "--film-image", options, "film_image", "The film image: film.png of simulate");
  add_film_flag(command, options);
  add_dpi_flag(command, options);
  add_simulate_job_flag(command, options, "--film-image", {"--film-image", "--film", "--dpi"},
                        "Print the film image of this simulation instead: jobs/7, or 7");
  add_page_flags(command, options);
  add_layout_flags(command, options);
}

void add_template_flags(CLI::App& command, SubmitOptions& options) {
  add_object_flags(command, options);
  add_simulate_job_flag(command, options, "--mesh", {"--mesh", "--scale", "--pose", "--film"},
                        "Use the object of this simulation instead: jobs/7, or 7");
  add_page_flags(command, options);
}

Status set_depth(const std::optional<std::string>& depth, google::protobuf::Message& spec) {
  if (!depth || *depth == "full") return {};
  double depth_mm = 0;
  if (!CLI::detail::lexical_cast(*depth, depth_mm))
    return fail(Code::kInvalidArgument, "--depth-mm " + *depth + ": use millimetres, or full");
  set_number(spec, "depth_mm", depth_mm);
  return {};
}

}  // namespace

void add_spec_flags(CLI::App& command, SubmitOptions& options) {
  if (options.job.has_validate()) {
    add_validation_flags(command, options);
  } else if (options.job.has_fit()) {
    add_fit_flags(command, options);
  } else if (options.job.has_print_image()) {
    add_print_image_flags(command, options);
  } else if (options.job.has_template_()) {
    add_template_flags(command, options);
  } else {
    add_worker_flags(command, options);
  }
}

void add_preview_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
}

Result<v1::Job> upload_inputs(Program& program, const SubmitOptions& options) {
  v1::Job job = options.job;
  google::protobuf::Message& spec = spec_of(job);
  HP_RETURN_IF_ERROR(set_depth(options.depth, spec));
  if (!options.pose.empty()) {
    HP_ASSIGN_OR_RETURN(pose_in(spec), client::read_pose_file(options.pose));
  }
  if (job.has_validate()) return job;  // reads no files
  Inputs inputs(program.daemon());
  if (!options.mesh.empty()) HP_RETURN_IF_ERROR(inputs.add_model(options.mesh, spec));
  for (const auto& [field, path] : options.files)
    HP_RETURN_IF_ERROR(inputs.add_to(spec, field, path));
  HP_RETURN_IF_ERROR(inputs.add_film(options.film, spec));
  return job;
}

}  // namespace hydroprint::cli
