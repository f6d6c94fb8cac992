#include "daemon/jobs/registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

/// Lists the possible specs: "simulate, predict or fit".
std::string names_of_specs() {
  const auto& specs = *v1::Job::descriptor()->FindOneofByName("spec");
  std::string out;
  for (int i = 0; i < specs.field_count(); ++i) {
    const bool is_last = i + 1 == specs.field_count();
    out += (i == 0 ? "" : is_last ? " or " : ", ") + specs.field(i)->name();
  }
  return out;
}

template <class Predicate>
const JobKind* find_kind(const Predicate& is_wanted) {
  const auto& kinds = job_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), is_wanted);
  return found == kinds.end() ? nullptr : *found;
}

}  // namespace

Result<const JobKind*> kind_of(const v1::Job& job) {
  const JobKind* const kind = find_kind([&](const JobKind* candidate) {
    return candidate->field().number() == static_cast<int>(job.spec_case());
  });
  if (kind != nullptr) return kind;
  return invalid_field("job", "has no spec; set " + names_of_specs());
}

Result<const JobKind*> kind_of(const Job& job) {
  const std::string& name = job.definition.work.verb;
  const JobKind* const kind =
      find_kind([&](const JobKind* candidate) { return candidate->name() == name; });
  if (kind != nullptr) return kind;
  return fail(
      Code::kInternal,
      fmt::format(
          "{}: unknown job kind \"{}\"; use the version of hydroprintd that stored this job",
          job_name(job.id), name),
      ErrorReason::STORE_FAILED);
}

}  // namespace hydroprint::daemon
