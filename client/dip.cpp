#include "client/dip.h"

#include <algorithm>
#include <array>

namespace hydroprint::client {
namespace {

constexpr std::array kOperatorSteps{v1::DipStatus::PRINT_FILM,      v1::DipStatus::LOAD_OBJECT,
                                    v1::DipStatus::FIND_CONTACT,    v1::DipStatus::LAY_FILM,
                                    v1::DipStatus::SPRAY_ACTIVATOR, v1::DipStatus::START_DIP};

}  // namespace

bool waits_for_operator(v1::DipStatus::Step step) {
  return std::find(kOperatorSteps.begin(), kOperatorSteps.end(), step) != kOperatorSteps.end();
}

std::vector<std::string> operator_steps() {
  std::vector<std::string> names;
  for (const auto step : kOperatorSteps) names.push_back(v1::DipStatus::Step_Name(step));
  return names;
}

}  // namespace hydroprint::client
