#pragma once

#include "client/cli/format/json.h"
#include "client/people.h"

namespace hydroprint::cli {

[[nodiscard]] Json to_json(const client::Identity& me);
[[nodiscard]] Json to_json(const client::Usage& usage);
[[nodiscard]] Json to_json(const client::User& user);
[[nodiscard]] Json to_json(const client::ApiKey& key);
[[nodiscard]] Json to_json(const client::Session& session);
[[nodiscard]] Json to_json(const client::AuditEntry& entry);

/// Converts a list to a JSON array.
template <class T>
[[nodiscard]] Json array_json(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

}  // namespace hydroprint::cli
