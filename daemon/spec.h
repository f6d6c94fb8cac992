#pragma once

#include <string>

#include "daemon/job.h"

namespace hydroprint::v1 {
class Calibration;
class Job;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

/// Checks what a client sent as a job (see proto/hydroprint/v1/spec.proto for what is refused) and
/// translates it for the worker. Sets all of NewJob but owner, digest, retry_of and use_cache.
/// @return kInvalidArgument: SPEC_INVALID (metadata field), NAME_INVALID, ID_INVALID
[[nodiscard]] Result<NewJob> check_job(const v1::Job& job);

/// What of a calibration that was entered by hand its sender decides, checked in the same way; the
/// rest is left out.
[[nodiscard]] Result<v1::Calibration> check_calibration(const v1::Calibration& entered);

/// What of a job the client decides, serialised always in the same way.
[[nodiscard]] std::string body_of(const v1::Job& job);

}  // namespace hydroprint::daemon
