#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

using SSL = struct ssl_st;

namespace hydroprint::tests {

/// An answer as received, with the names of header fields in lower case.
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

/// A minimal client end of a TCP connection, which sends exactly the given bytes. Throws if an
/// answer is due and the server disconnects or sends nothing for 20 s.
class HttpConnection {
 public:
  /// @param address  "127.0.0.1:40123"
  /// @param receive_buffer_bytes  size of the socket's receive buffer; 0: the system's default
  /// @param ca_pem  the trusted authority for "localhost"; empty: no TLS
  explicit HttpConnection(const std::string& address, int receive_buffer_bytes = 0,
                          const std::string& ca_pem = "");
  ~HttpConnection();
  HttpConnection(HttpConnection&& other) noexcept;
  HttpConnection& operator=(HttpConnection&& other) noexcept;
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  /// Sends bytes; false if the server no longer accepts any.
  bool send(std::string_view bytes);
  /// Sends one request with its body and reads the answer.
  HttpAnswer ask(const std::string& method, const std::string& target, const std::string& body = "",
                 const std::string& fields = "");
  /// Reads the next answer.
  /// @param has_body  false: the answer to HEAD
  HttpAnswer read_answer(bool has_body = true);
  /// Reads only the head of the next answer.
  HttpAnswer read_head();
  /// Reads the next event of a stream whose head was read. A ping has the kind "".
  HttpEvent read_event();
  /// Whether the stream's body ends here, so that the connection can be reused.
  bool is_stream_over() { return stream_.empty() && chunk().empty(); }
  /// Reads the next bytes; empty at the end.
  std::string read_some();
  /// Waits until the server closes the connection; true if no further bytes arrived.
  bool is_ended();
  /// Closes the connection as a browser does: over TLS with a close_notify.
  void close();
  /// Half-closes the connection.
  void end_sending();

 private:
  std::string receive();
  void need(std::size_t bytes);
  std::string line();
  std::string chunk();

  int socket_ = -1;
  std::shared_ptr<SSL> tls_;
  std::string received_;
  std::string stream_;  // body of an event stream
};

/// The bytes of a request, with Host and Content-Length.
std::string request_text(const std::string& method, const std::string& target,
                         const std::string& body = "", const std::string& fields = "");

/// Sends one request on a new connection.
HttpAnswer ask(const std::string& address, const std::string& method, const std::string& target,
               const std::string& body = "", const std::string& fields = "");

}  // namespace hydroprint::tests
