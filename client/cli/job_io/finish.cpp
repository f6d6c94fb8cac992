#include "client/cli/job_io/finish.h"

#include <iostream>
#include <vector>

#include "client/cli/format/json.h"
#include "client/cli/format/report_text.h"
#include "client/jobs.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {

void add_finish_flags(CLI::App& command, FinishOptions& options) {
  command.add_option("--out", options.out, "Download the artifacts into this folder")
      ->type_name("DIR");
  command.add_flag("--no-wait", options.no_wait, "Do not wait until the job is finished")
      ->excludes("--out");
  add_wait_flags(command, options.wait);
}

void tell_created(const Program& program, const v1::Job& job) {
  if (program.json())
    print(job);
  else
    std::cout << job.name() << std::endl;
}

void tell_valid(const Program& program, const v1::Job& job) {
  if (program.json())
    print(job);
  else
    std::cout << "The job is valid." << std::endl;
}

Status finish_job(Program& program, const v1::Job& job, const FinishOptions& options) {
  if (options.no_wait || !program.json()) tell_created(program, job);
  if (options.no_wait) return {};
  HP_ASSIGN_OR_RETURN(const v1::Job ended, wait_for(program, job.name(), options.wait));
  std::vector<Downloaded> files;
  if (!options.out.empty()) {
    HP_ASSIGN_OR_RETURN(files,
                        download_all(program.daemon(), job.name(), options.artifacts, options.out));
  }
  if (!program.json()) {
    for (const Downloaded& file : files) std::cout << file.path.string() << std::endl;
    return {};
  }
  Json json = to_json(ended);
  if (!options.out.empty()) json["files"] = files_json(files);
  print(json);
  return {};
}

Status tell_warnings(Program& program, const std::string& job) {
  const auto report = client::job_report(program.daemon(), job);
  if (!report) {  // the job succeeded all the same
    const bool has_none = report.error().reason == ErrorReason::ARTIFACT_NOT_FOUND ||
                          report.error().reason == ErrorReason::ARTIFACT_DAMAGED;
    return has_none ? Status() : tl::unexpected(report.error());
  }
  for (const v1::Warning& warning : run_of(*report).warnings())
    std::cerr << "hydroprint: warning: " << hydroprint::text_of(warning) << std::endl;
  return {};
}

}  // namespace hydroprint::cli
