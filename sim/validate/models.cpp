#include <string>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/pipeline/dip.h"
#include "sim/sample/painting.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

constexpr double kBendFrom_mm = 72;  ///< height at which the bend of the U-shape begins

image::RgbImage chessboard() {
  return sample::draw(840, 1188, 0.25, 2, [](double x, double y) -> sample::Colour {
    constexpr double kSquare_mm = 5;
    if (sample::is_dark_square(x - 105, y - 148.5, kSquare_mm)) {
      return x < 105 ? sample::Colour(0.09F, 0.25F, 0.53F) : sample::Colour(0.62F, 0.14F, 0.16F);
    }
    return {0.97F, 0.96F, 0.92F};
  });
}

}  // namespace

Status models(ExperimentContext& setup, Experiment& out, const Context& context) {
  out.text = {
      "A U-shaped tube is dipped with its two feet first and its bend last. The film between the "
      "legs is stretched during the whole dip and then lands on the bend. There, according to the "
      "paper, the viscous sheet predicts a distortion that Stokes flow does not. Both are computed "
      "here at the usual settings, for a film of uniform thickness with a chessboard of 5 mm "
      "squares.",
      "The map shows the distance on the film between the colours that the two models choose for "
      "the same place on the object. There is no photograph to decide which is right. It is only "
      "checked where they differ most."};
  Steps steps(context, out.name, 2);
  HP_ASSIGN_OR_RETURN(const Body* body, setup.body("ubend", context));
  pipeline::DipOptions options = setup.options(*body, Fineness::kUsual);
  const Context first = steps.next();
  HP_ASSIGN_OR_RETURN(const pipeline::Dip sheet, pipeline::dip(body->model, options, first));
  options.film_model = pipeline::FilmModel::kStokes;
  const Context second = steps.next();
  HP_ASSIGN_OR_RETURN(const pipeline::Dip stokes, pipeline::dip(body->model, options, second));

  const std::vector<double> differences = film_differences(sheet, stokes);
  const Region legs = [](const Eigen::Vector3d& p) { return p.z() < kBendFrom_mm; };
  const Region bend = [](const Eigen::Vector3d& p) { return p.z() >= kBendFrom_mm; };
  Table table{"Difference on the film, and stretch",
              {"region", "mean, mm", "95th percentile, mm", "largest, mm",
               "95th percentile of stretch, Stokes", "95th percentile of stretch, sheet"},
              {}};
  for (const NamedRegion& named : {NamedRegion{"legs", legs}, NamedRegion{"bend", bend}}) {
    const auto of = [&](const std::vector<double>& values) {
      return summarise(values_where(sheet.surface, values, named.region));
    };
    const Summary s = of(differences);
    table.rows.push_back({named.name, text_of(s.mean, 2), text_of(s.p95, 2), text_of(s.max, 2),
                          text_of(of(stokes.map.surface.stretch).p95, 2),
                          text_of(of(sheet.map.surface.stretch).p95, 2)});
    out.figures.push_back({named.name + "_difference_mean_mm",
                           named.name + ": mean difference on the film", "mm", s.mean,
                           std::nullopt});
  }
  out.tables.push_back(std::move(table));
  out.figures.push_back(
      {"bend_to_legs_ratio", "mean difference on the bend, divided by that on the legs", "",
       out.figures[1].value / out.figures[0].value,
       Limit{1, 1e300,
             "as in Fig. 13, the models differ most on the bend, because the film's thickness "
             "becomes uneven during the whole dip"}});

  HP_ASSIGN_OR_RETURN(const auto film, setup.texture(chessboard(), second));
  HP_ASSIGN_OR_RETURN(const auto before,
                      image::find_views(stokes.surface, stokes.X_FO, stokes.map.tiles, second));
  HP_ASSIGN_OR_RETURN(const auto after,
                      image::find_views(sheet.surface, sheet.X_FO, sheet.map.tiles, second));
  HP_RETURN_IF_ERROR(setup.show(out, "stokes", image::predicted_picture(before, film, second),
                                "The landed chessboard with Stokes flow (Fig. 13 b)."));
  HP_RETURN_IF_ERROR(setup.show(out, "sheet", image::predicted_picture(after, film, second),
                                "The landed chessboard with the viscous sheet (Fig. 13 c)."));
  return setup.show(
      out, "difference",
      image::quantity_picture(after, quantity_of("on film mm", sheet.surface, differences), second),
      "Distance on the film between the two models' colours for the same place.");
}

}  // namespace hydroprint::validate
