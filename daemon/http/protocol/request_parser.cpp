#include "daemon/http/protocol/request_parser.h"

#include <algorithm>
#include <boost/beast/http/basic_parser.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace hydroprint::http {
namespace {

namespace beast = boost::beast;
using beast::error_code;

bool is_chunked(std::string_view coding) { return same_name(coding, "chunked"); }

// Determines the framing without Beast, which treats a body as empty if the last coding is not
// "chunked".
BodyFraming framing_of(const HeaderFields& fields, int version) {
  constexpr std::string_view kCodings = "Transfer-Encoding";
  const std::size_t count = fields.count(kCodings);
  if (count == 0) return BodyFraming::kLength;
  if (version < 11 || fields.count("Content-Length") > 0) return BodyFraming::kFaulty;
  if (count == 1 && is_chunked(trimmed(*fields.find(kCodings)))) return BodyFraming::kChunked;
  const std::vector<std::string_view> codings = fields.words(kCodings);
  const bool ends_chunked = codings.size() > 1 && is_chunked(codings.back()) &&
                            std::count_if(codings.begin(), codings.end(), is_chunked) == 1;
  return ends_chunked ? BodyFraming::kUnknownCoding : BodyFraming::kFaulty;
}

class BeastParser final : public beast::http::basic_parser<true> {
 public:
  explicit BeastParser(std::uint32_t header_limit_bytes) {
    header_limit(header_limit_bytes);
    body_limit(std::numeric_limits<std::uint64_t>::max());  // Exchange limits the body
  }
  Head head;
  std::string body;

 private:
  void on_request_impl(beast::http::verb, beast::string_view method, beast::string_view target,
                       int version, error_code&) override {
    head.method = std::string(method);
    head.target = std::string(target);
    head.version = version;
  }
  void on_response_impl(int, beast::string_view, int, error_code&) override {}
  void on_field_impl(beast::http::field, beast::string_view name, beast::string_view value,
                     error_code&) override {
    if (!has_head_) head.fields.add(std::string(name), std::string(value));  // drops trailers
  }
  void on_header_impl(error_code&) override {
    has_head_ = true;
    head.keeps_alive = keep_alive();
    head.framing = framing_of(head.fields, head.version);
    const auto length = content_length();
    if (length) head.content_length = *length;
    head.expects_continue = head.version >= 11 && head.fields.lists("Expect", "100-continue");
  }
  void on_body_init_impl(const boost::optional<std::uint64_t>&, error_code&) override {}
  std::size_t on_body_impl(beast::string_view bytes, error_code&) override {
    body.append(bytes.data(), bytes.size());
    return bytes.size();
  }
  void on_chunk_header_impl(std::uint64_t, beast::string_view, error_code&) override {}
  std::size_t on_chunk_body_impl(std::uint64_t, beast::string_view bytes, error_code&) override {
    body.append(bytes.data(), bytes.size());
    return bytes.size();
  }
  void on_finish_impl(error_code&) override {}

  bool has_head_ = false;
};

}  // namespace

struct RequestParser::Impl {
  BeastParser parser;
  std::size_t header_limit_bytes, header_bytes = 0;
};

RequestParser::RequestParser(std::uint32_t header_limit_bytes)
    : impl_(new Impl{BeastParser(header_limit_bytes), header_limit_bytes}) {}
RequestParser::~RequestParser() = default;

RequestParser::Outcome RequestParser::put(std::string_view bytes, std::size_t& used) {
  error_code error;
  const bool had_head = has_head();
  used = impl_->parser.put(boost::asio::buffer(bytes.data(), bytes.size()), error);
  // Beast rejects a header that does not end, but accepts a complete header that slightly exceeds
  // the limit.
  if (!had_head) impl_->header_bytes += used;
  if (impl_->header_bytes > impl_->header_limit_bytes) return Outcome::kHeaderTooLarge;
  if (!error) return Outcome::kProgress;
  if (error == beast::http::error::need_more) return Outcome::kNeedsMore;
  return error == beast::http::error::header_limit ? Outcome::kHeaderTooLarge : Outcome::kMalformed;
}

bool RequestParser::has_head() const { return impl_->parser.is_header_done(); }
bool RequestParser::is_done() const { return impl_->parser.is_done(); }
const Head& RequestParser::head() const { return impl_->parser.head; }
std::string RequestParser::take_body() { return std::exchange(impl_->parser.body, {}); }

}  // namespace hydroprint::http
