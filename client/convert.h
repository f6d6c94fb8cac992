#pragma once

// Private to this library: converts between the API's messages and the library's own types.

#include <optional>

#include "client/artifacts.h"
#include "client/assets.h"
#include "client/job.h"
#include "client/lease.h"
#include "client/queue.h"
#include "client/rig.h"
#include "hydroprint/v1/artifact_service.pb.h"
#include "hydroprint/v1/asset_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "hydroprint/v1/queue_service.pb.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::client {

/// Converts an optional field to std::optional.
template <class T>
[[nodiscard]] std::optional<T> given(bool is_set, const T& value) {
  return is_set ? std::optional<T>(value) : std::nullopt;
}

[[nodiscard]] Job from_proto(const ::hydroprint::v1::Job& message);
[[nodiscard]] JobEvent from_proto(const ::hydroprint::v1::JobEvent& message);
[[nodiscard]] Queue from_proto(const ::hydroprint::v1::Queue& message);
[[nodiscard]] Asset from_proto(const ::hydroprint::v1::Asset& message);
[[nodiscard]] Artifact from_proto(const ::hydroprint::v1::Artifact& message);
[[nodiscard]] std::optional<PoseSpec> pose_from_proto(const ::hydroprint::v1::Pose& pose);
[[nodiscard]] DipSpec from_proto(const ::hydroprint::v1::DipSpec& message);
[[nodiscard]] DipStatus from_proto(const ::hydroprint::v1::DipStatus& message);
[[nodiscard]] Lease from_proto(const ::hydroprint::v1::Lease& message);
[[nodiscard]] Rig from_proto(const ::hydroprint::v1::Rig& message);

/// Converts a timestamp to the clock's resolution; nullopt if it is not set.
[[nodiscard]] std::optional<Time> from_proto(bool is_set,
                                             const ::google::protobuf::Timestamp& time);

/// Sets the job's spec. @return kInvalidArgument for an unknown model or artifact set
[[nodiscard]] Status to_proto(const Spec& spec, ::hydroprint::v1::Job& job);

[[nodiscard]] ::hydroprint::v1::Job::State to_proto(JobState state);

[[nodiscard]] ::hydroprint::v1::Pose pose_to_proto(const PoseSpec& pose);
[[nodiscard]] ::hydroprint::v1::DipSpec to_proto(const DipSpec& spec);
[[nodiscard]] ::hydroprint::v1::DipStatus::Step to_proto(DipStep step);

}  // namespace hydroprint::client
