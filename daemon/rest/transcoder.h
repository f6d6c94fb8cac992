#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// An RPC to be made for a request.
struct Call {
  std::string method;         ///< "/hydroprint.v1.JobService/CreateJob"
  bool streams = false;       ///< its answer is a stream of messages
  std::string request;        ///< the request message, serialised
  bool stops_motion = false;  ///< it is carried out even if the client leaves
};

/// HTTP requests as calls of the gRPC API, and its answers as JSON: by the google.api.http rules of
/// the .proto files and the proto3 JSON mapping, both taken strictly. Knows no socket. May be used
/// by any number of threads at once.
class Transcoder {
 public:
  /// Reads the routes of all services of package hydroprint.v1. Refused (kInternal): a service that
  /// is not linked in; two routes with the same HTTP method that some path matches both; a template
  /// that is none, or that names a field which does not exist, is repeated or is a message; a body
  /// on GET or DELETE, or one that is no message of the request; a rule on a call whose client
  /// streams; a request that holds Any, Struct, Value or ListValue.
  [[nodiscard]] static Result<Transcoder> make();

  /// The same of these services alone, by their full names.
  [[nodiscard]] static Result<Transcoder> make(const std::vector<std::string>& services);

  /// What a request asks for.
  /// @param target  path and query as in the request line, undecoded: "/v1/jobs?pageSize=2"
  /// @param body  bytes as sent, JSON; empty: none, which is the same as {}
  /// Refused: kNotFound, ROUTE_NOT_FOUND; kUnimplemented, METHOD_NOT_ALLOWED (methods_at() are
  /// allowed; HEAD is none unless a route says so); kInvalidArgument, with the field and the place,
  /// for all that is wrong in path or query (URL_INVALID, PARAMETER_INVALID) or body
  /// (JSON_INVALID). Of a call that stops motion, body and query are ignored.
  [[nodiscard]] Result<Call> read(std::string_view http_method, std::string_view target,
                                  std::string_view body) const;

  /// The API method that a request asks for, from its head alone: "/hydroprint.v1.JobService/GetJob".
  /// Refused: as read(), for all that is wrong in the path.
  [[nodiscard]] Result<std::string> method_of(std::string_view http_method,
                                              std::string_view target) const;

  /// Whether the request stops motion (access.proto). read() then ignores its body and its query.
  [[nodiscard]] bool stops_motion(std::string_view http_method, std::string_view target) const;

  /// HTTP methods that some route has at that path ("GET", "POST"), for Allow; empty: none.
  [[nodiscard]] std::vector<std::string> methods_at(std::string_view target) const;

  /// An answer as JSON (write_json() in json_text.h). Refused (kInternal): there is no such method,
  /// or that is not its answer.
  [[nodiscard]] Result<std::string> write(std::string_view method, std::string_view response) const;

  /// Of a stream whose messages carry a number `seq` and whose request takes `after_seq`: the text
  /// of `seq`; empty for others, and for a message in which it is optional and not set.
  [[nodiscard]] std::string event_id(std::string_view method, std::string_view response) const;

  /// The call that goes on after that event: its `after_seq` is the Last-Event-ID of the request,
  /// whatever the query says, since a browser repeats that when it comes back. Calls without it are
  /// returned as they are. Refused (kInvalidArgument, PARAMETER_INVALID): an id that event_id()
  /// cannot have given.
  [[nodiscard]] Result<Call> resume(Call call, std::string_view last_event_id) const;

 private:
  struct Impl;
  explicit Transcoder(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  std::shared_ptr<const Impl> impl_;
};

}  // namespace hydroprint::rest
