#include "daemon/http/protocol/request_parser.h"

#include <gtest/gtest.h>

namespace hydroprint::http {
namespace {

using Outcome = RequestParser::Outcome;

// Parses a request in pieces of this size; returns the outcome and the body.
std::pair<Outcome, std::string> parse(RequestParser& parser, std::string_view text,
                                      std::size_t piece) {
  std::string waiting, body;
  for (std::size_t begin = 0; begin < text.size(); begin += piece) {
    waiting += text.substr(begin, piece);
    for (bool goes_on = true; goes_on && !waiting.empty() && !parser.is_done();) {
      std::size_t used = 0;
      const Outcome outcome = parser.put(waiting, used);
      waiting.erase(0, used);
      body += parser.take_body();
      if (outcome == Outcome::kMalformed || outcome == Outcome::kHeaderTooLarge) {
        return {outcome, body};
      }
      goes_on = outcome == Outcome::kProgress;
    }
  }
  return {parser.is_done() ? Outcome::kProgress : Outcome::kNeedsMore, body};
}

TEST(HttpRequestParser, PiecesOfAnySizeGiveTheSameRequest) {
  const std::string text =
      "POST /v1/jobs?a=b HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
      "5;note=1\r\nhello\r\n1\r\n!\r\n0\r\nTrailer: t\r\n\r\n";
  for (std::size_t piece = 1; piece <= text.size(); ++piece) {
    RequestParser parser(1 << 14);
    const auto [outcome, body] = parse(parser, text, piece);
    EXPECT_EQ(outcome, Outcome::kProgress) << piece;
    EXPECT_EQ(body, "hello!") << piece;
    EXPECT_EQ(parser.head().method, "POST");
    EXPECT_EQ(parser.head().path(), "/v1/jobs");
    EXPECT_EQ(parser.head().framing, BodyFraming::kChunked);
    EXPECT_FALSE(parser.head().fields.find("Trailer"));
  }
}

TEST(HttpRequestParser, AmbiguousRequestsAreRefused) {
  for (const char* text : {
           "GET / HTTP/1.1\r\nContent-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n",
           "GET / HTTP/1.1\r\nContent-Length: 3\r\nContent-Length: 4\r\n\r\n",
           "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
           "GET / HTTP/1.1\r\nContent-Length: 3, 4\r\n\r\n",
           "GET / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
           "GET / HTTP/2.0\r\n\r\n",
           "GET  / HTTP/1.1\r\n\r\n",
           "GET /\x01 HTTP/1.1\r\n\r\n",
           "GET / HTTP/1.1\r\nHost x\r\n\r\n",
           "GET / HTTP/1.1\r\nHost : x\r\n\r\n",
           "GET / HTTP/1.1\r\n: x\r\n\r\n",
           "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
           "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n-1\r\n",
           "\x16\x03\x01\x02\x00 tls\r\n\r\n",
       }) {
    RequestParser parser(1 << 14);
    EXPECT_EQ(parse(parser, text, 1000).first, Outcome::kMalformed) << text;
  }
}

TEST(HttpRequestParser, OnlyPlainChunkedHasAKnownEnd) {
  const auto framing_of = [](const std::string& fields, const std::string& version = "1.1") {
    RequestParser parser(1 << 14);
    const std::string text = "POST / HTTP/" + version + "\r\n" + fields + "\r\n";
    EXPECT_NE(parse(parser, text, 1000).first, Outcome::kMalformed) << fields;
    EXPECT_TRUE(parser.has_head()) << fields;
    return parser.head().framing;
  };
  EXPECT_EQ(framing_of(""), BodyFraming::kLength);
  EXPECT_EQ(framing_of("Content-Length: 3\r\n"), BodyFraming::kLength);
  for (const char* value : {"chunked", "Chunked", "CHUNKED", "  chunked\t"}) {
    const std::string field = std::string("Transfer-Encoding:") + value + "\r\n";
    EXPECT_EQ(framing_of(field), BodyFraming::kChunked) << value;
    EXPECT_EQ(framing_of(field, "1.0"), BodyFraming::kFaulty) << value;
  }
  for (const char* value : {"gzip, chunked", "gzip,deflate,chunked", "identity, chunked",
                            "gzip\r\nTransfer-Encoding: chunked"}) {
    EXPECT_EQ(framing_of(std::string("Transfer-Encoding: ") + value + "\r\n"),
              BodyFraming::kUnknownCoding)
        << value;
  }
  for (const char* value :
       {"xchunked", "chunkedx", "identity", "gzip", "", ",", "chunked,", ",chunked",
        "chunked, chunked", "chunked, gzip", "chunked, identity", "chunked;q=1", "\"chunked\"",
        "chunked chunked", "gzip\r\nContent-Length: 3", "xchunked\r\nContent-Length: 0",
        "identity\r\nTransfer-Encoding: identity"}) {
    EXPECT_EQ(framing_of(std::string("Transfer-Encoding: ") + value + "\r\n"), BodyFraming::kFaulty)
        << value;
  }
}

TEST(HttpRequestParser, HeaderLengthIsLimited) {
  const auto with = [](std::size_t size) {
    const std::string begin = "GET / HTTP/1.1\r\nX: ", end = "\r\n\r\n";
    return begin + std::string(size - begin.size() - end.size(), 'a') + end;
  };
  for (const std::size_t piece : {1U, 7U, 4096U}) {
    RequestParser most(1024), more(1024);
    EXPECT_EQ(parse(most, with(1024), piece).first, Outcome::kProgress) << piece;
    EXPECT_EQ(parse(more, with(1025), piece).first, Outcome::kHeaderTooLarge) << piece;
  }
}

}  // namespace
}  // namespace hydroprint::http
