#pragma once

#include "daemon/job.h"

namespace hydroprint::v1 {
class CalibrateCameraSpec;
class CalibrateSpec;
class FitSpec;
class PredictSpec;
class PrintImageSpec;
class SimulateSpec;
class TemplateSpec;
class ValidateSpec;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

// What a worker has to do for a spec: its flags and files. Of `made` they set what is not part of
// the work: threads, and whether an earlier result will do. Refused as check_job says.

[[nodiscard]] Result<Work> work_of(const v1::SimulateSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::PredictSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::FitSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::ValidateSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::PrintImageSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::TemplateSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::CalibrateSpec& spec, NewJob& made);
[[nodiscard]] Result<Work> work_of(const v1::CalibrateCameraSpec& spec, NewJob& made);

}  // namespace hydroprint::daemon
