#include "daemon/jobs/plan_progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/jobs/plan_binding.h"

namespace hydroprint::daemon {
namespace {

using Dip = v1::PlanProgress::Dip;

bool is_over(const v1::Job& job) {
  return job.state() == v1::Job::SUCCEEDED || job.state() == v1::Job::FAILED ||
         job.state() == v1::Job::CANCELLED || job.state() == v1::Job::INTERRUPTED;
}

bool is_done(const v1::Job& job) { return job.state() == v1::Job::SUCCEEDED; }

/// Returns the first job that meets the condition, or nullptr.
template <class Condition>
const v1::Job* find(const std::vector<const v1::Job*>& jobs, const Condition& condition) {
  const auto found = std::ranges::find_if(jobs, [&](const v1::Job* j) { return condition(*j); });
  return found == jobs.end() ? nullptr : *found;
}

template <class Condition>
std::vector<const v1::Job*> all(const PlanFacts& facts, const Condition& condition) {
  std::vector<const v1::Job*> out;
  for (const v1::Job& job : facts.jobs) {
    if (condition(job)) out.push_back(&job);
  }
  return out;
}

std::vector<const v1::Job*> simulations(const PlanFacts& facts, int immersion) {
  return all(facts, [&](const v1::Job& job) {
    return job.has_simulate() && job.simulate().plan_job() == facts.plan_job &&
           job.simulate().immersion() == immersion;
  });
}

std::string ending_of(const v1::Job& job) {
  const std::string why = job.error().message();
  return fmt::format("{} is {}{}", job.name(), v1::Job::State_Name(job.state()),
                     why.empty() ? "" : ": " + why);
}

/// Returns whether the active calibration may serve this dip.
bool is_usable(const PlanFacts& facts, int immersion) {
  if (!facts.active || !facts.active->stale().empty()) return false;
  const v1::Calibration& calibration = *facts.active;
  const v1::ObjectSetup& object = facts.spec.object();
  const auto scale = object.has_scale() ? std::optional(object.scale()) : std::nullopt;
  if (calibration.mesh().asset() != object.mesh().asset() ||
      mismatch(calibration, scale, facts.spec.film().film())) {
    return false;
  }
  return std::ranges::none_of(facts.jobs, [&](const v1::Job& job) {
    return job.has_simulate() && job.simulate().plan_job() == facts.plan_job &&
           job.simulate().immersion() != immersion &&
           job.simulate().calibration() == calibration.name();
  });
}

/// Finds the steps of one dip.
class DipSteps {
 public:
  DipSteps(const PlanFacts& facts, int immersion)
      : facts_(facts),
        immersion_(immersion),
        simulations_(simulations(facts, immersion)),
        dips_(all(facts, [&](const v1::Job& job) {
          return job.has_dip() && job.dip_status().plan_job() == facts.plan_job &&
                 job.dip_status().immersion() == immersion;
        })) {
    out_.set_immersion(immersion);
    out_.set_picture(fmt::format("{}/artifacts/stretch-{}.png", facts.plan_job, immersion));
  }

  Dip find_all() {
    if (!find_dip()) find_film();
    return out_;
  }

 private:
  void wait_for(const v1::Job& job) {
    out_.set_step(v1::PlanProgress::WAIT);
    out_.set_job(job.name());
    say(fmt::format("{} is being computed", job.name()));
  }

  void say(const std::string& what) { out_.set_instruction(what); }

  std::vector<const v1::Job*> layouts_of(const std::string& film) const {
    return all(facts_, [&](const v1::Job& job) {
      return job.has_print_image() && job.print_image().simulate_job() == film;
    });
  }

  /// Returns whether the dip is done or in progress.
  bool find_dip() {
    const v1::Job* const done = find(dips_, is_done);
    const v1::Job* const newest = dips_.empty() ? nullptr : dips_.front();
    if (done != nullptr) {
      out_.set_step(v1::PlanProgress::DONE);
      out_.set_dip_job(done->name());
      out_.set_simulate_job(done->dip().simulate_job());
      if (const v1::Job* const layout = find(layouts_of(out_.simulate_job()), is_done))
        out_.set_print_image_job(layout->name());
      say("done");
      return true;
    }
    if (newest == nullptr) return false;
    out_.set_dip_job(newest->name());
    if (is_over(*newest)) {
      out_.set_trouble(ending_of(*newest));
      return false;
    }
    out_.set_step(v1::PlanProgress::CONFIRM);
    out_.set_job(newest->name());
    out_.set_simulate_job(newest->dip().simulate_job());
    say("follow the steps of " + newest->name());
    return true;
  }

  void find_film() {
    const v1::Job* const newest = simulations_.empty() ? nullptr : simulations_.front();
    if (newest != nullptr && !is_over(*newest)) return wait_for(*newest);
    const v1::Job* const film = find(simulations_, is_done);
    if (newest != nullptr && !is_done(*newest)) out_.set_trouble(ending_of(*newest));
    if (film != nullptr && is_valid(*film)) return find_layout(*film);
    find_calibration();
  }

  /// Returns whether the object still hangs as computed, as far as is known.
  bool is_valid(const v1::Job& film) {
    const auto known = facts_.calibrations.find(film.simulate().calibration());
    if (known == facts_.calibrations.end() || known->second.stale().empty()) return true;
    out_.set_trouble(
        fmt::format("{} is out of date, because {} is no longer valid", film.name(), known->first));
    return false;
  }

  void find_layout(const v1::Job& film) {
    out_.set_simulate_job(film.name());
    const auto warned = facts_.warnings.find(film.name());
    if (warned != facts_.warnings.end())
      out_.mutable_warnings()->Assign(warned->second.begin(), warned->second.end());
    const auto layouts = layouts_of(film.name());
    if (!layouts.empty() && !is_over(*layouts.front())) return wait_for(*layouts.front());
    if (const v1::Job* const layout = find(layouts, is_done)) {
      out_.set_print_image_job(layout->name());
      out_.set_step(v1::PlanProgress::DIP);
      return say("print the film at its full size, then dip");
    }
    out_.set_step(v1::PlanProgress::LAY_OUT);
    say(fmt::format("lay out the film image of {} for the printer", film.name()));
  }

  void find_calibration() {
    if (!is_usable(facts_, immersion_) && facts_.has_camera) {
      out_.set_step(v1::PlanProgress::CALIBRATE);
      return say("hang the object as in the picture, then calibrate");
    }
    out_.set_step(v1::PlanProgress::SIMULATE);
    if (!is_usable(facts_, immersion_))
      return say("compute the film for the planned pose (this rig has no depth camera)");
    out_.set_calibration(facts_.active->name());
    say("compute the film for the measured pose");
  }

  const PlanFacts& facts_;
  int immersion_;
  std::vector<const v1::Job*> simulations_, dips_;
  Dip out_;
};

/// Returns how urgent the step of a dip is: the largest is next.
int urgency(const Dip& dip) {
  switch (dip.step()) {
    case v1::PlanProgress::CONFIRM:
      return 4;
    case v1::PlanProgress::WAIT:
      return 3;
    case v1::PlanProgress::LAY_OUT:
    case v1::PlanProgress::DIP:
      return 2;
    case v1::PlanProgress::DONE:
      return 0;
    default:
      return 1;
  }
}

bool is_calibration_of(const v1::Job& job, const PlanFacts& facts) {
  return job.has_calibrate() &&
         job.calibrate().mesh().asset() == facts.spec.object().mesh().asset();
}

/// Replaces step CALIBRATE by WAIT while a capture or the calibration of this object runs.
/// @return whether there is such a job
bool wait_for_calibration(const PlanFacts& facts, Dip& dip) {
  for (const v1::Job& job : facts.jobs) {
    if (is_over(job) || !(job.has_capture() || is_calibration_of(job, facts))) continue;
    dip.set_step(v1::PlanProgress::WAIT);
    dip.set_job(job.name());
    return true;
  }
  return false;
}

/// Says why the newest attempt to calibrate ended without success. No spec names the dip, so
/// attempts are those since the newest film or dip of the plan, while the next step is CALIBRATE.
void tell_failed_calibration(const PlanFacts& facts, Dip& dip) {
  const auto attempts = all(facts, [&](const v1::Job& job) {
    return is_calibration_of(job, facts) ||
           (job.has_capture() && facts.owners.contains(job.owner())) ||
           job.simulate().plan_job() == facts.plan_job ||
           job.dip_status().plan_job() == facts.plan_job;
  });
  if (attempts.empty() || is_done(*attempts.front())) return;
  const v1::Job& newest = *attempts.front();
  if (newest.has_capture() || newest.has_calibrate()) dip.set_trouble(ending_of(newest));
}

}  // namespace

v1::PlanProgress progress_of(const PlanFacts& facts) {
  v1::PlanProgress out;
  out.set_plan_job(facts.plan_job);
  int most = 0;
  for (int k = 1; k <= facts.spec.immersions_size(); ++k) {
    Dip& dip = *out.add_dips();
    dip = DipSteps(facts, k).find_all();
    if (urgency(dip) <= most) continue;
    most = urgency(dip);
    out.set_next_immersion(k);
  }
  if (out.next_immersion() == 0) return out;
  Dip& next = *out.mutable_dips(out.next_immersion() - 1);
  if (next.step() == v1::PlanProgress::CALIBRATE && !wait_for_calibration(facts, next))
    tell_failed_calibration(facts, next);
  return out;
}

}  // namespace hydroprint::daemon
