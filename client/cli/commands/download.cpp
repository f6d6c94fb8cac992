#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/scratch_folder.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

struct DownloadOptions {
  std::string job;
  std::vector<std::string> artifacts;
  std::string out;
};

// Returns "job-7" for "jobs/7".
std::string default_folder(const std::string& job) {
  return "job-" + job.substr(job.find('/') + 1);
}

// All bytes are checked before the first one is printed.
Status print_artifact(Program& program, const std::string& job, const DownloadOptions& options) {
  if (options.artifacts.size() != 1)
    return fail(Code::kInvalidArgument, "--out - prints one artifact; specify its name");
  const ScratchFolder scratch;
  HP_ASSIGN_OR_RETURN(const auto files,
                      download_all(program.daemon(), job, options.artifacts, scratch.path()));
  if (std::filesystem::file_size(files.front().path) == 0) return {};
  std::cout << std::ifstream(files.front().path, std::ios::binary).rdbuf() << std::flush;
  return {};
}

Status download(Program& program, const DownloadOptions& options) {
  const std::string job = job_name(options.job);
  if (options.out == "-") return print_artifact(program, job, options);
  const std::string folder = options.out.empty() ? default_folder(job) : options.out;
  HP_ASSIGN_OR_RETURN(const auto files,
                      download_all(program.daemon(), job, options.artifacts, folder));
  if (program.json()) {
    print({{"files", files_json(files)}});
    return {};
  }
  for (const Downloaded& file : files) std::cout << file.path.string() << std::endl;
  return {};
}

}  // namespace

void add_download(CLI::App& app, Program& program) {
  auto options = std::make_shared<DownloadOptions>();
  CLI::App* command = app.add_subcommand("download", "Download the files that a job produced");
  add_job_argument(*command, options->job);
  command->add_option("artifacts", options->artifacts, "Names of the artifacts; default: all")
      ->type_name("ARTIFACT");
  command
      ->add_option("--out", options->out,
                   "Destination folder; default: job-NUMBER; - prints one artifact")
      ->type_name("DIR");
  command->footer(
      "Each file is checked against its SHA-256 and appears only when it is complete.\n"
      "An interrupted download resumes where it stopped.\n\n"
      "Example:\n"
      "  hydroprint download 7 film.png report.json --out result");
  program.on(*command, [&program, options] { return download(program, *options); });
}

}  // namespace hydroprint::cli
