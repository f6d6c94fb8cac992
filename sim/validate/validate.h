#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"
#include "sim/validate/experiment_result.h"

namespace hydroprint::validate {

/// An experiment that there is.
struct ExperimentKind {
  std::string name;
  std::string title;
  double weight = 1;  ///< its usual share of the time
};

/// All of them, in the order of the report.
[[nodiscard]] std::vector<ExperimentKind> kinds();

struct Options {
  std::vector<std::string> only;  ///< names of experiments; empty: all
  bool quick = false;             ///< everything coarse: that it works, not how well
};

/// Takes a finished picture to its place; `file` ends in ".png".
using PictureSink = std::function<Status(const std::string& file, const image::RgbImage& picture)>;

struct Report {
  Options options;
  std::vector<Experiment> experiments;
  int passed = 0, failed = 0;  ///< figures that there is a limit for
};

/// Refuses (kInvalidArgument) names of experiments that there are not.
[[nodiscard]] Status check(const Options& options);

/// The experiments of the paper's section 7 in silico: a much finer computation plays the physical
/// experiment. Progress is told under the experiments' names. The same report and pictures whatever
/// the number of threads. Refuses what `check` does.
[[nodiscard]] Result<Report> validate(const Options& options, const PictureSink& pictures,
                                      const Context& context);

}  // namespace hydroprint::validate
