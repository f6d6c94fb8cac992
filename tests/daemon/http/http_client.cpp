#include "tests/daemon/http/http_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace hydroprint::tests {
namespace {

constexpr int kPatience_s = 20;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::shared_ptr<SSL> speak_tls(int socket, const std::string& ca_pem) {
  ::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes without MSG_NOSIGNAL
  const std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
  const std::shared_ptr<BIO> reader(BIO_new_mem_buf(ca_pem.data(), -1), BIO_free);
  const std::shared_ptr<X509> authority(PEM_read_bio_X509(reader.get(), nullptr, nullptr, nullptr),
                                        X509_free);
  X509_STORE_add_cert(SSL_CTX_get_cert_store(context.get()), authority.get());
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  std::shared_ptr<SSL> tls(SSL_new(context.get()), SSL_free);
  SSL_set1_host(tls.get(), "localhost");
  SSL_set_fd(tls.get(), socket);
  if (SSL_connect(tls.get()) != 1) {
    ::close(socket);
    throw std::runtime_error("the TLS handshake with the server failed");
  }
  return tls;
}

}  // namespace

nlohmann::json HttpAnswer::json() const { return nlohmann::json::parse(body); }

std::string HttpAnswer::field(const std::string& name) const {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

std::string HttpAnswer::reason() const {
  const auto parsed = nlohmann::json::parse(body, nullptr, false);
  if (!parsed.is_object() || !parsed.contains("error")) return "";
  for (const auto& detail : parsed.at("error").value("details", nlohmann::json::array())) {
    if (detail.contains("reason")) return detail.at("reason");
  }
  return "";
}

nlohmann::json HttpEvent::json() const { return nlohmann::json::parse(data); }

HttpConnection::HttpConnection(const std::string& address, int receive_buffer_bytes,
                               const std::string& ca_pem)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_buffer_bytes > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes,
                 sizeof receive_buffer_bytes);
  }
  const timeval patience{kPatience_s, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const int now = 1;
  ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &now, sizeof now);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    throw std::runtime_error("cannot connect to " + address);
  }
  if (!ca_pem.empty()) tls_ = speak_tls(socket_, ca_pem);
}

HttpConnection::HttpConnection(HttpConnection&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)),
      tls_(std::move(other.tls_)),
      received_(std::move(other.received_)),
      stream_(std::move(other.stream_)) {}

HttpConnection& HttpConnection::operator=(HttpConnection&& other) noexcept {
  close();
  socket_ = std::exchange(other.socket_, -1);
  tls_ = std::move(other.tls_);
  received_ = std::exchange(other.received_, {});
  stream_ = std::exchange(other.stream_, {});
  return *this;
}

HttpConnection::~HttpConnection() { close(); }

void HttpConnection::close() {
  if (tls_) SSL_shutdown(tls_.get());
  tls_ = nullptr;
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
}

void HttpConnection::end_sending() { ::shutdown(socket_, SHUT_WR); }

bool HttpConnection::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = tls_ ? SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                              : ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::string HttpConnection::read_some() {
  return received_.empty() ? receive() : std::exchange(received_, {});
}

std::string HttpConnection::receive() {
  std::array<char, 65536> buffer{};
  errno = 0;
  const ssize_t got = tls_ ? SSL_read(tls_.get(), buffer.data(), static_cast<int>(buffer.size()))
                           : ::recv(socket_, buffer.data(), buffer.size(), 0);
  if (got <= 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
    throw std::runtime_error("the server sent nothing for 20 s");
  }
  return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
}

bool HttpConnection::is_ended() { return read_some().empty(); }

void HttpConnection::need(std::size_t bytes) {
  while (received_.size() < bytes) {
    const std::string more = receive();
    if (more.empty()) throw std::runtime_error("the server ended the connection: " + received_);
    received_ += more;
  }
}

std::string HttpConnection::line() {
  std::size_t end = 0;
  while ((end = received_.find("\r\n")) == std::string::npos) need(received_.size() + 1);
  std::string text = received_.substr(0, end);
  received_.erase(0, end + 2);
  return text;
}

HttpAnswer HttpConnection::read_head() {
  HttpAnswer answer;
  const std::string status = line();
  if (!status.starts_with("HTTP/1.1 "))
    throw std::runtime_error("not an HTTP/1.1 answer: " + status);
  answer.status = std::stoi(status.substr(9));
  for (std::string text = line(); !text.empty(); text = line()) {
    const std::size_t colon = text.find(": ");
    answer.fields[lower_case(text.substr(0, colon))] = text.substr(colon + 2);
  }
  return answer;
}

std::string HttpConnection::chunk() {
  const std::size_t size = std::stoul(line(), nullptr, 16);
  need(size + 2);
  std::string bytes = received_.substr(0, size);
  received_.erase(0, size + 2);
  return bytes;
}

HttpAnswer HttpConnection::read_answer(bool has_body) {
  HttpAnswer answer = read_head();
  if (!has_body || answer.status == 204 || answer.status == 304 || answer.status == 100) {
    return answer;
  }
  if (answer.fields.contains("content-length")) {
    const std::size_t size = std::stoul(answer.fields.at("content-length"));
    need(size);
    answer.body = received_.substr(0, size);
    received_.erase(0, size);
  } else if (answer.field("transfer-encoding") == "chunked") {
    for (std::string part = chunk(); !part.empty(); part = chunk()) answer.body += part;
  } else {
    for (std::string part = read_some(); !part.empty(); part = read_some()) answer.body += part;
  }
  return answer;
}

HttpEvent HttpConnection::read_event() {
  std::size_t end = 0;
  while ((end = stream_.find("\n\n")) == std::string::npos) {
    const std::string more = chunk();
    if (more.empty()) throw std::runtime_error("the stream ended: " + stream_);
    stream_ += more;
  }
  HttpEvent event;
  std::string text = stream_.substr(0, end + 1);
  stream_.erase(0, end + 2);
  for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1) {
    const std::string one = text.substr(begin, text.find('\n', begin) - begin);
    if (one.starts_with("id: ")) event.id = one.substr(4);
    if (one.starts_with("event: ")) event.kind = one.substr(7);
    if (one.starts_with("data: ")) event.data = one.substr(6);
  }
  return event;
}

HttpAnswer HttpConnection::ask(const std::string& method, const std::string& target,
                               const std::string& body, const std::string& fields) {
  send(request_text(method, target, body, fields));
  return read_answer(method != "HEAD");
}

std::string request_text(const std::string& method, const std::string& target,
                         const std::string& body, const std::string& fields) {
  std::string text = method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields;
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

HttpAnswer ask(const std::string& address, const std::string& method, const std::string& target,
               const std::string& body, const std::string& fields) {
  return HttpConnection(address).ask(method, target, body, fields);
}

}  // namespace hydroprint::tests
