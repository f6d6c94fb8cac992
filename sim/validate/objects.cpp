#include <string>
#include <utility>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/printable.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {

Status objects(ExperimentContext& setup, Experiment& out, const Context& context) {
  struct Object {
    std::string name;
    NamedRegion face;
  };
  const std::vector<Object> all = {{"mug", {"the outer wall", is_mug_wall}},
                                   {"globe", band(0, 90, "the half that is dipped first")}};
  out.text = {
      "Typical uses of the software: a picture around a mug and the earth on a globe, each printed "
      "with one dip at the usual settings."};
  Steps steps(context, out.name, static_cast<int>(all.size()));
  Table table{
      "Results", {"object", "face", "reached by film", "torn", "median stretch", "verdict"}, {}};
  for (const Object& object : all) {
    const Context next = steps.next();
    HP_ASSIGN_OR_RETURN(const Plan* plan, setup.plan(object.name, next));
    const pipeline::Dip& dip = plan->dip;
    const Verdict verdict = judge(dip, object.face.region);
    const Summary stretch =
        summarise(values_where(dip.surface, dip.map.surface.stretch, object.face.region));
    table.rows.push_back({object.name, object.face.name, percent(verdict.reached),
                          percent(verdict.torn), text_of(stretch.p50, 2), verdict.text()});
    out.figures.push_back({object.name + "_reached_percent",
                           object.name + ", " + object.face.name + ": share reached by film", "%",
                           100 * verdict.reached,
                           Limit{98, 100, "Figs. 14 and 15: it was printed completely"}});
    HP_ASSIGN_OR_RETURN(const auto film, setup.texture(plan->film, next));
    HP_RETURN_IF_ERROR(setup.show(out, object.name + "-film", plan->film,
                                  "The film image for the " + object.name + ", A4."));
    HP_ASSIGN_OR_RETURN(const auto views,
                        image::find_views(dip.surface, dip.X_FO, dip.map.tiles, next));
    HP_RETURN_IF_ERROR(setup.show(out, object.name + "-landed",
                                  image::predicted_picture(views, film, next),
                                  "The " + object.name + " after the dip; grey: no film."));
  }
  out.tables.push_back(std::move(table));
  return {};
}

}  // namespace hydroprint::validate
