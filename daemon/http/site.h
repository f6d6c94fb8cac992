#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "daemon/http/artifact_target.h"
#include "daemon/http/connections.h"
#include "daemon/http/counters.h"
#include "daemon/http/exchange.h"
#include "daemon/http/io.h"
#include "daemon/http/rpc.h"
#include "daemon/http/server.h"
#include "daemon/http/static_files.h"
#include "daemon/rest/security.h"
#include "daemon/rest/transcoder.h"

namespace hydroprint::http {

/// What all requests are answered from; outlives them.
struct Site {
  Options options;
  Sources sources;
  Io& io;
  Rpc rpc;
  rest::Transcoder transcoder;
  std::string openapi;
  StaticFiles files;
  Connections connections;
  Counters counters;
  std::atomic<int> asides{0};  // what waits for the thread that may wait
};

/// Answers the requests of one connection, one after the other, until either side ends it.
Detached serve(Site& site, std::shared_ptr<Socket> socket);
/// Says that there are too many connections, and ends this one.
Detached turn_away(Site& site, std::shared_ptr<Socket> socket);

// Each answers one request, and gives the name under which it is counted.
[[nodiscard]] Task<std::string> answer(Site& site, Exchange& exchange);
[[nodiscard]] Task<std::string> answer_call(Site& site, Exchange& exchange);
[[nodiscard]] Task<std::string> answer_upload(Site& site, Exchange& exchange);
[[nodiscard]] Task<std::string> answer_file(Site& site, Exchange& exchange);
[[nodiscard]] Task<std::string> answer_health(Site& site, Exchange& exchange);
[[nodiscard]] Task<std::string> answer_metrics(Site& site, Exchange& exchange);
/// A stream of messages as server-sent events.
[[nodiscard]] Task<void> answer_events(Site& site, Exchange& exchange, rest::Call call);
/// The bytes of an artifact.
[[nodiscard]] Task<std::string> answer_download(Site& site, Exchange& exchange,
                                                ArtifactTarget target);

/// Answers with a refusal.
[[nodiscard]] Task<bool> refuse(Exchange& exchange, Error error, std::optional<int> status = {});

/// What the services are told of the caller: authorization, hydroprint-owner, hydroprint-session,
/// hydroprint-peer. Refuses (SPEC_INVALID) what is not printable ASCII.
[[nodiscard]] Result<Rpc::Metadata> metadata_of(const Head& head, const std::string& peer);

using rest::kSessionCookie;
/// The value of a cookie.
[[nodiscard]] std::optional<std::string_view> cookie(const Fields& fields, std::string_view name);

/// Refuses (kPermissionDenied, CSRF_TOKEN_MISSING) what would change something for a browser that
/// is signed in, unless it comes from a page that knows the session's token (WhoAmI tells it).
[[nodiscard]] Status check_csrf(const Head& head);

/// What Set-Cookie has to say after a call: of SignIn the session, which is taken out of the
/// answer, as scripts have no business with it; of SignOut its end; of others none.
/// @param is_secure  the browser is to send it by TLS alone
[[nodiscard]] std::optional<std::string> take_session(const std::string& method,
                                                      std::string& response, bool is_secure);

/// Calls and waits for the answer; who goes away meanwhile cancels the call.
[[nodiscard]] Task<Reply> call(Site& site, Exchange& exchange, rest::Call call,
                               Rpc::Metadata metadata);

/// A reply that is none of success.
[[nodiscard]] Response refusal(const Reply& reply);

}  // namespace hydroprint::http
