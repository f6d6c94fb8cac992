#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/job_io/submit_flags.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"
#include "proto/rules/field_rules.h"

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
  command.add_option("--name", options.job.display_name, "Display name of the job")
      ->type_name("TEXT");
  command.add_option("--priority", options.job.priority, field_help("Job.priority"))
      ->type_name("N")
      ->check(field_range("Job.priority"));
  command.add_flag("--validate-only", options.job.validate_only,
                   "Upload and check, but queue nothing");
  command.add_flag("--wait", options.wait, "Wait until the job is finished");
  command.add_option("--out", options.out, "Wait, then download the artifacts into this folder")
      ->type_name("DIR");
  add_wait_flags(command, options.wait_options);
}

Status submit(Program& program, const JobFlags& options) {
  Inputs inputs(program.daemon());
  HP_ASSIGN_OR_RETURN(const v1::Job described, upload_inputs(inputs, options.inputs));
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_job(program.daemon(), described, options.job));
  if (options.job.validate_only) {
    tell_valid(program, job);
    return {};
  }
  const bool waits = options.wait || !options.out.empty();
  HP_RETURN_IF_ERROR(finish_job(program, job, {options.out, !waits, options.wait_options, {}}));
  return waits && !program.json() ? tell_warnings(program, job.name()) : Status();
}

/// Job kinds that have commands of their own instead of `submit KIND`.
constexpr std::array<std::string_view, 5> kOwnCommands = {"dip", "print", "capture", "calibrate",
                                                          "calibrate_camera"};

// Examples, shown below the help of a kind.
std::string footer_of(const std::string& kind) {
  static const std::map<std::string, std::string> kFooters = {
      {"simulate",
       "Files that an OBJ, MTL or glTF refers to are uploaded too. Omitted flags take the\n"
       "worker's defaults.\n\n"
       "Example:\n"
       "  hydroprint submit simulate --mesh spot.obj --texture spot.png --scale 50 --out result"},
      {"plan",
       "three.json lists the dips: their poses over the film, and their depths:\n"
       "  [{\"rotation_wxyz\": [1, 0, 0, 0], \"translation_mm\": [0, 0, 0], \"depth_mm\": "
       "\"full\"}, "
       "...]\n\n"
       "Example:\n"
       "  hydroprint submit plan --mesh spot.obj --texture spot.png --scale 50 --immersions "
       "three.json --out plan"},
      {"predict",
       "Example:\n"
       "  hydroprint submit predict --mesh spot.obj --film-image film.png --scale 50 --wait"},
      {"fit",
       "Example:\n"
       "  hydroprint submit fit --mesh ball.ply --points measured.csv --ink-image film.png "
       "--out fitted"},
      {"validate", "Example:\n  hydroprint submit validate --out validation"},
      {"print_image",
       "Examples:\n"
       "  hydroprint submit print-image --simulate-job 7 --job-name \"mug 7\" --out paper\n"
       "  hydroprint submit print-image --film-image result/film.png --out paper"},
      {"template",
       "Examples:\n"
       "  hydroprint submit template --simulate-job 7 --out placement\n"
       "  hydroprint submit template --mesh mug.obj --scale 10 --pose pose.json --out placement"}};
  const auto found = kFooters.find(kind);
  return found == kFooters.end() ? std::string() : found->second;
}

void add_kind(CLI::App& parent, Program& program, const google::protobuf::FieldDescriptor& kind) {
  auto options = std::make_shared<JobFlags>();
  options->inputs.job = job_of_kind(kind.name());
  CLI::App* command = parent.add_subcommand(rules::flag_of(kind), rules::flag_help(kind));
  add_spec_flags(*command, options->inputs);
  add_job_flags(*command, *options);
  command->footer(footer_of(kind.name()));
  program.on(*command, [&program, options] { return submit(program, *options); });
}

}  // namespace

void add_submit(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("submit", "Upload files and queue a job");
  command->require_subcommand(1);
  const auto& kinds = *v1::Job::descriptor()->FindOneofByName("spec");
  for (int i = 0; i < kinds.field_count(); ++i) {
    const auto& kind = *kinds.field(i);
    if (std::find(kOwnCommands.begin(), kOwnCommands.end(), kind.name()) == kOwnCommands.end())
      add_kind(*command, program, kind);
  }
}

}  // namespace hydroprint::cli
