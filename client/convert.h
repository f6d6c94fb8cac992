#pragma once

// Private to this library: between the API's messages and its own values.

#include <optional>

#include "client/artifacts.h"
#include "client/assets.h"
#include "client/job.h"
#include "client/queue.h"
#include "hydroprint/v1/artifact_service.pb.h"
#include "hydroprint/v1/asset_service.pb.h"
#include "hydroprint/v1/job.pb.h"
#include "hydroprint/v1/queue_service.pb.h"

namespace hydroprint::client {

[[nodiscard]] Job from_proto(const ::hydroprint::v1::Job& message);
[[nodiscard]] JobEvent from_proto(const ::hydroprint::v1::JobEvent& message);
[[nodiscard]] Queue from_proto(const ::hydroprint::v1::Queue& message);
[[nodiscard]] Asset from_proto(const ::hydroprint::v1::Asset& message);
[[nodiscard]] Artifact from_proto(const ::hydroprint::v1::Artifact& message);

/// Sets the job's spec. @return kInvalidArgument for a model or artifact set that has no such name
[[nodiscard]] Status to_proto(const Spec& spec, ::hydroprint::v1::Job& job);

[[nodiscard]] ::hydroprint::v1::Job::State to_proto(JobState state);

}  // namespace hydroprint::client
