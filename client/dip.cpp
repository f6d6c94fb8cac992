#include "client/dip.h"

#include <algorithm>
#include <array>

namespace hydroprint::client {
namespace {

struct Named {
  DipStep step;
  std::string_view name;
  bool by_operator;
};

constexpr std::array<Named, 13> kSteps{{
    {DipStep::kUnknown, "UNKNOWN", false},
    {DipStep::kPrintFilm, "PRINT_FILM", true},
    {DipStep::kLoadObject, "LOAD_OBJECT", true},
    {DipStep::kFindContact, "FIND_CONTACT", true},
    {DipStep::kClear, "CLEAR", false},
    {DipStep::kLayFilm, "LAY_FILM", true},
    {DipStep::kSoak, "SOAK", false},
    {DipStep::kSprayActivator, "SPRAY_ACTIVATOR", true},
    {DipStep::kActivate, "ACTIVATE", false},
    {DipStep::kStartDip, "START_DIP", true},
    {DipStep::kDescend, "DESCEND", false},
    {DipStep::kHold, "HOLD", false},
    {DipStep::kRetract, "RETRACT", false},
}};

const Named& entry_of(DipStep step) {
  return *std::find_if(kSteps.begin(), kSteps.end(),
                       [&](const Named& entry) { return entry.step == step; });
}

}  // namespace

std::string_view name_of(DipStep step) { return entry_of(step).name; }

DipStep dip_step_of(std::string_view name) {
  const auto* found = std::find_if(kSteps.begin(), kSteps.end(),
                                   [&](const Named& entry) { return entry.name == name; });
  return found == kSteps.end() ? DipStep::kUnknown : found->step;
}

bool waits_for_operator(DipStep step) { return entry_of(step).by_operator; }

std::vector<std::string> operator_steps() {
  std::vector<std::string> names;
  for (const Named& entry : kSteps)
    if (entry.by_operator) names.emplace_back(entry.name);
  return names;
}

}  // namespace hydroprint::client
