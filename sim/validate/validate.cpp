#include "sim/validate/validate.h"

#include <algorithm>
#include <array>
#include <utility>

#include "sim/validate/experiment_context.h"
#include "sim/validate/experiments.h"

namespace hydroprint::validate {
namespace {

struct Maker {
  const char* name;
  const char* title;
  const char* paper;
  double weight;
  Status (*run)(ExperimentContext&, Experiment&, const Context&);
};

constexpr std::array kMakers = {
    Maker{"repeatability", "Repeatability", "section 7.1, Fig. 11", 12, repeatability},
    Maker{"accuracy", "Accuracy of the landing", "section 7.1, Fig. 12", 55, accuracy},
    Maker{"models", "Stokes flow and viscous sheet", "section 7.1, Fig. 13", 6, models},
    Maker{"thickness", "Thickness of the ink", "section 4.3, Fig. 7", 25, thickness},
    Maker{"stretch", "Stretch maps", "section 6, Fig. 9", 22, stretch},
    Maker{"objects", "A mug and a globe", "section 7.2, Figs. 14 and 15", 4, objects},
    Maker{"bowl", "The bowl that cannot be printed", "section 8, Fig. 17", 6, bowl}};

bool is_asked_for(const Options& options, const std::string& name) {
  return options.only.empty() ||
         std::find(options.only.begin(), options.only.end(), name) != options.only.end();
}

}  // namespace

std::vector<ExperimentKind> kinds() {
  std::vector<ExperimentKind> out;
  for (const Maker& maker : kMakers) out.push_back({maker.name, maker.title, maker.weight});
  return out;
}

Status check(const Options& options) {
  std::string known;
  for (const Maker& maker : kMakers) known.append(known.empty() ? "" : ", ").append(maker.name);
  for (const std::string& name : options.only) {
    const bool is_known = std::any_of(kMakers.begin(), kMakers.end(),
                                      [&](const Maker& maker) { return name == maker.name; });
    if (is_known) continue;
    return fail(Code::kInvalidArgument, "unknown experiment '" + name + "'. Choose from " + known);
  }
  return {};
}

Result<Report> validate(const Options& options, const PictureSink& pictures,
                        const Context& context) {
  HP_RETURN_IF_ERROR(check(options));
  Report report;
  report.options = options;
  ExperimentContext setup(options.quick, pictures);
  for (const Maker& maker : kMakers) {
    if (!is_asked_for(options, maker.name)) continue;
    HP_RETURN_IF_ERROR(check_cancelled(context));
    context.progress(maker.name, 0);
    Experiment experiment;
    experiment.name = maker.name;
    experiment.title = maker.title;
    experiment.paper = maker.paper;
    HP_RETURN_IF_ERROR(maker.run(setup, experiment, context));
    context.progress(maker.name, 1);
    for (const Figure& figure : experiment.figures) {
      if (figure.limit) ++(figure.passes() ? report.passed : report.failed);
    }
    report.experiments.push_back(std::move(experiment));
  }
  return report;
}

}  // namespace hydroprint::validate
