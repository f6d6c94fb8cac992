#include "daemon/rest/answer.h"

#include <google/protobuf/util/json_util.h>

#include <nlohmann/json.hpp>

#include "daemon/rest/status.h"
#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace hydroprint::rest {
namespace {

using Json = nlohmann::ordered_json;

bool is_method_not_allowed(const google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  return status.details_size() > 0 && status.details(0).UnpackTo(&info) &&
         info.reason() == name_of(ErrorReason::METHOD_NOT_ALLOWED);
}

Json details_of(const google::rpc::Status& status) {
  Json details = Json::array();
  for (const auto& detail : status.details()) {
    std::string text;
    if (!google::protobuf::util::MessageToJsonString(detail, &text).ok()) continue;
    details.push_back(Json::parse(text));
  }
  return details;
}

}  // namespace

int http_status(int grpc_code) {
  switch (grpc_code) {
    case google::rpc::OK:
      return 200;
    case google::rpc::INVALID_ARGUMENT:
    case google::rpc::FAILED_PRECONDITION:
    case google::rpc::OUT_OF_RANGE:
      return 400;
    case google::rpc::UNAUTHENTICATED:
      return 401;
    case google::rpc::PERMISSION_DENIED:
      return 403;
    case google::rpc::NOT_FOUND:
      return 404;
    case google::rpc::ALREADY_EXISTS:
    case google::rpc::ABORTED:
      return 409;
    case google::rpc::RESOURCE_EXHAUSTED:
      return 429;
    case google::rpc::CANCELLED:
      return 499;
    case google::rpc::UNIMPLEMENTED:
      return 501;
    case google::rpc::UNAVAILABLE:
      return 503;
    case google::rpc::DEADLINE_EXCEEDED:
      return 504;
    default:
      return 500;
  }
}

Answer error_answer(int grpc_code, const std::string& message, const std::string& details) {
  google::rpc::Status status;
  if (!status.ParseFromString(details)) status.Clear();
  const int code = is_method_not_allowed(status) ? 405 : http_status(grpc_code);
  const bool exists = google::rpc::Code_IsValid(grpc_code);
  const Json error = {{"code", code},
                      {"message", message},
                      {"status", google::rpc::Code_Name(exists ? grpc_code : google::rpc::UNKNOWN)},
                      {"details", details_of(status)}};
  // Invalid UTF-8 in a message is replaced.
  return {code, Json{{"error", error}}.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Answer error_answer(const Error& error) {
  return error_answer(number_of(error.code), full_message(error), status_details(error));
}

}  // namespace hydroprint::rest
