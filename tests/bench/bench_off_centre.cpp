// Compares a sphere off the centre of an A4 film, for both film models, with the finest feasible
// run, and measures how the error decreases with the mesh size. See README.md.
#include <string>
#include <utility>

#include "sim/pipeline/dip.h"
#include "sim/sample/icosphere.h"
#include "tests/bench/figures.h"

namespace hydroprint::bench {
namespace {

using pipeline::Dip;
using pipeline::DipOptions;

Dip dipped(const mesh::Model& model, const DipOptions& options) {
  return value_of(pipeline::dip(model, options, two_threads()));
}

testing::Errors apart(const Dip& a, const Dip& b) {
  return testing::errors_to(120, a.surface, validate::film_differences(a, b));
}

void against_finest(const std::string& row, const mesh::Model& model, DipOptions options) {
  const Dip usual = dipped(model, options);
  testing::scale_all(options, 0.5);
  options.schedule.swept_mm *= 2.0 / 3;
  const Dip finest = dipped(model, options);
  Json figures = json_of(apart(usual, finest));
  figures["waterlines"] = usual.figures.steps;
  figures["waterlines_finest"] = finest.figures.steps;
  figures["film_vertices"] = usual.figures.film_vertices_max;
  figures["film_vertices_finest"] = finest.figures.film_vertices_max;
  print(row, figures);
}

void slope(const std::string& row, const mesh::Model& model, const DipOptions& options) {
  const auto found = value_of(testing::mesh_slope(model, options, two_threads()));
  print(row, {{"slope", found.slope},
              {"rms_mm_at_4", found.rms_mm_at_4},
              {"rms_mm_at_2", found.rms_mm_at_2},
              {"rms_mm_at_1", found.rms_mm_at_1}});
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  using namespace hydroprint;
  const bool with_slope = argc < 2 || std::string(argv[1]) != "--quick";
  const mesh::Model model = sample::icosphere(testing::kOffCentreRadius_mm, 6);
  for (const auto& [name, film_model] : {std::pair("stokes", pipeline::FilmModel::kStokes),
                                         std::pair("sheet", pipeline::FilmModel::kSheet)}) {
    const auto options = testing::off_centre_options(film_model);
    bench::against_finest(std::string("off-centre-") + name, model, options);
    if (with_slope) bench::slope(std::string("slope-") + name, model, options);
  }
}
