#include "daemon/rest/security.h"

namespace hydroprint::rest {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kApiKey = "apiKey";
constexpr const char* kSession = "session";
constexpr const char* kCsrf = "csrf";

}  // namespace

Json security_schemes() {
  return {
      {kApiKey,
       {{"type", "http"},
        {"scheme", "bearer"},
        {"bearerFormat", "hp_ID_SECRET"},
        {"description", "For scripts: an API key, which CreateApiKey makes."}}},
      {kSession,
       {{"type", "apiKey"},
        {"in", "cookie"},
        {"name", kSessionCookie},
        {"description",
         "For browsers: what SignIn sets. While there are no users, nobody on the daemon's own\n"
         "machine needs either."}}},
      {kCsrf,
       {{"type", "apiKey"},
        {"in", "header"},
        {"name", kCsrfHeader},
        {"description",
         "`csrfToken` of SignIn or WhoAmI; needed with a session where something is changed."}}}};
}

Json security_of(bool is_open, const std::string& http_method) {
  if (is_open) return Json::array();
  const bool is_safe = http_method == "GET" || http_method == "HEAD";
  const Json none = Json::array();
  Json session = {{kSession, none}};
  if (!is_safe) session[kCsrf] = none;
  return Json::array({Json{{kApiKey, none}}, session});
}

}  // namespace hydroprint::rest
