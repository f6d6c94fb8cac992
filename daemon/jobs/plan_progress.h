#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job_service.pb.h"

namespace hydroprint::daemon {

/// A plan of several dips, and all jobs and calibrations from which its progress follows.
struct PlanFacts {
  std::string plan_job;  ///< "jobs/7"
  v1::PlanSpec spec;
  /// The owner of the plan and the caller. A capture of anyone else is not an attempt at this plan.
  std::set<std::string> owners;
  std::vector<v1::Job> jobs;              ///< newer than the plan, newest first
  std::optional<v1::Calibration> active;  ///< the active calibration of an object
  /// Calibrations with which films were computed, by name.
  std::map<std::string, v1::Calibration> calibrations;
  /// Warnings about differences from the plan, by simulate job.
  std::map<std::string, std::vector<v1::Warning>> warnings;
  bool has_camera = false;
};

/// Returns the progress of each dip, and the one to go on with.
///
/// A dip is done when one of its dip jobs has SUCCEEDED. Until then, a film counts if its simulate
/// job has SUCCEEDED and its calibration is still valid, because the object may hang otherwise now.
/// A calibration serves only one dip of the plan: it must be for the plan's object, scale and film,
/// and must not have served another dip. Its specs do not name the dip: a capture or calibration
/// that failed since the newest film or dip of the plan is trouble of the dip to go on with, as
/// long as that has to be calibrated.
[[nodiscard]] v1::PlanProgress progress_of(const PlanFacts& facts);

}  // namespace hydroprint::daemon
