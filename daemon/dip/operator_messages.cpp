#include "daemon/dip/operator_messages.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "daemon/dip/text.h"

namespace hydroprint::dip {
namespace {

std::string spray(const Plan& plan) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1) << plan.activator_ml();
  return text("spray ", out.str(), " ml of activator evenly over the film (",
              plan.activator_ml_per_m2, " ml/m2); then confirm: its clock starts");
}

}  // namespace

std::string instruction(Step step, const Plan& plan) {
  switch (step) {
    case Step::kPrintFilm:
      return "print the film image" +
             (plan.simulate_job.empty() ? std::string() : " of " + plan.simulate_job) +
             " at its full size and let it dry; then confirm";
    case Step::kLoadObject:
      return "mount the object in the gripper as planned; then confirm";
    case Step::kFindContact:
      if (plan.contact_mm) {
        return text("first contact is known from ", plan.calibration, ", at ", *plan.contact_mm,
                    " mm: take your hands away; then confirm: the object goes to ",
                    plan.clearance_mm, " mm above the water");
      }
      return "jog down until the object almost touches the water; then confirm: this sets first "
             "contact, and the object rises";
    case Step::kClear:
      if (plan.contact_mm) {
        return text("the object goes to ", plan.clearance_mm,
                    " mm above the water; keep your hands away");
      }
      return text("the object rises by ", plan.clearance_mm, " mm; keep your hands away");
    case Step::kLayFilm:
      return "lay the film on the water between the bars, ink side up; then confirm: its clock "
             "starts";
    case Step::kSoak:
      return text("the film soaks for ", plan.clocks.soak_s, " s");
    case Step::kSprayActivator:
      return spray(plan);
    case Step::kActivate:
      return text("the activator works for ", plan.clocks.activator_wait_s, " s");
    case Step::kStartDip:
      return text("take your hands away; then confirm: the object goes down ", plan.depth_mm,
                  " mm into the water at ", plan.speed_mm_per_s, " mm/s");
    case Step::kDescend:
      return text("the object goes down at ", plan.speed_mm_per_s, " mm/s; keep your hands away");
    case Step::kHold:
      return text("the object stays at its depth for ", plan.hold_s, " s; keep your hands away");
    case Step::kRetract:
      return text("the object comes up at ", plan.retract_speed_mm_per_s,
                  " mm/s; keep your hands away");
  }
  return "";
}

std::string afterwards() {
  return "take the object out, rinse off the rest of the film, and let it dry";
}

std::string advice(Step step) {
  switch (step) {
    case Step::kPrintFilm:
    case Step::kLoadObject:
      return "nothing is in the water: keep the film dry, it can be used for another dip";
    case Step::kFindContact:
      return "jog the object up before you reach for it; keep the film dry, it can be used for "
             "another dip";
    case Step::kClear:
      return "the object is just above the water: move it up before you reach for it; keep the "
             "film "
             "dry, it can be used for another dip";
    case Step::kLayFilm:
      return "if the film is on the water already, take it off and throw it away; the object is "
             "clean, move it up and take it out";
    case Step::kSoak:
    case Step::kSprayActivator:
      return "the film is wet and cannot be used again: take it off the water and throw it away; "
             "the object is "
             "clean, move it up and take it out";
    case Step::kActivate:
    case Step::kStartDip:
      return "the film is activated and cannot be used again: skim it off the water, with gloves; "
             "the object is "
             "clean, move it up and take it out";
    case Step::kDescend:
      return "the object hangs where it stopped, perhaps half in the film: skim the rest of the "
             "film "
             "off the water first, then move the object up slowly and wash the print off before it "
             "dries";
    case Step::kHold:
      return "the object is printed and under water: skim the rest of the film off the water "
             "first, "
             "then move it up slowly and rinse it";
    case Step::kRetract:
      return "the object is printed: skim the rest of the film off the water, move it up the rest "
             "of "
             "its way and rinse it";
  }
  return "";
}

std::string late_words(double since_sprayed_s, const Clocks& clocks) {
  return text("activated ", std::lround(since_sprayed_s), " s ago; the film is good for ",
              std::lround(clocks.activator_wait_s + clocks.activation_window_s),
              " s: expect a poor print");
}

}  // namespace hydroprint::dip
