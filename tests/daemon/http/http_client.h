#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

using SSL = struct ssl_st;

namespace hydroprint::tests {

/// An answer as it came over the transport; names of fields in lower case.
struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> fields;
  std::string body;

  [[nodiscard]] nlohmann::json json() const;
  /// Reason of an error's ErrorInfo; "" if there is none.
  [[nodiscard]] std::string reason() const;
  [[nodiscard]] std::string field(const std::string& name) const;
};

/// One server-sent event.
struct HttpEvent {
  std::string id, kind, data;
  [[nodiscard]] nlohmann::json json() const;
};

/// A client's end of a TCP connection, as bare as it can be: what is sent is what the test says.
/// Throws if the server ends it or says nothing for 20 s where an answer is due.
class HttpConnection {
 public:
  /// @param address  "127.0.0.1:40123"
  /// @param receive_buffer_bytes  small: the kernel takes little that nobody reads; 0: its default
  /// @param ca_pem  the authority whose certificate for "localhost" is taken; empty: no TLS
  explicit HttpConnection(const std::string& address, int receive_buffer_bytes = 0,
                          const std::string& ca_pem = "");
  ~HttpConnection();
  HttpConnection(HttpConnection&& other) noexcept;
  HttpConnection& operator=(HttpConnection&& other) noexcept;
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  /// False if the server takes no more.
  bool send(std::string_view bytes);
  /// One request with its body, answered.
  HttpAnswer ask(const std::string& method, const std::string& target, const std::string& body = "",
                 const std::string& fields = "");
  /// The next answer. @param has_body  false: to HEAD
  HttpAnswer read_answer(bool has_body = true);
  /// The head of the next answer alone.
  HttpAnswer read_head();
  /// The next event of a stream whose head was read; kind "" for a ping.
  HttpEvent read_event();
  /// Whether the stream's body ends here, so that the connection may be used again.
  bool is_stream_over() { return stream_.empty() && chunk().empty(); }
  /// The next bytes of all that comes; empty at the end.
  std::string read_some();
  /// True once the server ended the connection, and nothing more came; waits for it.
  bool is_ended();
  /// As a browser does: over TLS it says so first.
  void close();
  /// Sends no more.
  void end_sending();

 private:
  std::string receive();
  void need(std::size_t bytes);
  std::string line();
  std::string chunk();

  int socket_ = -1;
  std::shared_ptr<SSL> tls_;
  std::string received_;
  std::string stream_;  // of the body of an event stream
};

/// A request's bytes, with Host and the length of its body.
std::string request_text(const std::string& method, const std::string& target,
                         const std::string& body = "", const std::string& fields = "");

/// One request on a connection of its own.
HttpAnswer ask(const std::string& address, const std::string& method, const std::string& target,
               const std::string& body = "", const std::string& fields = "");

}  // namespace hydroprint::tests
