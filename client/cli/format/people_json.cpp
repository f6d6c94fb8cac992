#include "client/cli/format/people_json.h"

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

void put_time(Json& json, const char* key, const std::optional<client::Time>& time) {
  if (time) json[key] = format_rfc3339(*time);
}

}  // namespace

Json to_json(const client::Identity& me) {
  return {{"user", me.user}, {"role", me.role}, {"via", me.via}, {"accounts", me.accounts}};
}

Json to_json(const client::Usage& usage) {
  return {{"queued_jobs", usage.queued_jobs},
          {"max_queued_jobs", usage.max_queued_jobs},
          {"stored_bytes", usage.stored_bytes},
          {"max_stored_bytes", usage.max_stored_bytes},
          {"pinned_bytes", usage.pinned_bytes}};
}

Json to_json(const client::User& user) {
  Json json{{"name", user.name},
            {"role", user.role},
            {"disabled", user.disabled},
            {"has_password", user.has_password}};
  put_time(json, "create_time", user.create_time);
  return json;
}

Json to_json(const client::ApiKey& key) {
  Json json{{"name", key.name},
            {"user", key.user},
            {"display_name", key.display_name},
            {"role", key.role}};
  put_time(json, "create_time", key.create_time);
  put_time(json, "expire_time", key.expire_time);
  put_time(json, "use_time", key.use_time);
  return json;
}

Json to_json(const client::Session& session) {
  Json json{{"name", session.name}, {"user", session.user}};
  put_time(json, "create_time", session.create_time);
  put_time(json, "use_time", session.use_time);
  put_time(json, "expire_time", session.expire_time);
  json["peer"] = session.peer;
  json["current"] = session.current;
  return json;
}

Json to_json(const client::AuditEntry& entry) {
  Json json;
  put_time(json, "time", entry.time);
  json.update({{"who", entry.who},
               {"via", entry.via},
               {"peer", entry.peer},
               {"what", entry.what},
               {"object", entry.object},
               {"outcome", entry.outcome},
               {"detail", entry.detail}});
  return json;
}

}  // namespace hydroprint::cli
