#include "daemon/rest/openapi/error_schema.h"

#include <string>

#include "hydroprint/v1/error_reason.pb.h"

namespace hydroprint::rest {
namespace {

using Json = nlohmann::ordered_json;

Json text(const std::string& description) {
  return {{"type", "string"}, {"description", description}};
}

// Returns the schema of the messages in google.rpc's error_details.proto that errors contain.
Json detail_schema(Schemas& schemas) {
  const Json names = schemas.reference(*v1::ErrorReason_descriptor());
  const Json reason = {{"anyOf", Json::array({names, {{"type", "string"}}})},
                       {"description", "Stable reason for programs; in an ErrorInfo."}};
  const Json metadata = {
      {"type", "object"},
      {"additionalProperties", {{"type", "string"}}},
      {"description", "Values from the message, for programs; in an ErrorInfo."}};
  const Json violation = {
      {"type", "object"},
      {"properties",
       {{"field", text("Path of the field: \"simulate.dpi\".")},
        {"description", text("The problem: \"must be from 20 to 2400 dots per inch\".")}}},
      {"required", Json::array({"field", "description"})}};
  const Json violations = {{"type", "array"},
                           {"items", violation},
                           {"description", "All wrong fields of the request; in a BadRequest."}};
  return {{"type", "object"},
          {"description", "Further details, for programs."},
          {"properties",
           {{"@type",
             text("Type of the google.rpc message: \"type.googleapis.com/google.rpc.ErrorInfo\".")},
            {"reason", reason},
            {"domain", text("\"hydroprint\"; in an ErrorInfo.")},
            {"metadata", metadata},
            {"fieldViolations", violations},
            {"retryDelay", text("Time to wait before a retry: \"10s\"; in a RetryInfo.")}}},
          {"required", Json::array({"@type"})},
          {"additionalProperties", true}};
}

}  // namespace

Json error_schema(Schemas& schemas) {
  const Json code = {{"type", "integer"}, {"format", "int32"}, {"description", "The HTTP status."}};
  const Json error = {{"type", "object"},
                      {"properties",
                       {{"code", code},
                        {"message", text("One line: the fault, its place and the remedy.")},
                        {"status", text("Name of the google.rpc.Code: \"NOT_FOUND\".")},
                        {"details", {{"type", "array"}, {"items", detail_schema(schemas)}}}}},
                      {"required", Json::array({"code", "message", "status", "details"})}};
  return {{"type", "object"},
          {"description", "An error (AIP-193)."},
          {"properties", {{"error", error}}},
          {"required", Json::array({"error"})}};
}

}  // namespace hydroprint::rest
