#include <cmath>
#include <string>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/printable.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

struct Shown {
  std::string body;    ///< name for ExperimentContext
  std::string people;  ///< name for display
  NamedRegion face;    ///< the face to print
};

std::vector<Shown> bodies() {
  return {{"board",
           "board at 30 degrees",
           {"lower face", [](const Eigen::Vector3d& p) { return p.z() < 1e-6; }}},
          {"sphere80", "sphere, radius 80 mm", band(0, 90, "to the equator")},
          {"globe", "globe, radius 60 mm", band(0, 120, "to 120 degrees")},
          {"ubend", "U-shape", {"legs", [](const Eigen::Vector3d& p) { return p.z() < 72; }}},
          {"mug", "mug", {"outer wall", is_mug_wall}},
          {"bowl", "bowl, mouth down", {"floor", is_bowl_floor}}};
}

}  // namespace

Status stretch(ExperimentContext& setup, Experiment& out, const Context& context) {
  const auto shown = bodies();
  out.text = {
      "The stretch of the film where it lands is the largest singular value of the map from film "
      "to surface (section 6), at the usual settings. The paper uses such maps to choose from "
      "which side to print each part of an object. It states that Stokes flow cannot predict "
      "stretch beyond 1.3.",
      "The second table shows which faces one dip can print. The rule for all bodies: " +
          std::string(kPrintableRule)};
  Steps steps(context, out.name, static_cast<int>(shown.size()));
  Table figures{"Stretch and coverage of the whole body",
                {"body", "reached by film", "median stretch", "95th percentile", "clamped", "torn",
                 "wrinkled", "warnings"},
                {}};
  Table printable{
      "Faces that one dip can print", {"body", "face", "reached by film", "torn", "verdict"}, {}};
  for (const Shown& s : shown) {
    const Context next = steps.next();
    HP_ASSIGN_OR_RETURN(const Plan* plan, setup.plan(s.body, next));
    const pipeline::DipFigures& f = plan->dip.figures;
    std::string warnings;
    for (const Warning& w : plan->dip.warnings)
      warnings += (warnings.empty() ? "" : ", ") + std::string(name_of(w.code));
    figures.rows.push_back({s.people, percent(f.coverage), text_of(f.stretch_p50, 2),
                            text_of(f.stretch_p95, 2), percent(f.clamped_share),
                            percent(f.torn_share), percent(f.wrinkled_share),
                            warnings.empty() ? "none" : warnings});
    const Verdict verdict = judge(plan->dip, s.face.region);
    printable.rows.push_back(
        {s.people, s.face.name, percent(verdict.reached), percent(verdict.torn), verdict.text()});
    const pipeline::Dip& dip = plan->dip;
    HP_ASSIGN_OR_RETURN(const auto views,
                        image::find_views(dip.surface, dip.X_FO, dip.map.tiles, next));
    HP_RETURN_IF_ERROR(setup.show(out, s.body, image::stretch_picture(views, dip.map.surface, next),
                                  "Stretch on the " + s.people + "."));
    if (s.body == "sphere80") {
      const double at_contact =
          summarise(
              values_where(plan->dip.surface, plan->dip.map.surface.stretch, band(0, 2, "").region))
              .max;
      out.figures.push_back(
          {"sphere_stretch_at_contact", "sphere: largest stretch within 2 degrees of first contact",
           "", at_contact, Limit{1, 1.02, "film that lands immediately is not stretched"}});
    }
  }
  out.tables = {figures, printable};
  return {};
}

}  // namespace hydroprint::validate
