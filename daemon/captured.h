#pragma once

#include "daemon/asset_store.h"
#include "daemon/calibration_store.h"
#include "daemon/camera_setup.h"
#include "daemon/job_store.h"
#include "daemon/layout.h"

namespace hydroprint::v1 {
class Job;
}

namespace hydroprint::daemon {

/// What the jobs that calibrate are filled in from.
struct CapturedSources {
  JobStore& jobs;
  AssetStore& assets;
  CalibrationStore& calibrations;
  const CameraSetup& camera;
  Layout layout;
};

/// A calibrate or calibrate-camera job with the frames of its captures, the rig's layout, the
/// camera's lens and the gripper's height filled in; others as they are. Frames and lens become
/// assets, so that the job can be run again when the captures are gone.
/// @return SPEC_INVALID if what is to be taken is given, too, or nothing says it; ID_INVALID,
///   JOB_NOT_FOUND, STATE_FORBIDS as earlier_job(); CALIBRATION_MISSING; CONFIG_INVALID; what
///   AssetStore::adopt() refuses
[[nodiscard]] Result<v1::Job> with_captured(const v1::Job& job, const CapturedSources& from);

}  // namespace hydroprint::daemon
