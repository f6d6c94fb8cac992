#pragma once

#include <string_view>
#include <vector>

#include "daemon/jobs/kind.h"

namespace hydroprint::daemon {

/// Returns all job kinds. CMake generates the list from the files in daemon/jobs/kinds; for
/// example, `kinds/print_image.cpp` defines `const JobKind& print_image_kind()`.
[[nodiscard]] const std::vector<const JobKind*>& job_kinds();

/// Returns the kind of a job that a client sent; SPEC_INVALID if it has no spec.
[[nodiscard]] Result<const JobKind*> kind_of(const v1::Job& job);

/// Returns the kind of a stored job, by its verb; kInternal, STORE_FAILED if this daemon has no
/// such kind.
[[nodiscard]] Result<const JobKind*> kind_of(const Job& job);

}  // namespace hydroprint::daemon
