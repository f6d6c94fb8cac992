#include "sim/registration/icp.h"

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/module.h"

namespace hydroprint::registration {

std::vector<SurfacePoint> thinned(std::span<const scan::ScanPoint> points, std::size_t most) {
  HP_CHECK(most > 0);
  std::vector<SurfacePoint> out;
  const std::size_t step = std::max<std::size_t>(1, points.size() / most);
  for (std::size_t i = 0; i < points.size(); i += step)
    out.push_back({points[i].point_mm, points[i].normal});
  return out;
}

Result<std::unique_ptr<const Icp>> make_icp(std::span<const SurfacePoint> target) {
  static const auto symbol = module_symbol("hydroprint-icp.so", "hydroprint_icp");
  if (!symbol) return tl::unexpected(symbol.error());
  return std::unique_ptr<const Icp>(reinterpret_cast<decltype(&hydroprint_icp)>(*symbol)(target));
}

}  // namespace hydroprint::registration
