#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/calibration.h"
#include "daemon/job.h"

namespace hydroprint::v1 {
class Calibration;
}

namespace hydroprint::daemon {

/// The calibration that a calibrate or calibrate-camera job leaves, of its spec and of what its
/// worker wrote, trusting nothing in that; none of other jobs.
/// @param artifacts  the folder of the job's
/// @return kInternal, WORKER_UNUSABLE, naming the key that is missing or out of range
[[nodiscard]] Result<std::optional<NewCalibration>> calibration_of(
    const Job& job, const std::filesystem::path& artifacts);

/// What calibration.json says, as fields of a calibration. WORKER_UNUSABLE.
[[nodiscard]] Status read_calibration(const std::string& json, v1::Calibration& out);

}  // namespace hydroprint::daemon
