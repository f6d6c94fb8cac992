// HTTP/1.1 itself, through the daemon.
#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

class HttpProtocol : public HttpTest {
 protected:
  // Everything the server sends for these bytes, until it closes the connection.
  std::string all_of(const std::string& bytes) {
    HttpConnection connection(daemon.http());
    connection.send(bytes);
    std::string text;
    for (std::string part = connection.read_some(); !part.empty(); part = connection.read_some()) {
      text += part;
    }
    return text;
  }
};

TEST_F(HttpProtocol, PipelinedRequestsAreAnsweredInOrder) {
  HttpConnection connection(daemon.http());
  connection.send(request_text("GET", "/v1/queue") + request_text("HEAD", "/") + "\r\n" +
                  request_text("POST", "/v1/queue:pause", "{}") +
                  request_text("GET", "/v1/jobs/9") + request_text("GET", "/v1/queue"));
  EXPECT_EQ(connection.read_answer().json().at("paused"), false);
  EXPECT_EQ(connection.read_answer(false).status, 200);
  EXPECT_EQ(connection.read_answer().status, 200);
  EXPECT_EQ(connection.read_answer().status, 404);
  EXPECT_EQ(connection.read_answer().json().at("paused"), true);
}

TEST_F(HttpProtocol, ContinueIsSentOnlyForAWantedBody) {
  const std::string ask_for = "Expect: 100-continue\r\n";
  HttpConnection connection(daemon.http());
  connection.send("POST /v1/queue:pause HTTP/1.1\r\nHost: localhost\r\n" + ask_for +
                  "Content-Length: 2\r\n\r\n");
  EXPECT_EQ(connection.read_answer().status, 100);
  connection.send("{}");
  EXPECT_EQ(connection.read_answer().status, 200);
  connection.send("POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\n" + ask_for +
                  "Content-Length: 2000000\r\n\r\n");
  const HttpAnswer refused = connection.read_answer();
  EXPECT_EQ(refused.status, 413);
  EXPECT_EQ(refused.field("connection"), "close");
  EXPECT_TRUE(connection.is_ended());
}

TEST_F(HttpProtocol, EitherSideCanCloseTheConnection) {
  HttpConnection closing(daemon.http());
  const HttpAnswer last = closing.ask("GET", "/v1/queue", "", "Connection: close\r\n");
  EXPECT_EQ(last.status, 200);
  EXPECT_EQ(last.field("connection"), "close");
  EXPECT_TRUE(closing.is_ended());

  HttpConnection old(daemon.http());
  old.send("GET /v1/queue HTTP/1.0\r\n\r\n");
  EXPECT_EQ(old.read_answer().status, 200);
  EXPECT_TRUE(old.is_ended());
  HttpConnection kept(daemon.http());
  for (int i = 0; i < 2; ++i) {
    kept.send("GET /v1/queue HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    EXPECT_EQ(kept.read_answer().field("connection"), "keep-alive");
  }
}

TEST_F(HttpProtocol, Http10StreamEndsWithTheConnection) {
  const std::string name = simulate("");
  client.wait_for_end(name);
  const std::string text = all_of("GET /v1/" + name + ":watch?afterSeq=0 HTTP/1.0\r\n\r\n");
  EXPECT_EQ(text.find("chunked"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\n\nevent: end\ndata: {}\n\n")) << text;
}

TEST_F(HttpProtocol, MalformedRequestClosesTheConnection) {
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01 hello\r\n\r\n"), std::string("GET\r\n\r\n"),
        std::string(
            "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n"),
        std::string("GET / HTTP/3.0\r\n\r\n"), std::string(70'000, 'A')}) {
    HttpConnection connection(daemon.http());
    connection.send(bytes);
    const HttpAnswer answer = connection.read_answer();
    EXPECT_TRUE(answer.status == 400 || answer.status == 431) << answer.status;
    EXPECT_FALSE(answer.reason().empty());
    EXPECT_TRUE(connection.is_ended());
  }
  EXPECT_EQ(get("/v1/queue").status, 200);
}

TEST_F(HttpProtocol, HeaderLimitIs16KiB) {
  const auto with = [](std::size_t size) {
    const std::string begin = "GET /v1/queue HTTP/1.1\r\nHost: localhost\r\nX: ", end = "\r\n\r\n";
    return begin + std::string(size - begin.size() - end.size(), 'a') + end;
  };
  HttpConnection most(daemon.http());
  most.send(with(16 << 10));
  EXPECT_EQ(most.read_answer().status, 200);
  HttpConnection more(daemon.http());
  more.send(with((16 << 10) + 1));
  const HttpAnswer refused = more.read_answer();
  EXPECT_EQ(refused.status, 431);
  EXPECT_EQ(refused.reason(), "HEADER_TOO_LARGE");
}

TEST_F(HttpProtocol, BodyLimitIsOneMiB) {
  const auto with = [](std::size_t size) {
    const std::string begin = "{\"reason\": \"", end = "\"}";
    return begin + std::string(size - begin.size() - end.size(), 'a') + end;
  };
  EXPECT_EQ(post("/v1/queue:pause", with(1 << 20)).reason(), "SPEC_INVALID");
  const HttpAnswer refused = post("/v1/queue:pause", with((1 << 20) + 1));
  EXPECT_EQ(refused.status, 413);
  EXPECT_EQ(refused.reason(), "BODY_TOO_LARGE");
  HttpConnection chunked(daemon.http());
  chunked.send(
      "POST /v1/queue:pause HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(65536, ' ') + "\r\n";
  for (int i = 0; i < 17; ++i) chunked.send(chunk);
  EXPECT_EQ(chunked.read_answer().status, 413);
}

TEST_F(HttpProtocol, RequestSmugglingIsRefused) {
  const std::string text = all_of(
      "POST /v1/queue:resume HTTP/1.1\r\nHost: localhost\r\nContent-Length: 6\r\n"
      "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\nGET /v1/queue HTTP/1.1\r\nHost: "
      "localhost\r\n\r\n");
  EXPECT_TRUE(text.starts_with("HTTP/1.1 400 ")) << text;
  EXPECT_EQ(text.find("HTTP/1.1 200"), std::string::npos) << text;
}

TEST_F(HttpProtocol, UnknownTransferEncodingClosesTheConnection) {
  const std::string smuggled = request_text("GET", "/v1/queue");
  const auto answer_to = [&](const std::string& fields, const std::string& version = "1.1") {
    return all_of("POST /v1/queue:pause HTTP/" + version + "\r\nHost: localhost\r\n" + fields +
                  "\r\n" + smuggled);
  };
  const auto expect_refused = [&](const std::string& text, int status) {
    EXPECT_TRUE(text.starts_with("HTTP/1.1 " + std::to_string(status) + " ")) << text;
    EXPECT_NE(text.find("Connection: close\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("REQUEST_MALFORMED"), std::string::npos) << text;
    EXPECT_EQ(text.find("\r\nDate: "), text.rfind("\r\nDate: ")) << "exactly one answer: " << text;
  };
  for (const char* value : {"xchunked", "identity", "gzip", "", "chunked,", "chunked, chunked",
                            "chunked, identity", "chunked\r\nTransfer-Encoding: chunked",
                            "xchunked\r\nContent-Length: 0", "chunked\r\nContent-Length: 0"}) {
    SCOPED_TRACE(value);
    expect_refused(answer_to(std::string("Transfer-Encoding: ") + value + "\r\n"), 400);
  }
  expect_refused(answer_to("Content-Length: 0\r\nTransfer-Encoding: xchunked\r\n"), 400);
  expect_refused(answer_to("Transfer-Encoding: chunked\r\n", "1.0"), 400);
  expect_refused(answer_to("Transfer-Encoding: xchunked\r\nConnection: keep-alive\r\n", "1.0"),
                 400);
  for (const char* value : {"gzip, chunked", "xchunked\r\nTransfer-Encoding: chunked"}) {
    SCOPED_TRACE(value);
    expect_refused(answer_to(std::string("Transfer-Encoding: ") + value + "\r\n"), 501);
  }
  EXPECT_EQ(get("/v1/queue").json().at("paused"), false) << "the request was not carried out";
}

TEST_F(HttpProtocol, UnreadBodyIsNotTheNextRequest) {
  HttpConnection connection(daemon.http());
  const std::string evil = request_text("POST", "/v1/queue:pause", "{}");
  EXPECT_EQ(connection.ask("POST", "/nothing.here", evil).status, 405);
  EXPECT_EQ(connection.ask("GET", "/v1/queue").json().at("paused"), false);
}

}  // namespace
}  // namespace hydroprint::tests
