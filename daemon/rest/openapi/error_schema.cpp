#include "daemon/rest/openapi/error_schema.h"

#include <string>

#include "hydroprint/v1/error_reason.pb.h"

namespace hydroprint::rest {
namespace {

using Json = nlohmann::ordered_json;

Json text(const std::string& description) {
  return {{"type", "string"}, {"description", description}};
}

// One of google.rpc's error_details.proto.
Json detail_schema(Schemas& schemas) {
  const Json names = schemas.reference(*v1::ErrorReason_descriptor());
  const Json reason = {{"anyOf", Json::array({names, {{"type", "string"}}})},
                       {"description", "Stable word for programs; of an ErrorInfo."}};
  const Json metadata = {
      {"type", "object"},
      {"additionalProperties", {{"type", "string"}}},
      {"description", "The parts of the message that a program may want; of an ErrorInfo."}};
  const Json violation = {
      {"type", "object"},
      {"properties",
       {{"field", text("Path of the field: \"simulate.dpi\".")},
        {"description", text("The problem: \"must be from 20 to 2400 dots per inch\".")}}},
      {"required", Json::array({"field", "description"})}};
  const Json violations = {{"type", "array"},
                           {"items", violation},
                           {"description", "All wrong fields of the request; of a BadRequest."}};
  return {
      {"type", "object"},
      {"description", "More of it, for programs."},
      {"properties",
       {{"@type",
         text("Which message of google.rpc it is: \"type.googleapis.com/google.rpc.ErrorInfo\".")},
        {"reason", reason},
        {"domain", text("\"hydroprint\"; of an ErrorInfo.")},
        {"metadata", metadata},
        {"fieldViolations", violations},
        {"retryDelay", text("\"10s\": when to try again; of a RetryInfo.")}}},
      {"required", Json::array({"@type"})},
      {"additionalProperties", true}};
}

}  // namespace

Json error_schema(Schemas& schemas) {
  const Json code = {{"type", "integer"}, {"format", "int32"}, {"description", "The HTTP status."}};
  const Json error = {{"type", "object"},
                      {"properties",
                       {{"code", code},
                        {"message", text("One line: what, where, and what to do.")},
                        {"status", text("Name of the google.rpc.Code: \"NOT_FOUND\".")},
                        {"details", {{"type", "array"}, {"items", detail_schema(schemas)}}}}},
                      {"required", Json::array({"code", "message", "status", "details"})}};
  return {{"type", "object"},
          {"description", "Why something was not done (AIP-193)."},
          {"properties", {{"error", error}}},
          {"required", Json::array({"error"})}};
}

}  // namespace hydroprint::rest
