#include "daemon/dip/operator_messages.h"

#include <fmt/format.h>

namespace hydroprint::dip {
namespace {

std::string print_film(const Plan& plan) {
  const std::string image =
      plan.simulate_job.empty() ? "the film image" : "the film image of " + plan.simulate_job;
  return fmt::format("{}print {} at its full size and let it dry; then confirm",
                     plan.has_uncertain_pose
                         ? "the object's pose is uncertain (see the warnings): abort and "
                           "calibrate again, or accept a misplaced print: "
                         : "",
                     image);
}

std::string find_contact(const Plan& plan) {
  if (!plan.contact_mm) {
    return "jog down until the object almost touches the water; then confirm: this sets first "
           "contact, and the object rises";
  }
  return fmt::format(
      "first contact is known from {}, at {:g} mm: take your hands away; then confirm: the object "
      "goes to {:g} mm above the water",
      plan.calibration, *plan.contact_mm, plan.clearance_mm);
}

}  // namespace

std::string instruction(Step step, const Plan& plan) {
  switch (step) {
    case Step::kPrintFilm:
      return print_film(plan);
    case Step::kLoadObject:
      return "mount the object in the gripper as planned; then confirm";
    case Step::kFindContact:
      return find_contact(plan);
    case Step::kClear:
      return plan.contact_mm
                 ? fmt::format("the object goes to {:g} mm above the water; keep your hands away",
                               plan.clearance_mm)
                 : fmt::format("the object rises by {:g} mm; keep your hands away",
                               plan.clearance_mm);
    case Step::kLayFilm:
      return "lay the film on the water between the bars, ink side up; then confirm: the "
             "soaking time starts";
    case Step::kSoak:
      return fmt::format("the film soaks for {:g} s", plan.clocks.soak_s);
    case Step::kSprayActivator:
      return fmt::format(
          "spray {:.1f} ml of activator evenly over the film ({:g} ml/m2); then confirm: the "
          "activation time starts",
          plan.activator_ml(), plan.activator_ml_per_m2);
    case Step::kActivate:
      return fmt::format("the activator works for {:g} s", plan.clocks.activator_wait_s);
    case Step::kStartDip:
      return fmt::format(
          "take your hands away; then confirm: the object goes down {:g} mm into the water at {:g} "
          "mm/s",
          plan.depth_mm, plan.speed_mm_per_s);
    case Step::kDescend:
      return fmt::format("the object goes down at {:g} mm/s; keep your hands away",
                         plan.speed_mm_per_s);
    case Step::kHold:
      return fmt::format("the object stays at its depth for {:g} s; keep your hands away",
                         plan.hold_s);
    case Step::kRetract:
      return fmt::format("the object comes up at {:g} mm/s; keep your hands away",
                         plan.retract_speed_mm_per_s);
  }
  return "";
}

std::string afterwards(const Plan& plan) {
  if (plan.immersion == 0)
    return "take the object out, rinse off the rest of the film, and let it dry";
  return fmt::format(
      "skim the rest of the film off the water, take the object out, rinse it and let it dry; the "
      "plan{} states what comes next",
      plan.plan_job.empty() ? "" : " " + plan.plan_job);
}

std::string advice(Step step) {
  switch (step) {
    case Step::kPrintFilm:
    case Step::kLoadObject:
      return "nothing is in the water; keep the film dry for another dip";
    case Step::kFindContact:
      return "jog the object up before you reach for it; keep the film dry for another dip";
    case Step::kClear:
      return "the object is just above the water: move it up before you reach for it; keep the "
             "film dry for another dip";
    case Step::kLayFilm:
      return "if the film is on the water already, take it off and throw it away; the object is "
             "clean: move it up and take it out";
    case Step::kSoak:
    case Step::kSprayActivator:
      return "the film is wet and cannot be used again: take it off the water and throw it away; "
             "the object is clean: move it up and take it out";
    case Step::kActivate:
    case Step::kStartDip:
      return "the film is activated and cannot be used again: skim it off the water, with gloves; "
             "the object is clean: move it up and take it out";
    case Step::kDescend:
      return "the object hangs where it stopped, perhaps half in the film: skim the rest of the "
             "film off the water first, then move the object up slowly and wash the print off "
             "before it dries";
    case Step::kHold:
      return "the object is printed and under water: skim the rest of the film off the water "
             "first, then move the object up slowly and rinse it";
    case Step::kRetract:
      return "the object is printed: skim the rest of the film off the water, move the object up "
             "the rest of the way and rinse it";
  }
  return "";
}

std::string late_words(double since_sprayed_s, const Clocks& clocks) {
  return fmt::format(
      "the film was activated {:.0f} s ago, but stays usable for only {:.0f} s: expect a poor "
      "print",
      since_sprayed_s, clocks.activator_wait_s + clocks.activation_window_s);
}

}  // namespace hydroprint::dip
