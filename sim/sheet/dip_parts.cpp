#include "sim/sheet/dip_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::sheet {

using Eigen::Vector2d;
using velocity::VelocityField;

std::vector<Vector2d> prescribed(const VelocityField& field) {
  const velocity::FilmMesh& mesh = field.mesh();
  std::vector<Vector2d> fixed(mesh.node_count(),
                              Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto copy = [&](std::size_t node) { fixed[node] = field.nodes()[node]; };
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] == velocity::EdgeKind::kInner) continue;
    copy(mesh.vertices_mm.size() + e);
    for (const int v : mesh.edges[e]) copy(v);
  }
  return fixed;
}

double span_mm(const flow::DipField& dip, std::size_t k) {
  HP_CHECK(k < dip.immersion_mm.size());
  const double before = k > 0 ? dip.immersion_mm[k - 1] : 0;
  const double after = k + 1 < dip.immersion_mm.size() ? dip.immersion_mm[k + 1] : dip.depth_mm;
  return 0.5 * (after - before);
}

double rms_change(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  HP_CHECK(a.size() == b.size());
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

}  // namespace hydroprint::sheet
