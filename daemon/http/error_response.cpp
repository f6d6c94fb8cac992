#include "daemon/http/error_response.h"

#include <utility>

#include "daemon/rest/answer.h"

namespace hydroprint::http {

Task<bool> refuse(Exchange& exchange, Error error, std::optional<int> status) {
  co_return co_await exchange.send(refusal(error, status));
}

Response refusal(const Reply& reply) {
  rest::Answer answer = rest::error_answer(reply.code, reply.message, reply.details);
  return json_response(answer.http_status, std::move(answer.json));
}

}  // namespace hydroprint::http
