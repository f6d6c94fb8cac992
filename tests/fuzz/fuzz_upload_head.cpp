// The head of an upload or a download yields the same result however its bytes are split into
// pieces: the same request with usable headers, or an error.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/protocol/byte_range.h"
#include "daemon/http/protocol/request_parser.h"
#include "daemon/http/protocol/upload_head.h"
#include "daemon/rest/percent.h"
#include "tests/fuzz/expect.h"

namespace hydroprint::fuzz {
namespace {

using http::RequestParser;

constexpr std::uint32_t kHeadLimit_bytes = 4096;
constexpr std::int64_t kFile_bytes = 1000;

struct Taken {
  std::optional<http::Head> head;
  std::string body;
  bool is_done = false, is_refused = false;
};

// As in a connection, bytes that the parser has not consumed are passed again with the next ones.
Taken take(std::string_view bytes, std::size_t piece) {
  RequestParser parser(kHeadLimit_bytes);
  Taken taken;
  std::size_t begin = 0, end = 0;
  while (!parser.is_done() && !taken.is_refused) {
    std::size_t used = 0;
    const auto outcome = parser.put(bytes.substr(begin, end - begin), used);
    HP_EXPECT(used <= end - begin);
    begin += used;
    taken.body += parser.take_body();
    taken.is_refused = outcome == RequestParser::Outcome::kMalformed ||
                       outcome == RequestParser::Outcome::kHeaderTooLarge;
    const bool needs_more = outcome == RequestParser::Outcome::kNeedsMore || begin == end;
    if (!needs_more) continue;
    if (end == bytes.size()) break;
    end = std::min(end + piece, bytes.size());
  }
  taken.is_done = parser.is_done();
  if (parser.has_head()) taken.head = parser.head();
  return taken;
}

// If the request is invalid, the parser may refuse it before or after it has the head.
void expect_same(const Taken& a, const Taken& b) {
  HP_EXPECT(a.is_done == b.is_done);
  if (!a.head || !b.head) return;
  HP_EXPECT(a.head->method == b.head->method && a.head->target == b.head->target);
  HP_EXPECT(a.head->content_length == b.head->content_length);
  HP_EXPECT(a.head->fields.all().size() == b.head->fields.all().size());
  if (a.is_done) HP_EXPECT(a.body == b.body);
}

void expect_plain(const Error& error) {
  HP_EXPECT(error.code == Code::kInvalidArgument && !error.reason.empty());
  HP_EXPECT(error.message.find('\n') == std::string::npos && error.message.size() < 1000);
  HP_EXPECT(rest::not_utf8_at(error.message) == std::string::npos);
}

void expect_fit_for_use(const http::Head& head) {
  const auto offset = http::upload_offset(head.fields);
  if (offset) HP_EXPECT(*offset >= 0 && head.fields.count("Upload-Offset") == 1);
  if (!offset) expect_plain(offset.error());
  if (head.target.starts_with("/v1/")) {
    const auto name = http::upload_name(head.path());
    if (name) HP_EXPECT(rest::not_utf8_at(*name) == std::string::npos);
    if (name) HP_EXPECT(name->find('\0') == std::string::npos);
    if (!name) expect_plain(name.error());
  }
  const auto range = http::byte_range(head.fields.find("Range").value_or(""), kFile_bytes);
  if (range.kind == http::ByteRange::Kind::kPart) {
    HP_EXPECT(0 <= range.begin && range.begin < range.end && range.end <= kFile_bytes);
  }
  HP_EXPECT(!http::lists_tag(head.fields.find("If-None-Match").value_or(""), "\"\"") ||
            head.fields.count("If-None-Match") > 0);
  // A name or value cannot begin another header field when the fields are written out again.
  for (const http::HeaderField& field : head.fields.all()) {
    HP_EXPECT(field.name.find_first_of("\r\n:") == std::string::npos);
    HP_EXPECT(field.value.find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fuzz = hydroprint::fuzz;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const fuzz::Taken whole = fuzz::take(bytes, std::max<std::size_t>(1, size));
  fuzz::expect_same(whole, fuzz::take(bytes, 1));
  fuzz::expect_same(whole, fuzz::take(bytes, 7));
  if (whole.head) fuzz::expect_fit_for_use(*whole.head);
  return 0;
}
