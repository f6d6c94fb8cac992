#include "client/dip.h"

#include <fmt/format.h>

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

std::string which_dip(int number, int count) {
  return fmt::format("dip {} of {}: ", number, count);
}

std::string instruction_of(const v1::DipStatus& status) {
  const bool has_plan = status.immersion() != 0 && !status.instruction().empty();
  return (has_plan ? which_dip(status.immersion(), status.immersions()) : "") +
         status.instruction();
}

std::vector<std::string> operator_steps() {
  std::vector<std::string> names;
  for (const auto step : kOperatorSteps) names.push_back(v1::DipStatus::Step_Name(step));
  return names;
}

}  // namespace hydroprint::client
