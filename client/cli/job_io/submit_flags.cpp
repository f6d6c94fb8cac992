#include "client/cli/job_io/submit_flags.h"

#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/inputs.h"
#include "client/pose_file.h"

namespace hydroprint::cli {
namespace {

void add_file(CLI::App& command, const char* flag, std::string& file, const char* help) {
  command.add_option(flag, file, help)->type_name("FILE");
}

void add_threads_flag(CLI::App& command, client::Spec& spec) {
  command
      .add_option("--threads", spec.threads,
                  field_help("SimulateSpec.threads", "Threads of the computation"))
      ->type_name("N");
}

void add_validation_flags(CLI::App& command, client::Spec& spec) {
  command
      .add_option("--only", spec.only,
                  field_help("ValidateSpec.only", "Experiments to run; default: all"))
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  command.add_flag("--quick", spec.quick, "Run coarsely, to check that everything works");
  add_threads_flag(command, spec);
}

void add_film_flag(CLI::App& command, SubmitOptions& options) {
  command
      .add_option("--film", options.film,
                  field_help("SimulateSpec.film",
                             "A4, A3, letter, WxH, circle:RADIUS or polygon:FILE.json, in mm"))
      ->type_name("FILM");
}

CLI::Option* add_film_image_flag(CLI::App& command, SubmitOptions& options, const char* help) {
  return command.add_option("--film-image", options.film_image, help)->type_name("FILE");
}

void add_dpi_flag(CLI::App& command, client::Spec& spec) {
  command
      .add_option("--dpi", spec.dpi,
                  field_help(spec.verb == client::Verb::kPrintImage ? "PrintImageSpec.dpi"
                                                                    : "SimulateSpec.dpi",
                             "Resolution of the film image"))
      ->type_name("DPI");
}

// Flags for an object and its place over the film.
void add_object_flags(CLI::App& command, SubmitOptions& options) {
  command.add_option("--mesh", options.mesh, "The object: OBJ, STL, PLY, glTF or GLB")
      ->type_name("FILE");
  command
      .add_option("--scale", options.spec.scale,
                  field_help("SimulateSpec.scale", "Size of a model unit"))
      ->type_name("FACTOR");
  add_file(command, "--pose", options.pose,
           R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: centred on the film)");
  add_film_flag(command, options);
}

// Flags for the dip: profile, depth and speed.
void add_dip_flags(CLI::App& command, SubmitOptions& options) {
  client::Spec& spec = options.spec;
  add_object_flags(command, options);
  command.get_option("--mesh")->required();
  add_file(command, "--profile", options.profile, "Film profile, TOML");
  command
      .add_option("--depth-mm", options.depth,
                  field_help("SimulateSpec.depth_mm", "Depth at the end of the dip"))
      ->type_name("D");
  command
      .add_option("--dip-speed-mm-per-s", spec.dip_speed_mm_per_s,
                  field_help("SimulateSpec.dip_speed_mm_per_s", "Speed of the dip"))
      ->type_name("V");
}

void add_fit_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
  add_threads_flag(command, options.spec);
  command.add_option("--points", options.points, "Measured landing points, CSV")
      ->type_name("FILE")
      ->required();
  add_file(command, "--ink-image", options.ink_image,
           "Image printed on the film; needed to fit the ink ratio");
  command
      .add_option(
          "--free", options.spec.free,
          field_help("FitSpec.free", "Parameters to fit; default: all that the points determine"))
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  command.add_flag("--drop-outliers", options.spec.drop_outliers, "Exclude outliers");
}

void add_worker_flags(CLI::App& command, SubmitOptions& options) {
  client::Spec& spec = options.spec;
  add_dip_flags(command, options);
  add_threads_flag(command, spec);
  if (spec.verb == client::Verb::kSimulate) {
    add_file(command, "--texture", options.texture,
             "The texture: PNG, JPEG or TIFF; default: the model's own materials");
    command
        .add_option(
            "--calibration", options.calibration,
            "Use this calibration instead of --pose, --film and --scale: calibrations/3, 3 or "
            "active")
        ->type_name("CALIBRATION")
        ->excludes("--pose", "--film", "--scale");
    add_stale_flag(command, spec.allow_stale_calibration);
  } else {
    add_film_image_flag(command, options, "The film image as printed")->required();
    add_file(command, "--motion", options.motion,
             "Path of the axis: CSV with t_s, x_mm, y_mm, z_mm");
  }
  add_dpi_flag(command, spec);
  command
      .add_option("--model", spec.model,
                  field_help("SimulateSpec.model", "Model of the film's motion"))
      ->type_name("MODEL")
      ->check(field_choices("SimulateSpec.model"));
  command.add_flag("--inertia", spec.inertia, "Include the sheet's inertia; slower");
  command
      .add_option("--ink-passes", spec.ink_passes,
                  field_help("SimulateSpec.ink_passes", "Passes that take the ink into account"))
      ->type_name("N");
  add_file(command, "--ink-image", options.ink_image, "Ink given directly, as a film image");
  command
      .add_option("--artifacts", spec.artifacts,
                  field_help("SimulateSpec.artifacts", "map: surface_map.ply and report.json only"))
      ->type_name("SET")
      ->check(field_choices("SimulateSpec.artifacts"));
}

// Adds --simulate-job, which replaces flags that the simulation already determines.
void add_simulate_job_flag(CLI::App& command, SubmitOptions& options, const std::string& file,
                           const std::vector<std::string>& taken, const char* help) {
  auto* job = command.add_option("--simulate-job", options.simulate_job, help)->type_name("JOB");
  for (const std::string& flag : taken) job->excludes(command.get_option(flag));
  command.parse_complete_callback([&command, job, file] {
    if (job->count() == 0 && command.get_option(file)->count() == 0)
      throw CLI::RequiredError(file + " or --simulate-job");
  });
}

// Flags for the page layout.
void add_page_flags(CLI::App& command, client::Spec& spec) {
  client::PageSpec& page = spec.page;
  command
      .add_option("--paper", page.paper,
                  field_help("PrintImageSpec.paper", "A4, A3, letter or WxH, in mm"))
      ->type_name("PAPER");
  command
      .add_option("--printer-margin-mm", page.printer_margin_mm,
                  field_help("PrintImageSpec.printer_margin_mm",
                             "Unprintable margin along the edges of the paper"))
      ->type_name("D");
  command.add_option("--job-name", page.job_name, "Printed beside the film, as given")
      ->type_name("TEXT");
  command.add_option("--date", page.date, "Printed beside the film, as given")->type_name("TEXT");
  add_threads_flag(command, spec);
}

void add_print_image_flags(CLI::App& command, SubmitOptions& options) {
  client::PageSpec& page = options.spec.page;
  add_film_image_flag(command, options, "The film image: film.png of simulate");
  add_film_flag(command, options);
  add_dpi_flag(command, options.spec);
  add_simulate_job_flag(command, options, "--film-image", {"--film-image", "--film", "--dpi"},
                        "Print the film image of this simulation instead: jobs/7, or 7");
  add_page_flags(command, options.spec);
  command
      .add_option("--bar-mm", page.bar_mm,
                  field_help("PrintImageSpec.bar_mm", "Length of the bars that hold the film"))
      ->type_name("D");
  command
      .add_option("--overlap-mm", page.overlap_mm,
                  field_help("PrintImageSpec.overlap_mm", "Overlap of adjoining sheets"))
      ->type_name("D");
  command.add_flag("--mirror", page.mirror, "Mirror the image; default: ink side up");
  command.add_flag("--no-marks", page.no_marks, "Print only the film image");
  command
      .add_option("--colours", page.colours,
                  field_help("PrintImageSpec.colours", "rgb: sRGB; cmyk: plain CMYK"))
      ->type_name("COLOURS")
      ->check(field_choices("PrintImageSpec.colours"));
  add_file(command, "--icc-profile", options.icc_profile,
           "The printer's ICC output profile; replaces --colours");
  command
      .add_option(
          "--ink-limit", page.ink_limit,
          field_help("PrintImageSpec.ink_limit", "Limit of C + M + Y + K per pixel; CMYK only"))
      ->type_name("T");
  command
      .add_option("--formats", page.formats,
                  field_help("PrintImageSpec.formats",
                             "File formats; default: pdf, and png for RGB or tiff for CMYK"))
      ->delimiter(',')
      ->type_name("FORMAT[,FORMAT]");
}

void add_template_flags(CLI::App& command, SubmitOptions& options) {
  add_object_flags(command, options);
  add_simulate_job_flag(command, options, "--mesh", {"--mesh", "--scale", "--pose", "--film"},
                        "Use the object of this simulation instead: jobs/7, or 7");
  add_page_flags(command, options.spec);
}

Status set_depth(const std::optional<std::string>& depth, client::Spec& spec) {
  if (!depth || *depth == "full") return {};
  double depth_mm = 0;
  if (!CLI::detail::lexical_cast(*depth, depth_mm))
    return fail(Code::kInvalidArgument, "--depth-mm " + *depth + ": use millimetres, or full");
  spec.depth_mm = depth_mm;
  return {};
}

}  // namespace

void add_spec_flags(CLI::App& command, SubmitOptions& options) {
  const client::Verb verb = options.spec.verb;
  if (verb == client::Verb::kValidate) {
    add_validation_flags(command, options.spec);
  } else if (verb == client::Verb::kFit) {
    add_fit_flags(command, options);
  } else if (verb == client::Verb::kPrintImage) {
    add_print_image_flags(command, options);
  } else if (verb == client::Verb::kTemplate) {
    add_template_flags(command, options);
  } else {
    add_worker_flags(command, options);
  }
}

void add_preview_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
}

Result<client::Spec> upload_inputs(Program& program, const SubmitOptions& options) {
  client::Spec spec = options.spec;
  if (spec.verb == client::Verb::kValidate) return spec;  // reads no files
  if (!options.simulate_job.empty()) spec.simulate_job = job_name(options.simulate_job);
  if (!options.calibration.empty()) spec.calibration = calibration_name(options.calibration);
  HP_RETURN_IF_ERROR(set_depth(options.depth, spec));
  if (!options.pose.empty()) {
    HP_ASSIGN_OR_RETURN(spec.pose, client::read_pose_file(options.pose));
  }
  Inputs inputs(program.daemon());
  if (!options.mesh.empty()) HP_RETURN_IF_ERROR(inputs.add_model(options.mesh, spec));
  HP_ASSIGN_OR_RETURN(spec.texture, inputs.add(options.texture));
  HP_ASSIGN_OR_RETURN(spec.film_image, inputs.add(options.film_image));
  HP_ASSIGN_OR_RETURN(spec.motion, inputs.add(options.motion));
  HP_ASSIGN_OR_RETURN(spec.points, inputs.add(options.points));
  HP_ASSIGN_OR_RETURN(spec.profile, inputs.add(options.profile));
  HP_ASSIGN_OR_RETURN(spec.ink_image, inputs.add(options.ink_image));
  HP_ASSIGN_OR_RETURN(spec.page.icc_profile, inputs.add(options.icc_profile));
  if (!options.film.empty()) {
    HP_ASSIGN_OR_RETURN(spec.film, inputs.add_film(options.film, spec));
  }
  return spec;
}

}  // namespace hydroprint::cli
