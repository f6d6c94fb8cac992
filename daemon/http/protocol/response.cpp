#include "daemon/http/protocol/response.h"

#include <fmt/format.h>

#include <array>
#include <ctime>

#include "daemon/rest/answer.h"

namespace hydroprint::http {
namespace {

const char* phrase_of(int status) {
  static constexpr std::array<std::pair<int, const char*>, 27> kPhrases{{
      {200, "OK"},
      {204, "No Content"},
      {206, "Partial Content"},
      {302, "Found"},
      {304, "Not Modified"},
      {400, "Bad Request"},
      {401, "Unauthorized"},
      {403, "Forbidden"},
      {404, "Not Found"},
      {405, "Method Not Allowed"},
      {408, "Request Timeout"},
      {409, "Conflict"},
      {411, "Length Required"},
      {412, "Precondition Failed"},
      {413, "Content Too Large"},
      {415, "Unsupported Media Type"},
      {416, "Range Not Satisfiable"},
      {421, "Misdirected Request"},
      {429, "Too Many Requests"},
      {431, "Request Header Fields Too Large"},
      {499, "Client Closed Request"},
      {500, "Internal Server Error"},
      {501, "Not Implemented"},
      {503, "Service Unavailable"},
      {504, "Gateway Timeout"},
      {505, "HTTP Version Not Supported"},
      {507, "Insufficient Storage"},
  }};
  for (const auto& [number, phrase] : kPhrases) {
    if (number == status) return phrase;
  }
  return "Unknown";
}

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return text.data();
}

void line(std::string& text, std::string_view name, std::string_view value) {
  text.append(name).append(": ").append(value).append("\r\n");
}

// 204 and 304 have neither a body nor a Content-Length.
bool may_have_body(int status) { return status != 204 && status != 304; }

// Returns whether to send Strict-Transport-Security, after which browsers use only TLS for all
// ports of the host name. It is not sent for localhost, where other programs may listen. Browsers
// ignore it for addresses.
bool may_be_remembered(const Head& request) {
  const std::string_view host = request.fields.find("Host").value_or("localhost");
  return !same_name(host.substr(0, 9), "localhost");
}

}  // namespace

std::string head_text(const Response& response, const Head& request, const Framing& framing) {
  std::string text = fmt::format("HTTP/1.1 {} {}\r\n", response.status, phrase_of(response.status));
  line(text, "Date", date_now());
  for (const HeaderField& field : response.fields.all()) line(text, field.name, field.value);
  line(text, "X-Content-Type-Options", "nosniff");
  line(text, "Referrer-Policy", "no-referrer");
  line(text, "Content-Security-Policy", "default-src 'self'; frame-ancestors 'none'");
  if (framing.is_secure && may_be_remembered(request)) {
    line(text, "Strict-Transport-Security", "max-age=31536000");
  }
  if (!response.fields.find("Cache-Control")) line(text, "Cache-Control", "no-store");
  if (may_have_body(response.status)) {
    if (framing.length) {
      line(text, "Content-Length", std::to_string(*framing.length));
    } else if (request.version >= 11) {
      line(text, "Transfer-Encoding", "chunked");
    }
  }
  if (!framing.keeps_alive) line(text, "Connection", "close");
  if (framing.keeps_alive && request.version < 11) line(text, "Connection", "keep-alive");
  return text + "\r\n";
}

Response json_response(int status, std::string json) {
  Response response;
  response.status = status;
  response.fields.set("Content-Type", "application/json");
  response.body = std::move(json);
  return response;
}

Response text_response(int status, std::string text) {
  Response response;
  response.status = status;
  response.fields.set("Content-Type", "text/plain; charset=utf-8");
  response.body = std::move(text);
  return response;
}

Response refusal(const Error& error, std::optional<int> status) {
  const rest::Answer answer = rest::error_answer(error);
  return json_response(status.value_or(answer.http_status), answer.json);
}

}  // namespace hydroprint::http
