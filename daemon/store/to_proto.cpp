#include "daemon/store/to_proto.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/time_util.h>

#include "daemon/platform/resource_names.h"
#include "daemon/rest/status.h"

namespace hydroprint::daemon {
namespace {

void set_times(const Job& job, v1::Job& out) {
  *out.mutable_create_time() = time_of(job.create_ms);
  *out.mutable_update_time() = time_of(job.update_ms);
  if (job.start_ms > 0) *out.mutable_start_time() = time_of(job.start_ms);
  if (job.end_ms > 0) *out.mutable_end_time() = time_of(job.end_ms);
  if (job.purge_ms > 0) *out.mutable_purge_time() = time_of(job.purge_ms);
  if (job.progress.eta_ms > 0 && job.state == JobState::kRunning) {
    *out.mutable_eta_time() = time_of(job.progress.eta_ms);
    out.set_eta_origin(job.dip_status.empty() ? v1::Job::WORKER : v1::Job::DIP);
  }
}

void set_error(const JobFailure& failure, v1::Failure& out) {
  out.set_code(static_cast<google::rpc::Code>(rest::number_of(failure.error.code)));
  out.set_reason(static_cast<v1::ErrorReason>(failure.error.reason));
  out.set_message(failure.error.message);
  out.set_field(failure.error.field);
  if (failure.exit_status) out.set_exit_status(*failure.exit_status);
  if (failure.signal) out.set_signal(*failure.signal);
}

}  // namespace

google::protobuf::Timestamp time_of(std::int64_t ms) {
  return google::protobuf::util::TimeUtil::MillisecondsToTimestamp(ms);
}

std::string time_text(std::int64_t ms) {
  return google::protobuf::util::TimeUtil::ToString(time_of(ms));
}

v1::Job to_message(const Job& job) {
  v1::Job out;
  out.ParseFromString(job.definition.body);  // display name, labels and spec
  if (job.id != 0) out.set_name(job_name(job.id));
  out.set_uid(job.uid);
  out.set_display_name(job.definition.display_name);
  out.set_owner(job.definition.owner);
  out.set_priority(job.definition.priority);
  out.set_state(static_cast<v1::Job::State>(job.state));
  out.set_progress_fraction(job.progress.fraction);
  out.set_phase(job.progress.phase);
  if (job.state == JobState::kRunning) out.set_waits_for(job.progress.waits_for);
  if (job.id != 0) set_times(job, out);
  out.set_etag(std::to_string(job.version));
  if (job.failure) set_error(*job.failure, *out.mutable_error());
  if (job.definition.retry_of != 0) out.set_retry_of(job_name(job.definition.retry_of));
  out.set_input_digest(job.definition.digest);
  out.set_cache_hit(job.cache_hit);
  out.set_shared(job.shared);
  out.set_pinned(job.pinned);
  if (!job.dip_status.empty()) out.mutable_dip_status()->ParseFromString(job.dip_status);
  return out;
}

v1::JobEvent to_message(const JobEvent& event) {
  v1::JobEvent out;
  out.set_seq(event.seq);
  *out.mutable_time() = time_of(event.time_ms);
  out.set_job(job_name(event.job));
  out.set_kind(static_cast<v1::JobEvent::Kind>(event.kind));
  out.set_state(static_cast<v1::Job::State>(event.state));
  out.set_progress_fraction(event.progress.fraction);
  out.set_phase(event.progress.phase);
  if (event.state == JobState::kRunning) out.set_waits_for(event.progress.waits_for);
  out.set_phase_fraction(event.progress.phase_fraction);
  if (event.progress.eta_ms > 0) *out.mutable_eta_time() = time_of(event.progress.eta_ms);
  out.set_message(event.message);
  return out;
}

v1::Artifact to_message(std::int64_t job, const Artifact& artifact) {
  v1::Artifact out;
  out.set_name(job_name(job) + "/artifacts/" + artifact.name);
  out.set_size_bytes(artifact.size_bytes);
  out.set_sha256(artifact.sha256);
  out.set_media_type(artifact.media_type);
  return out;
}

v1::Asset to_message(const Asset& asset) {
  v1::Asset out;
  out.set_name("assets/" + asset.sha256);
  out.set_sha256(asset.sha256);
  out.set_size_bytes(asset.size_bytes);
  out.set_media_type(asset.media_type);
  *out.mutable_create_time() = time_of(asset.create_ms);
  for (const std::string& owner : asset.owners) out.add_owners(owner);
  return out;
}

v1::Upload to_message(const Upload& upload) {
  v1::Upload out;
  out.set_name("uploads/" + upload.id);
  out.set_sha256(upload.sha256);
  out.set_size_bytes(upload.size_bytes);
  out.set_received_bytes(upload.received_bytes);
  *out.mutable_expire_time() = time_of(upload.expire_ms);
  return out;
}

const google::protobuf::Message* spec_of(const v1::Job& job) {
  const google::protobuf::Reflection& reflection = *job.GetReflection();
  const auto* const field =
      reflection.GetOneofFieldDescriptor(job, v1::Job::descriptor()->FindOneofByName("spec"));
  return field == nullptr ? nullptr : &reflection.GetMessage(job, field);
}

std::string deterministic_bytes(const google::protobuf::Message& message) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  return bytes;
}

}  // namespace hydroprint::daemon
