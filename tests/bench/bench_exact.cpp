// Compares a centred sphere in a circular film with the exact map of field notes, section 2, for
// both film models. See README.md.
#include <string>

#include "sim/pipeline/dip.h"
#include "sim/sample/icosphere.h"
#include "tests/bench/figures.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::bench {
namespace {

constexpr double kSphere_mm = 40;
constexpr double kVat_mm = 105;

double exact_angle(double film_mm) {
  return exact::contact_angle_rad(kSphere_mm, kVat_mm, film_mm);
}

void measure(const std::string& row, const mesh::Model& model, pipeline::FilmModel film_model) {
  pipeline::DipOptions options = testing::sphere_options("circle:105", kSphere_mm, 120);
  options.film_model = film_model;
  const pipeline::Dip dip = value_of(pipeline::dip(model, options, two_threads()));
  const auto distances = testing::landing_distances_mm(dip, kSphere_mm, exact_angle);
  Json figures = json_of(testing::errors_to(120, dip.surface, distances));
  figures["rms_mm_to_60_deg"] = testing::errors_to(60, dip.surface, distances).summary.rms;
  figures["rms_mm_to_90_deg"] = testing::errors_to(90, dip.surface, distances).summary.rms;
  figures["triangles"] = model.triangles.size();
  figures["waterlines"] = dip.figures.steps;
  print(row, figures);
}

}  // namespace
}  // namespace hydroprint::bench

int main() {
  using namespace hydroprint;
  const mesh::Model model = sample::icosphere(bench::kSphere_mm, 6);
  bench::measure("exact-stokes", model, pipeline::FilmModel::kStokes);
  bench::measure("exact-sheet", model, pipeline::FilmModel::kSheet);
}
