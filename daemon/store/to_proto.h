#pragma once

#include <google/protobuf/timestamp.pb.h>

#include <string>

#include "daemon/store/asset.h"
#include "daemon/store/job.h"
#include "hydroprint/v1/artifact_service.pb.h"
#include "hydroprint/v1/asset_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/sha256.h"

namespace hydroprint::daemon {

/// Convert Unix time in ms to the API's timestamp, and to text ("2026-11-22T02:05:39Z").
[[nodiscard]] google::protobuf::Timestamp time_of(std::int64_t ms);
[[nodiscard]] std::string time_text(std::int64_t ms);

/// Converts stored data to API messages.
[[nodiscard]] v1::Job to_message(const Job& job);
[[nodiscard]] v1::JobEvent to_message(const JobEvent& event);
[[nodiscard]] v1::Artifact to_message(std::int64_t job, const Artifact& artifact);
[[nodiscard]] v1::Asset to_message(const Asset& asset);
[[nodiscard]] v1::Upload to_message(const Upload& upload);

/// Returns the spec of a job of any kind; null if the job has none.
[[nodiscard]] const google::protobuf::Message* spec_of(const v1::Job& job);

/// Returns the key of a request: SHA-256 of its content without request_id, to distinguish a
/// repeated request from a different one.
template <class Request>
[[nodiscard]] RequestKey request_key(const char* method, const Request& request);

/// Serialises equal messages to equal bytes (maps are sorted).
[[nodiscard]] std::string deterministic_bytes(const google::protobuf::Message& message);

template <class Request>
RequestKey request_key(const char* method, const Request& request) {
  Request content = request;
  content.clear_request_id();
  return {method, request.request_id(), sha256(deterministic_bytes(content))};
}

}  // namespace hydroprint::daemon
