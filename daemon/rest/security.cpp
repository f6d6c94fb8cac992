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
        {"description", "For scripts: an API key from CreateApiKey."}}},
      {kSession,
       {{"type", "apiKey"},
        {"in", "cookie"},
        {"name", kSessionCookie},
        {"description",
         "For browsers: the session cookie that SignIn sets. While there are no users, callers on\n"
         "the daemon's own machine need neither key nor cookie."}}},
      {kCsrf,
       {{"type", "apiKey"},
        {"in", "header"},
        {"name", kCsrfHeader},
        {"description",
         "`csrfToken` from SignIn or WhoAmI; required with a session for requests that make "
         "changes."}}}};
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
