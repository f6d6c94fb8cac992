// Prints random requests and answers for every route of the API, one JSON object per line, for
// check_openapi.py to validate against the document.
#include <google/protobuf/descriptor.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/rest/answer.h"
#include "daemon/rest/bad_request.h"
#include "daemon/rest/transcoder.h"
#include "tests/daemon/rest/requests.h"

namespace {

using namespace hydroprint;
using nlohmann::json;

constexpr int kDraws = 12;

// A random request and answer; draw 0 has empty messages.
json sample_of(const rest::Transcoder& transcoder, const rest::Route& route, std::mt19937& random,
               int draw) {
  const auto& method = *route.method;
  const auto message = draw == 0 ? rest::new_message(*method.input_type())
                                 : rest::random_message(*method.input_type(), random, draw % 4);
  const rest::Sent request = rest::sent(route, *message, random);
  const auto call = transcoder.read(route.http_method, request.target, request.body);
  if (!call) throw std::runtime_error(request.target + ": " + call.error().message);
  const auto answer = draw == 0 ? rest::new_message(*method.output_type())
                                : rest::random_message(*method.output_type(), random, draw % 4);
  const auto text = transcoder.write(call->method, answer->SerializeAsString());
  if (!text) throw std::runtime_error(text.error().message);
  json sample = {{"operation", method.name()},
                 {"method", route.http_method},
                 {"target", request.target},
                 {"streams", call->streams},
                 {"answer", json::parse(*text)}};
  const auto raw = transcoder.raw_body(call->method, answer->SerializeAsString());
  if (!raw) throw std::runtime_error(raw.error().message);
  if (*raw) sample["media_type"] = (*raw)->media_type;
  if (!request.body.empty()) sample["body"] = json::parse(request.body);
  return sample;
}

}  // namespace

int main() {
  const auto transcoder = rest::Transcoder::make();
  const auto routes = rest::read_routes(rest::api_services());
  if (!transcoder || !routes) return 4;
  std::mt19937 random(5);
  for (const rest::Route& route : *routes) {
    for (int i = 0; i < kDraws; ++i) {
      std::cout << sample_of(*transcoder, route, random, i).dump() << '\n';
    }
  }
  const Error wrong =
      rest::bad_request({{"simulate.dpi", "is too large", ErrorReason::SPEC_INVALID},
                         {"simulate.film", "is unknown", ErrorReason::SPEC_INVALID}});
  std::cout << json{{"error", json::parse(rest::error_answer(wrong).json)}}.dump() << '\n';
  const Error full{
      Code::kResourceExhausted, "too many jobs", ErrorReason::QUEUE_FULL, {{"max", "7"}}};
  std::cout << json{{"error", json::parse(rest::error_answer(full).json)}}.dump() << '\n';
  std::cout << json{{"error", json::parse(rest::error_answer(14, "gone", "").json)}}.dump() << '\n';
}
