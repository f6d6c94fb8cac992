#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/pipeline/dip.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/printable.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

using Eigen::Vector3d;

/// Returns the stretch, equal in all directions, of the film on the floor of a bowl dipped mouth
/// down. Inside the ring where film has landed, eqs. (1) and (2) stretch the film evenly at the
/// rate tan(theta / 2) v / a, for a ring of radius a. With v dt = sin(theta) ds along the wall, the
/// stretch is exp(integral of (1 - cos theta) / a ds), from the rim to the floor.
double exact_floor_stretch(const mesh::Model& model) {
  // The sample's outline, in order: the vertices at y = 0 on the +x side.
  std::vector<Vector3d> outline;
  for (const Vector3d& p : model.vertices) {
    if (p.y() == 0 && p.x() >= 0) outline.push_back(p);
  }
  std::size_t i = static_cast<std::size_t>(
      std::max_element(outline.begin(), outline.end(),
                       [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); }) -
      outline.begin());
  double growth = 0;
  for (; i + 1 < outline.size(); ++i) {
    const double ds = (outline[i + 1] - outline[i]).norm();
    const double dr = outline[i].x() - outline[i + 1].x();
    const double rise = outline[i].z() - outline[i + 1].z();
    if (rise < 1e-9) break;  // the floor
    const double middle = 0.5 * (outline[i].x() + outline[i + 1].x());
    growth += (1 - dr / ds) / middle * ds;
  }
  return std::exp(growth);
}

std::string list_of(const Warnings& warnings) {
  std::string out;
  for (const Warning& w : warnings)
    out += (out.empty() ? "" : "; ") + std::string(name_of(w.code)) + ": " + w.message;
  return out.empty() ? "none" : out;
}

bool warns(const pipeline::Dip& dip, WarningCode code) {
  return std::any_of(dip.warnings.begin(), dip.warnings.end(),
                     [&](const Warning& w) { return w.code == code; });
}

}  // namespace

Status bowl(ExperimentContext& setup, Experiment& out, const Context& context) {
  out.text = {
      "The paper's failure case is the inside of a deep bowl. Mouth down, the bowl traps air, "
      "which "
      "keeps water and film out. Upright, water and film do not enter the bowl at all. The "
      "software must recognise this without a person looking at the picture.",
      "The verdict uses the rule of the stretch maps: " + std::string(kPrintableRule),
      "A vent in the floor would not help: the rim encloses a disc of film that must cover the "
      "whole wall before it reaches the floor, and by then it is stretched until it tears. The "
      "stretch on the floor is computed as if the air could escape."};
  Steps steps(context, out.name, 3);
  Table table{"The inside of the bowl, and its floor",
              {"dipped", "inside reached by film", "inside torn", "floor torn",
               "median stretch on the floor", "verdict on the floor", "warnings"},
              {}};
  struct Way {
    std::string body, people;
    WarningCode warning;
  };
  for (const Way& way : {Way{"bowl", "mouth down", WarningCode::AIR_TRAPPED},
                         Way{"bowl-upright", "upright", WarningCode::PARTS_NOT_REACHED}}) {
    const Context next = steps.next();
    HP_ASSIGN_OR_RETURN(const Plan* plan, setup.plan(way.body, next));
    const pipeline::Dip& dip = plan->dip;
    const Verdict inside = judge(dip, is_bowl_inside);
    const Verdict verdict = judge(dip, is_bowl_floor);
    const double floor =
        summarise(values_where(dip.surface, dip.map.surface.stretch, is_bowl_floor)).p50;
    table.rows.push_back({way.people, percent(inside.reached), percent(inside.torn),
                          percent(verdict.torn), text_of(floor, 2), verdict.text(),
                          list_of(dip.warnings)});
    const std::string key = way.body == "bowl" ? "mouth_down" : "upright";
    out.figures.push_back({key + "_recognised",
                           way.people +
                               ": 1 if the verdict on the floor is that it cannot be "
                               "printed and the warning " +
                               std::string(name_of(way.warning)) + " is given",
                           "", verdict.good() < 0.5 && warns(dip, way.warning) ? 1.0 : 0.0,
                           Limit{1, 1, "Fig. 17: it cannot be printed"}});
    HP_ASSIGN_OR_RETURN(const auto views,
                        image::find_views(dip.surface, dip.X_FO, dip.map.tiles, next));
    HP_RETURN_IF_ERROR(
        setup.show(out, key + "-stretch", image::stretch_picture(views, dip.map.surface, next),
                   "Stretch on the bowl, dipped " + way.people + "; hatched: no film."));
    if (way.body != "bowl") continue;
    HP_RETURN_IF_ERROR(setup.show(out, key + "-film", plan->film,
                                  "The film image for the bowl, without its inside."));
    HP_ASSIGN_OR_RETURN(const auto film, setup.texture(plan->film, next));
    HP_RETURN_IF_ERROR(setup.show(out, key + "-landed", image::predicted_picture(views, film, next),
                                  "The bowl after the dip: its inside stays bare."));
  }
  out.tables.push_back(std::move(table));

  const Context last = steps.next();
  HP_ASSIGN_OR_RETURN(const Body* body, setup.body("bowl", last));
  pipeline::DipOptions options = setup.options(*body, Fineness::kUsual);
  options.map.make_tiles = false;
  options.schedule.air_escapes = true;
  HP_ASSIGN_OR_RETURN(const pipeline::Dip even, pipeline::dip(body->model, options, last));
  const double floor =
      summarise(values_where(even.surface, even.map.surface.stretch, is_bowl_floor)).p50;
  const double exact = exact_floor_stretch(body->model);
  out.figures.push_back({"floor_stretch",
                         "median stretch on the floor if air escapes, film without ink", "", floor,
                         Limit{3, 1e300, "film tears at a stretch of three"}});
  out.figures.push_back(
      {"floor_stretch_to_exact", "the same, divided by the exact solution for the bowl's outline",
       "", floor / exact,
       Limit{0.95, 1.05, "inside a ring the film stretches evenly, by a known formula"}});
  return {};
}

}  // namespace hydroprint::validate
