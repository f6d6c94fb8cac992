#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// The RPC that corresponds to an HTTP request.
struct Call {
  std::string method;         ///< "/hydroprint.v1.JobService/CreateJob"
  bool streams = false;       ///< the response is a stream of messages
  std::string request;        ///< the request message, serialised
  bool stops_motion = false;  ///< the call is completed even if the client disconnects
};

/// The bytes of a response that is not JSON.
struct RawBody {
  std::string media_type;
  std::string bytes;
};

/// Translates HTTP requests to calls of the gRPC API, and responses to JSON. Follows the
/// google.api.http rules of the .proto files and the proto3 JSON mapping strictly. Does no I/O.
/// Thread-safe.
class Transcoder {
 public:
  /// Reads the routes of all services of package hydroprint.v1. Returns kInternal for:
  /// - a service that is not linked in;
  /// - two routes with the same HTTP method that match the same path;
  /// - an invalid template, or one that names an unknown, repeated or message field;
  /// - a body on GET or DELETE, or a body field that is not a message of the request;
  /// - a rule on a call with client streaming;
  /// - a request that contains Any, Struct, Value or ListValue.
  [[nodiscard]] static Result<Transcoder> make();

  /// Same as make(), but only for the services with these full names.
  [[nodiscard]] static Result<Transcoder> make(const std::vector<std::string>& services);

  /// Finds the call that a request asks for. For a call that stops motion, body and query are
  /// ignored.
  /// @param target  path and query as in the request line, undecoded: "/v1/jobs?pageSize=2"
  /// @param body  JSON as sent; an empty body means {}
  /// Errors:
  /// - kNotFound, ROUTE_NOT_FOUND;
  /// - kUnimplemented, METHOD_NOT_ALLOWED: methods_at() lists the allowed methods; HEAD needs a
  ///   route of its own;
  /// - kInvalidArgument, with field and place: URL_INVALID or PARAMETER_INVALID for path and query,
  ///   JSON_INVALID for the body.
  [[nodiscard]] Result<Call> read(std::string_view http_method, std::string_view target,
                                  std::string_view body) const;

  /// Returns the API method that a request asks for, from its head alone:
  /// "/hydroprint.v1.JobService/GetJob". Errors: those of read() that concern the path.
  [[nodiscard]] Result<std::string> method_of(std::string_view http_method,
                                              std::string_view target) const;

  /// Returns whether the request stops motion (access.proto). If it does, read() ignores its body
  /// and its query.
  [[nodiscard]] bool stops_motion(std::string_view http_method, std::string_view target) const;

  /// Returns the HTTP methods of the routes with that path ("GET", "POST"), for the Allow header.
  [[nodiscard]] std::vector<std::string> methods_at(std::string_view target) const;

  /// Converts a response to JSON (proto/write_json.h). Returns kInternal for an unknown method or a
  /// response of another type.
  [[nodiscard]] Result<std::string> write(std::string_view method, std::string_view response) const;

  /// Returns the body of a response that is not JSON (raw_answer in access.proto); nullopt for all
  /// others. Returns kInternal for a response of another type.
  [[nodiscard]] Result<std::optional<RawBody>> raw_body(std::string_view method,
                                                        std::string_view response) const;

  /// Returns a message's `seq` as text, for a stream whose messages have a number `seq` and whose
  /// request has `after_seq`. Empty for other streams, and if an optional `seq` is not set.
  [[nodiscard]] std::string event_id(std::string_view method, std::string_view response) const;

  /// Continues a stream after an event: sets the call's `after_seq` to the request's Last-Event-ID.
  /// This overrides the query, because a browser repeats the query when it reconnects. A call
  /// without `after_seq` is returned unchanged. Returns kInvalidArgument, PARAMETER_INVALID for an
  /// id that event_id() cannot have returned.
  [[nodiscard]] Result<Call> resume(Call call, std::string_view last_event_id) const;

 private:
  struct Impl;
  explicit Transcoder(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  std::shared_ptr<const Impl> impl_;
};

}  // namespace hydroprint::rest
