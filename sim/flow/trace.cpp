#include "sim/flow/trace.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"
#include "sim/flow/back_path.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::flow {
using Eigen::Vector2d;
using velocity::VelocityField;

namespace {

/// Returns the rest position of the film node nearest to a point.
Vector2d nearest_rest_mm(const RestMap& known, const Vector2d& point_mm) {
  const velocity::FilmMesh& mesh = known.rest_mm.mesh();
  Vector2d rest_mm = point_mm;
  double least_mm2 = HUGE_VAL;
  for (std::size_t n = 0; n < known.rest_mm.nodes().size(); ++n) {
    const double distance_mm2 = (velocity::place_of(mesh, n) - point_mm).squaredNorm();
    if (!(distance_mm2 < least_mm2)) continue;
    least_mm2 = distance_mm2;
    rest_mm = known.rest_mm.nodes()[n];
  }
  return rest_mm;
}

}  // namespace

Result<std::vector<Vector2d>> trace_back(const DipField& dip, const std::vector<Landing>& landings,
                                         std::string_view stage, const Context& context) {
  HP_CHECK(dip.immersion_mm.size() == dip.fields.size());
  HP_CHECK(std::is_sorted(dip.immersion_mm.begin(), dip.immersion_mm.end()));
  std::vector<Vector2d> film_mm(landings.size());
  HP_RETURN_IF_ERROR(for_each_part(landings, stage, context, [&](const Part& part) {
    std::vector<BackPath> paths = paths_to(dip, landings, part);
    follow_back(dip, neighbours_in_turn(paths), 0, paths);
    come_to_rest(dip, paths);
    for (std::size_t i = 0; i < part.size(); ++i) film_mm[part[i]] = paths[i].point_mm;
  }));
  return film_mm;
}

std::optional<Vector2d> trace_back(const DipField& dip, const Landing& landing) {
  std::vector<BackPath> paths = {path_to(dip, landing)};
  follow_back(dip, neighbours_in_turn(paths), 0, paths);
  come_to_rest(dip, paths);
  if (paths[0].is_lost()) return std::nullopt;
  return paths[0].point_mm;
}

std::vector<Vector2d> trace_back(const DipField& dip, std::size_t k, const RestMap* known) {
  HP_CHECK(k < dip.fields.size());
  HP_CHECK(known == nullptr || known->waterline <= k);
  const VelocityField& field = dip.fields[k];
  std::vector<BackPath> paths;
  paths.reserve(field.nodes().size());
  for (std::size_t n = 0; n < field.nodes().size(); ++n) {
    BackPath& path = paths.emplace_back(
        BackPath{velocity::place_of(field.mesh(), n), dip.immersion_mm[k], field.nodes()[n], k});
    path.keeps_on = true;  // nodes of the film mesh are certainly film
  }
  follow_back(dip, neighbours_in_turn(paths), known != nullptr ? known->waterline : 0, paths);
  if (known == nullptr) come_to_rest(dip, paths);
  std::vector<Vector2d> rest_mm(paths.size());
  for (std::size_t n = 0; n < paths.size(); ++n) {
    rest_mm[n] = paths[n].point_mm;
    if (known == nullptr) continue;
    const bool is_film = known->rest_mm.at(paths[n].point_mm, kFarReach_mm, rest_mm[n]);
    if (!is_film) rest_mm[n] = nearest_rest_mm(*known, paths[n].point_mm);
  }
  return rest_mm;
}

}  // namespace hydroprint::flow
