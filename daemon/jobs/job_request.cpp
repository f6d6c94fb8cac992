#include "daemon/jobs/job_request.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <memory>

#include "daemon/jobs/field_check.h"
#include "daemon/jobs/registry.h"
#include "daemon/jobs/spec_files.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::Message;

/// Checks all fields of a job by their rules, using the resolved spec instead of the original one.
Status check_all_fields(const JobKind& kind, const v1::Job& job, const Message& resolved) {
  v1::Job filled = job;
  filled.GetReflection()->MutableMessage(&filled, &kind.field())->CopyFrom(resolved);
  HP_RETURN_IF_ERROR(check_fields(filled));
  if (!job.labels().contains("")) return {};
  return invalid_field("labels", "have an empty key; give each label a key");
}

/// Removes the number of threads from the spec and returns it. It is an option of the pool and does
/// not change the result.
std::int32_t take_threads(Message& spec) {
  const auto* const field = spec.GetDescriptor()->FindFieldByName("threads");
  if (field == nullptr) return 0;
  const std::int32_t threads = spec.GetReflection()->GetInt32(spec, field);
  spec.GetReflection()->ClearField(&spec, field);
  return threads;
}

Result<std::string> json_of(const Message& spec) {
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(spec, &json);
  if (status.ok()) return json;
  return fail(Code::kInvalidArgument,
              fmt::format("{}: cannot be written as JSON: {}", spec.GetTypeName(),
                          std::string(status.message())),
              ErrorReason::SPEC_INVALID);
}

Result<NewJob> new_job(const JobKind& kind, const v1::Job& job, const Message& shown,
                       std::unique_ptr<Message> resolved) {
  HP_RETURN_IF_ERROR(check_all_fields(kind, job, *resolved));
  HP_RETURN_IF_ERROR(kind.check(*resolved));
  NewJob definition;
  definition.work.verb = kind.name();
  HP_ASSIGN_OR_RETURN(definition.work.inputs, input_files(*resolved, kind.field().name()));
  definition.threads = take_threads(*resolved);
  HP_ASSIGN_OR_RETURN(definition.work.spec, json_of(*resolved));
  definition.traits = kind.traits();
  definition.use_cache = kind.is_cacheable();
  definition.priority = job.priority();
  definition.display_name = job.display_name();
  if (definition.display_name.empty()) {
    const std::string subject = kind.subject(shown);
    definition.display_name = subject.empty() ? kind.name() : kind.name() + " " + subject;
  }
  return definition;
}

std::unique_ptr<Message> copy_of(const Message& message) {
  std::unique_ptr<Message> copy(message.New());
  copy->CopyFrom(message);
  return copy;
}

}  // namespace

Result<JobRequest> job_request(const JobKind& kind, const v1::Job& sent,
                               const JobSources& sources) {
  HP_RETURN_IF_ERROR(check_fields(sent));
  JobRequest out;
  out.job.set_display_name(sent.display_name());
  *out.job.mutable_labels() = sent.labels();
  Message& shown = *out.job.GetReflection()->MutableMessage(&out.job, &kind.field());
  shown.CopyFrom(*spec_of(sent));
  auto resolved = copy_of(shown);
  HP_RETURN_IF_ERROR(kind.resolve(shown, *resolved, sources));
  HP_ASSIGN_OR_RETURN(out.definition, new_job(kind, sent, shown, std::move(resolved)));
  out.definition.body = out.job.SerializeAsString();
  return out;
}

Result<NewJob> check_job(const v1::Job& job) {
  HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(job));
  const Message& spec = *spec_of(job);
  return new_job(*kind, job, spec, copy_of(spec));
}

}  // namespace hydroprint::daemon
