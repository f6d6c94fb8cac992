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

/// What --json prints: the API's field names, RFC 3339 times; a field that is not set is left out.
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

/// An array of them.
template <class T>
[[nodiscard]] Json to_json(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

/// Prints it for people: one key a line, lists one below the other.
void print_tree(const Json& json, const std::string& indent = "");

/// Prints one line of JSON to standard output.
void print(const Json& json);

}  // namespace hydroprint::cli
