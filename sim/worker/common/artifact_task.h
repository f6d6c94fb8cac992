#pragma once

#include <string>
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

  /// Runs the computation, then creates `folder` and writes the artifacts into it. Adds warnings,
  /// artifacts and further inputs to the report.
  [[nodiscard]] virtual Status compute(OutFolder& folder, Report& report,
                                       const Context& context) = 0;

  /// Returns the verb's own keys of report.json, in order. Called after compute().
  [[nodiscard]] virtual Json findings(const Report& /*report*/) const { return Json::object(); }
  /// Returns the content of report.json. Called last; by default report_json() of findings().
  [[nodiscard]] virtual Result<std::string> report_text(const Report& report) const;
  /// Returns the figures of the summary for `--json`. Called after compute().
  [[nodiscard]] virtual Json figures() const = 0;
  /// Returns the summary for `--json`; by default summary_json() of figures().
  [[nodiscard]] virtual Result<std::string> json_summary(const Report& report,
                                                         const std::filesystem::path& dir) const;
  /// Returns the summary as text; each line ends with a newline. Called after compute().
  [[nodiscard]] virtual std::string summary(const Report& report,
                                            const std::filesystem::path& dir) const = 0;

 private:
  [[nodiscard]] Status write_all(OutFolder& folder, Report& report, Progress& progress,
                                 const Context& context);

  std::string verb_;
};

}  // namespace hydroprint::worker
