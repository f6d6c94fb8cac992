#include "client/connection/rpc.h"

#include <fmt/format.h>
#include <google/protobuf/any.pb.h>

#include <array>
#include <condition_variable>
#include <mutex>

#include "client/connection/tls_probe.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "sim/base/utf8.h"

namespace hydroprint::client {
namespace {

using namespace std::chrono_literals;

constexpr std::array kPauses{100ms, 300ms, 600ms};

Code to_code(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::CANCELLED:
      return Code::kCancelled;
    case grpc::StatusCode::INVALID_ARGUMENT:
      return Code::kInvalidArgument;
    case grpc::StatusCode::NOT_FOUND:
      return Code::kNotFound;
    case grpc::StatusCode::ALREADY_EXISTS:
      return Code::kAlreadyExists;
    case grpc::StatusCode::PERMISSION_DENIED:
      return Code::kPermissionDenied;
    case grpc::StatusCode::UNAUTHENTICATED:
      return Code::kUnauthenticated;
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return Code::kResourceExhausted;
    case grpc::StatusCode::FAILED_PRECONDITION:
      return Code::kFailedPrecondition;
    case grpc::StatusCode::ABORTED:
      return Code::kAborted;
    case grpc::StatusCode::OUT_OF_RANGE:
      return Code::kOutOfRange;
    case grpc::StatusCode::UNIMPLEMENTED:
      return Code::kUnimplemented;
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return Code::kUnavailable;
    case grpc::StatusCode::DATA_LOSS:
      return Code::kDataLoss;
    default:
      return Code::kInternal;
  }
}

void take_error_info(const google::rpc::Status& details, Error& error) {
  google::rpc::ErrorInfo info;
  for (const auto& detail : details.details()) {
    if (!detail.UnpackTo(&info)) continue;
    parse(info.reason(), error.reason);
    error.metadata = {info.metadata().begin(), info.metadata().end()};
    error.metadata.erase("field");  // see take_wrong_fields()
  }
}

void take_wrong_fields(const google::rpc::Status& details, Error& error) {
  google::rpc::BadRequest request;
  for (const auto& detail : details.details()) {
    if (!detail.UnpackTo(&request)) continue;
    if (request.field_violations_size() == 1) {
      error.field = request.field_violations(0).field();
      error.message = one_line(request.field_violations(0).description());
      continue;
    }
    std::string& lines = error.metadata[kWrongFields];
    for (const auto& violation : request.field_violations()) {
      lines += (lines.empty() ? "" : "\n") + one_line(violation.field()) + "\t" +
               one_line(violation.description());
    }
  }
}

}  // namespace

Call::Call(Connection& connection)
    : on_stop_(connection.options().stop, [this] { context_.TryCancel(); }) {
  const ConnectionOptions& options = connection.options();
  if (!options.owner.empty()) context_.AddMetadata("hydroprint-owner", options.owner);
  if (!connection.impl().keeps_secrets) return;
  if (!options.api_key.empty()) context_.AddMetadata("authorization", "Bearer " + options.api_key);
  if (!options.session.empty()) context_.AddMetadata("hydroprint-session", options.session);
}

Call::Call(Connection& connection, std::chrono::milliseconds limit) : Call(connection) {
  context_.set_deadline(std::chrono::system_clock::now() + limit);
}

Error to_error(const Connection& connection, const grpc::Status& status) {
  const ConnectionOptions& options = connection.options();
  if (options.stop.stop_requested() && status.error_code() == grpc::StatusCode::CANCELLED)
    return {Code::kCancelled, "interrupted", {}};
  Error error{to_code(status.error_code()), one_line(status.error_message()), {}};
  google::rpc::Status details;
  if (details.ParseFromString(status.error_details())) {
    take_error_info(details, error);
    take_wrong_fields(details, error);
  }
  if (error.code == Code::kUnavailable && error.reason == ErrorReason{}) {
    if (const std::string trouble = tls_trouble(options); !trouble.empty()) {
      return {Code::kFailedPrecondition, options.server + ": " + trouble, {}};
    }
    // If no server listens, gRPC's own message adds nothing useful and varies between versions.
    const bool usual = error.message.find("failed to connect") != std::string::npos;
    error.message = fmt::format(
        "{}: hydroprintd does not respond{}; start it, or correct the address (--server host:port)",
        options.server, usual ? "" : fmt::format(" ({})", error.message));
  }
  return error;
}

grpc::Status with_retries(Connection& connection, const std::function<grpc::Status()>& attempt) {
  for (const auto& time : kPauses) {
    grpc::Status status = attempt();
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE) return status;
    if (connection.options().stop.stop_requested()) return status;
    if (connection.impl().channel->GetState(true) == GRPC_CHANNEL_READY) {
      pause(connection, time);
    } else {
      wait_for_connection(connection, time);
    }
  }
  return attempt();
}

void wait_for_connection(Connection& connection, std::chrono::milliseconds time) {
  connection.impl().channel->WaitForConnected(std::chrono::system_clock::now() + time);
}

void pause(const Connection& connection, std::chrono::milliseconds time) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any().wait_for(lock, connection.options().stop, time,
                                         [] { return false; });
}

}  // namespace hydroprint::client
