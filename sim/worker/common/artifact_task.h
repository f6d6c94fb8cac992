#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/process/out_folder.h"
#include "sim/base/process/progress.h"
#include "sim/worker/common/report.h"
#include "sim/worker/common/task.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// A task that writes an artifact folder with a report.json.
class ArtifactTask : public Task {
 public:
  /// @param verb  name for report.json
  explicit ArtifactTask(std::string verb) : verb_(std::move(verb)) {}

  [[nodiscard]] Result<Finished> run(const RunOptions& options, Termination& termination,
                                     int stderr_fd) final;

  /// Returns the stages of a run in order, each with its approximate share of the total time, from
  /// which the remaining time is estimated. A stage that recurs is listed each time. A run may skip
  /// stages.
  [[nodiscard]] virtual std::vector<Stage> stages() const = 0;

 protected:
  /// Returns the files that must be readable before the computation starts. report.json lists them.
  [[nodiscard]] virtual std::vector<InputPath> input_files() const = 0;

  /// Runs the computation, then creates `folder` and writes the artifacts into it. Sets the verb's
  /// findings in report(). Adds warnings, artifacts and further inputs to `run`.
  [[nodiscard]] virtual Status compute(OutFolder& folder, v1::RunFacts& run,
                                       const Context& context) = 0;

  /// Returns the summary as text; each line ends with a newline. Called after compute().
  [[nodiscard]] virtual std::string summary(const std::filesystem::path& dir) const = 0;

  /// Returns the message of report.json.
  [[nodiscard]] virtual google::protobuf::Message& report() = 0;
  /// Returns what all reports have in common, which is usually a part of report().
  [[nodiscard]] virtual v1::RunFacts& run_facts() = 0;

 private:
  [[nodiscard]] Status write_all(OutFolder& folder, Progress& progress, const Context& context);
  [[nodiscard]] Result<std::string> json_summary(const std::filesystem::path& dir);

  std::string verb_;
};

/// A task whose report.json is a message with the field `run`.
template <class Message>
class ReportTask : public ArtifactTask {
 protected:
  using ArtifactTask::ArtifactTask;

  [[nodiscard]] google::protobuf::Message& report() final { return report_; }
  [[nodiscard]] v1::RunFacts& run_facts() final { return *report_.mutable_run(); }

  Message report_;
};

}  // namespace hydroprint::worker
