#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"
#include "sim/validate/experiment_result.h"

namespace hydroprint::validate {

/// Description of an experiment.
struct ExperimentKind {
  std::string name;
  std::string title;
  double weight = 1;  ///< typical duration, relative to the other experiments
};

/// Returns all experiments, in the order of the report.
[[nodiscard]] std::vector<ExperimentKind> kinds();

struct Options {
  std::vector<std::string> only;  ///< names of experiments; empty: all
  bool quick = false;             ///< coarse: checks that everything runs, not its accuracy
};

/// Writes a finished picture; `file` ends in ".png".
using PictureSink = std::function<Status(const std::string& file, const image::RgbImage& picture)>;

struct Report {
  Options options;
  std::vector<Experiment> experiments;
  int passed = 0, failed = 0;  ///< numbers of figures within and outside their limits
};

/// Returns kInvalidArgument for unknown names of experiments.
[[nodiscard]] Status check(const Options& options);

/// Runs the experiments of the paper's section 7 in silico. A finer computation represents the
/// physical experiment. Progress is reported under the experiments' names. The report and the
/// pictures do not depend on the number of threads. Returns the errors of check().
[[nodiscard]] Result<Report> validate(const Options& options, const PictureSink& pictures,
                                      const Context& context);

}  // namespace hydroprint::validate
