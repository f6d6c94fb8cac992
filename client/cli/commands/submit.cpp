#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/submit_flags.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

struct JobFlags {
  SubmitOptions inputs;
  client::JobOptions job;
  bool wait = false;
  std::string out;
  WaitOptions wait_options;
};

void add_job_flags(CLI::App& command, JobFlags& options) {
  command.add_option("--name", options.job.display_name, "What people call the job")
      ->type_name("TEXT");
  command
      .add_option("--priority", options.job.priority,
                  field_help("Job.priority", "Higher goes first among yours"))
      ->type_name("N")
      ->check(field_range("Job.priority"));
  command.add_flag("--validate-only", options.job.validate_only,
                   "Upload and check, but queue nothing");
  command.add_flag("--wait", options.wait, "Follow the job to its end");
  command.add_option("--out", options.out, "Wait, then download the artifacts into this folder")
      ->type_name("DIR");
  add_wait_flags(command, options.wait_options);
}

Status submit(Program& program, const JobFlags& options) {
  HP_ASSIGN_OR_RETURN(const client::Spec spec, upload_inputs(program, options.inputs));
  HP_ASSIGN_OR_RETURN(const client::Job job,
                      client::create_job(program.daemon(), spec, options.job));
  if (options.job.validate_only) {
    tell_valid(program, job);
    return {};
  }
  const bool waits = options.wait || !options.out.empty();
  return finish_job(program, job, {options.out, !waits, options.wait_options});
}

void add_verb(CLI::App& parent, Program& program, client::Verb verb, const char* help,
              const char* footer) {
  auto options = std::make_shared<JobFlags>();
  options->inputs.spec.verb = verb;
  CLI::App* command = parent.add_subcommand(std::string(client::name_of(verb)), help);
  add_spec_flags(*command, options->inputs);
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
  add_verb(*command, program, client::Verb::kPrintImage,
           "From a film image to the files to print, at exact scale on paper",
           "Example:\n"
           "  hydroprint submit print-image --simulate-job 7 --job-name \"mug 7\" --out paper\n"
           "  hydroprint submit print-image --film-image result/film.png --out paper");
  add_verb(
      *command, program, client::Verb::kTemplate,
      "A page that shows where the object belongs, for a rig without a camera",
      "Example:\n"
      "  hydroprint submit template --simulate-job 7 --out placement\n"
      "  hydroprint submit template --mesh mug.obj --scale 10 --pose pose.json --out placement");
}

}  // namespace hydroprint::cli
