#pragma once

#include <nlohmann/json.hpp>

#include "client/artifacts.h"
#include "client/assets.h"
#include "client/calibration.h"
#include "client/job.h"
#include "client/lease.h"
#include "client/queue.h"
#include "client/rig.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// The output of --json: the API's field names, RFC 3339 times; unset fields are omitted.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json to_json(const client::Spec& spec);
[[nodiscard]] Json to_json(const client::Job& job);
[[nodiscard]] Json to_json(const client::DipSpec& spec);
[[nodiscard]] Json to_json(const client::DipStatus& status);
[[nodiscard]] Json to_json(const client::JobEvent& event);
[[nodiscard]] Json to_json(const client::Lease& lease);
[[nodiscard]] Json to_json(const client::Rig& rig);
[[nodiscard]] Json to_json(const client::Queue& queue);
[[nodiscard]] Json to_json(const client::Asset& asset);
[[nodiscard]] Json to_json(const client::Artifact& artifact);
[[nodiscard]] Json to_json(const client::Calibration& calibration);
[[nodiscard]] Json to_json(const Error& error);

/// Converts a list to a JSON array.
template <class T>
[[nodiscard]] Json to_json(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

/// Prints JSON in readable form: one key per line, list items one below the other.
void print_tree(const Json& json, const std::string& indent = "");

/// Prints JSON on one line of standard output.
void print(const Json& json);

}  // namespace hydroprint::cli
