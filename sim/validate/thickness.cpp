#include <string>
#include <utility>
#include <vector>

#include "sim/image/figures/pictures.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/png.h"
#include "sim/pipeline/dip.h"
#include "sim/sample/painting.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

constexpr double kSquare_deg = 45;

/// Returns a chessboard in longitude and latitude, with squares of much ink (t = 2.4) and squares
/// without ink, and a graticule that makes displacements visible.
image::RgbImage squares() {
  constexpr int kHeight_px = 720;
  return sample::draw(2 * kHeight_px, kHeight_px, 180.0 / kHeight_px, 2,
                      [](double x_deg, double y_deg) -> sample::Colour {
                        const bool dark = sample::is_dark_square(x_deg, y_deg, kSquare_deg);
                        const sample::Colour ink(0, 0, 0.55F), bare(1, 1, 1);
                        const bool is_line = sample::to_nearest_line(x_deg, 15) < 0.4 ||
                                             sample::to_nearest_line(y_deg, 15) < 0.4;
                        return is_line ? sample::mix(ink, bare, 0.5) : dark ? ink : bare;
                      });
}

/// Computes the dip of a planned film, with the thickness of the ink printed on it.
Result<pipeline::Dip> dip_as_printed(const Body& body, const Plan& plan,
                                     pipeline::DipOptions options, const Context& context) {
  options.ink = plan.ink;
  return pipeline::dip(body.model, options, context);
}

}  // namespace

Status thickness(ExperimentContext& setup, Experiment& out, const Context& context) {
  out.text = {
      "Ink makes the film thicker (by 0.05 mm per unit of ink on 0.5 mm, section 4.3), and thicker "
      "film stretches less. The film image for a sphere of radius 80 mm with squares of 45 degrees "
      "in heavy ink is computed twice: by the two-step scheme, which uses the ink of its own "
      "image, "
      "and for a film of uniform thickness. Both films are then dipped with the ink that is "
      "printed on them.",
      "All dips use the usual settings, so that only the ink makes a difference."};
  Steps steps(context, out.name, 4);
  HP_ASSIGN_OR_RETURN(const Body* sphere, setup.body("sphere80", context));
  Body body = *sphere;
  HP_ASSIGN_OR_RETURN(body.model.materials[0].texture_bytes, image::encode_png(squares(), 72));
  HP_ASSIGN_OR_RETURN(body.paint, image::load_paint(body.model, {}, context));
  const pipeline::DipOptions options = setup.options(body, Fineness::kUsual);
  struct Case {
    std::string name, people;
    int ink_passes;
  };
  std::vector<Plan> plans;
  Table table{"Distance between the colours of the inked film and their places",
              {"film image computed", "to the equator: mean, mm", "largest, mm",
               "to 120 degrees: mean, mm", "largest, mm"},
              {}};
  for (const Case& c : {Case{"on", "with the ink's thickness", 2},
                        Case{"off", "for a film of uniform thickness", 0}}) {
    const Context first = steps.next();
    HP_ASSIGN_OR_RETURN(Plan plan, make_plan(body, options, c.ink_passes, setup.film_dpi(), first));
    const Context second = steps.next();
    HP_ASSIGN_OR_RETURN(const pipeline::Dip truth, dip_as_printed(body, plan, options, second));
    HP_ASSIGN_OR_RETURN(const auto errors, landing_errors(plan.dip, truth, second));
    const mesh::Surface& surface = plan.dip.surface;
    const Summary half = summarise(values_where(surface, errors, band(0, 90, "").region));
    const Summary most = summarise(values_where(surface, errors, band(0, 120, "").region));
    table.rows.push_back({c.people, text_of(half.mean, 3), text_of(half.max, 2),
                          text_of(most.mean, 3), text_of(most.max, 2)});
    out.figures.push_back({"thickness_" + c.name + "_mean_mm",
                           c.people + ": mean error to 120 degrees", "mm", most.mean,
                           std::nullopt});
    HP_ASSIGN_OR_RETURN(const auto film, setup.texture(plan.film, second));
    HP_ASSIGN_OR_RETURN(const auto landed,
                        image::find_views(truth.surface, truth.X_FO, truth.map.tiles, second));
    HP_RETURN_IF_ERROR(
        setup.show(out, c.name + "-landed", image::predicted_picture(landed, film, second),
                   "The inked film on the sphere; its image was computed " + c.people + "."));
    HP_ASSIGN_OR_RETURN(const auto planned,
                        image::find_views(surface, plan.dip.X_FO, plan.dip.map.tiles, second));
    HP_RETURN_IF_ERROR(setup.show(
        out, c.name + "-error",
        image::quantity_picture(
            planned, quantity_of("error mm", surface, errors, band(0, 120, "").region), second),
        "Distance of the landed colours from their places: " + c.people + "."));
    plans.push_back(std::move(plan));
  }
  out.tables.push_back(std::move(table));
  HP_RETURN_IF_ERROR(setup.show(out, "film", plans[0].film,
                                "The film image of the two-step scheme, with its heavy ink."));
  out.figures.push_back(
      {"thickness_on_to_off", "mean error with the ink's thickness, divided by that without", "",
       out.figures[0].value / out.figures[1].value,
       Limit{0, 0.25, "Fig. 7: using the ink's thickness removes most of the error"}});
  const auto& passes = plans[0].dip.figures.ink_passes;
  if (passes.size() > 1) {
    out.figures.push_back(
        {"second_pass_to_first",
         "movement (rms) of the second ink pass, divided by that of the first", "",
         passes[1].moved_rms_mm / passes[0].moved_rms_mm,
         Limit{0, 0.5, "section 4.3: one pass is enough, so the second must move it little"}});
  }
  return {};
}

}  // namespace hydroprint::validate
