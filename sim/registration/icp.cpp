#include "sim/registration/icp.h"

#include "sim/base/module.h"

namespace hydroprint::registration {

Result<std::unique_ptr<const Icp>> make_icp(std::span<const SurfacePoint> target) {
  static const auto symbol = module_symbol("hydroprint-icp.so", "hydroprint_icp");
  if (!symbol) return tl::unexpected(symbol.error());
  return std::unique_ptr<const Icp>(reinterpret_cast<decltype(&hydroprint_icp)>(*symbol)(target));
}

}  // namespace hydroprint::registration
