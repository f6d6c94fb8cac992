#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "client/cli/commands.h"
#include "client/cli/inputs.h"
#include "client/cli/json.h"
#include "client/cli/program.h"
#include "client/cli/wait.h"
#include "client/jobs.h"
#include "client/pose_file.h"

namespace hydroprint::cli {
namespace {

// The flags of `submit VERB`; those of the worker under their own names.
struct SubmitOptions {
  client::Spec spec;  // what needs no upload goes here at once
  std::string mesh, texture, film_image, motion, points, profile, ink_image, pose, film;
  std::optional<std::string> depth;
  client::JobOptions job;
  bool wait = false;
  std::string out;
  WaitOptions wait_options;
};

void add_file(CLI::App& command, const char* flag, std::string& file, const char* help) {
  command.add_option(flag, file, help)->type_name("FILE");
}

void add_threads_flag(CLI::App& command, client::Spec& spec) {
  command.add_option("--threads", spec.threads, "Threads of the computation")->type_name("N");
}

void add_validation_flags(CLI::App& command, client::Spec& spec) {
  command.add_option("--only", spec.only, "Experiments to run; default: all")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  command.add_flag("--quick", spec.quick, "A coarse run, which shows that everything works");
  add_threads_flag(command, spec);
}

// What goes in which way through which film.
void add_dip_flags(CLI::App& command, SubmitOptions& options) {
  client::Spec& spec = options.spec;
  command.add_option("--mesh", options.mesh, "The object: OBJ, STL, PLY, glTF or GLB")
      ->type_name("FILE")
      ->required();
  command.add_option("--scale", spec.scale, "Model units to mm")->type_name("FACTOR");
  add_file(command, "--pose", options.pose,
           R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}; default: centred on the film)");
  add_file(command, "--profile", options.profile, "Film profile, TOML");
  command
      .add_option("--film", options.film,
                  "A4, A3, letter, WxH, circle:RADIUS or polygon:FILE.json, in mm; default A4")
      ->type_name("FILM");
  command.add_option("--depth-mm", options.depth, "Immersion at the end of the dip, or full")
      ->type_name("D");
  command.add_option("--dip-speed-mm-per-s", spec.dip_speed_mm_per_s, "Speed of the dip")
      ->type_name("V");
  add_threads_flag(command, spec);
}

void add_fit_flags(CLI::App& command, SubmitOptions& options) {
  add_dip_flags(command, options);
  command.add_option("--points", options.points, "Measured landing points, CSV")
      ->type_name("FILE")
      ->required();
  add_file(command, "--ink-image", options.ink_image,
           "What was printed on the film; without it the ink ratio cannot be fitted");
  command
      .add_option("--free", options.spec.free,
                  "What to fit: ink_ratio, drag, swelling; default: all that can be")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  command.add_flag("--drop-outliers", options.spec.drop_outliers, "Leave out outliers");
}

void add_worker_flags(CLI::App& command, SubmitOptions& options) {
  client::Spec& spec = options.spec;
  add_dip_flags(command, options);
  if (spec.verb == client::Verb::kSimulate) {
    add_file(
        command, "--texture", options.texture,
        "Its texture: PNG, JPEG or TIFF; without it the model's own materials give the colour");
  } else {
    command.add_option("--film-image", options.film_image, "The film image as printed")
        ->type_name("FILE")
        ->required();
    add_file(command, "--motion", options.motion,
             "The path as driven: CSV with t_s, x_mm, y_mm, z_mm");
  }
  command.add_option("--dpi", spec.dpi, "Resolution of the film image")->type_name("DPI");
  command.add_option("--model", spec.model, "How the film moves")
      ->type_name("MODEL")
      ->check(CLI::IsMember({"sheet", "stokes"}));
  command.add_flag("--inertia", spec.inertia, "The sheet moves with inertia; slower");
  command.add_option("--ink-passes", spec.ink_passes, "Passes that take the ink into account")
      ->type_name("N");
  add_file(command, "--ink-image", options.ink_image, "Ink given directly, as a film image");
  command.add_option("--artifacts", spec.artifacts, "map: surface_map.ply and report.json only")
      ->type_name("SET")
      ->check(CLI::IsMember({"all", "map"}));
}

void add_job_flags(CLI::App& command, SubmitOptions& options) {
  command.add_option("--name", options.job.display_name, "What people call the job")
      ->type_name("TEXT");
  command.add_option("--priority", options.job.priority, "0 to 9; higher goes first among yours")
      ->type_name("N")
      ->check(CLI::Range(0, 9));
  command.add_flag("--validate-only", options.job.validate_only,
                   "Upload and check, but queue nothing");
  command.add_flag("--wait", options.wait, "Follow the job to its end");
  command.add_option("--out", options.out, "Wait, then download the artifacts into this folder")
      ->type_name("DIR");
  add_wait_flags(command, options.wait_options);
}

Status set_depth(const std::optional<std::string>& depth, client::Spec& spec) {
  if (!depth || *depth == "full") return {};
  double depth_mm = 0;
  if (!CLI::detail::lexical_cast(*depth, depth_mm))
    return fail(Code::kInvalidArgument, "--depth-mm " + *depth + ": give millimetres, or full");
  spec.depth_mm = depth_mm;
  return {};
}

Result<client::Spec> upload_inputs(Program& program, const SubmitOptions& options) {
  client::Spec spec = options.spec;
  if (spec.verb == client::Verb::kValidate) return spec;  // it reads no files
  HP_RETURN_IF_ERROR(set_depth(options.depth, spec));
  if (!options.pose.empty()) {
    HP_ASSIGN_OR_RETURN(spec.pose, client::read_pose_file(options.pose));
  }
  Inputs inputs(program.daemon());
  HP_RETURN_IF_ERROR(inputs.add_model(options.mesh, spec));
  HP_ASSIGN_OR_RETURN(spec.texture, inputs.add(options.texture));
  HP_ASSIGN_OR_RETURN(spec.film_image, inputs.add(options.film_image));
  HP_ASSIGN_OR_RETURN(spec.motion, inputs.add(options.motion));
  HP_ASSIGN_OR_RETURN(spec.points, inputs.add(options.points));
  HP_ASSIGN_OR_RETURN(spec.profile, inputs.add(options.profile));
  HP_ASSIGN_OR_RETURN(spec.ink_image, inputs.add(options.ink_image));
  if (!options.film.empty()) {
    HP_ASSIGN_OR_RETURN(spec.film, inputs.add_film(options.film, spec));
  }
  return spec;
}

void print_created(const Program& program, const client::Job& job, const SubmitOptions& options) {
  if (program.json())
    print(to_json(job));
  else if (options.job.validate_only)
    std::cout << "The daemon would take this job." << std::endl;
  else
    std::cout << job.name << std::endl;
}

Status wait_and_fetch(Program& program, const std::string& name, const SubmitOptions& options) {
  HP_ASSIGN_OR_RETURN(const client::Job job, wait_for(program, name, options.wait_options));
  std::vector<Downloaded> files;
  if (!options.out.empty()) {
    HP_ASSIGN_OR_RETURN(files, download_all(program.daemon(), name, {}, options.out));
  }
  if (program.json()) {
    Json json = to_json(job);
    if (!options.out.empty()) json["files"] = to_json(files);
    print(json);
  } else {
    for (const Downloaded& file : files) std::cout << file.path.string() << std::endl;
  }
  return {};
}

Status submit(Program& program, const SubmitOptions& options) {
  HP_ASSIGN_OR_RETURN(const client::Spec spec, upload_inputs(program, options));
  HP_ASSIGN_OR_RETURN(const client::Job job,
                      client::create_job(program.daemon(), spec, options.job));
  const bool wait = (options.wait || !options.out.empty()) && !options.job.validate_only;
  if (!wait || !program.json()) print_created(program, job, options);
  return wait ? wait_and_fetch(program, job.name, options) : Status();
}

void add_verb(CLI::App& parent, Program& program, client::Verb verb, const char* help,
              const char* footer) {
  auto options = std::make_shared<SubmitOptions>();
  options->spec.verb = verb;
  CLI::App* command = parent.add_subcommand(std::string(client::name_of(verb)), help);
  if (verb == client::Verb::kValidate) {
    add_validation_flags(*command, options->spec);
  } else if (verb == client::Verb::kFit) {
    add_fit_flags(*command, *options);
  } else {
    add_worker_flags(*command, *options);
  }
  add_job_flags(*command, *options);
  command->footer(footer);
  program.on(*command, [&program, options] { return submit(program, *options); });
}

}  // namespace

void add_submit(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("submit", "Upload files and queue a job");
  command->require_subcommand(1);
  add_verb(
      *command, program, client::Verb::kSimulate, "From a textured model to the image to print",
      "What an OBJ, MTL or glTF refers to beside it is uploaded too. Flags left out take the\n"
      "worker's defaults.\n\nExample:\n"
      "  hydroprint submit simulate --mesh spot.obj --texture spot.png --scale 50 --out result");
  add_verb(*command, program, client::Verb::kPredict,
           "From a film image to the colours that land on the object",
           "Example:\n"
           "  hydroprint submit predict --mesh spot.obj --film-image film.png --scale 50 --wait");
  add_verb(*command, program, client::Verb::kFit,
           "From measured landing points to the film profile that explains them",
           "Example:\n"
           "  hydroprint submit fit --mesh ball.ply --points measured.csv --ink-image film.png "
           "--out fitted");
  add_verb(*command, program, client::Verb::kValidate,
           "The paper's experiments in silico, as a report with pictures",
           "Example:\n  hydroprint submit validate --out validation");
}

}  // namespace hydroprint::cli
