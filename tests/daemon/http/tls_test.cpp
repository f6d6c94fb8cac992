// TLS on both servers, with the daemon's default settings, and limits during the handshake.
#include <sys/socket.h>

#include <chrono>

#include "daemon/tls/identity.h"
#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

using http::Limits;
using hydroprint::testing::Authority;
using hydroprint::testing::KeyPair;
using hydroprint::testing::KeyPairFiles;
using std::chrono::milliseconds;

constexpr const char* kPassword = "correct horse";
constexpr std::string_view kBeginOfHandshake("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);
constexpr double kPatience_s = 120;  // the daemon checks the files every 2 s

// A daemon with a certificate, and an admin who signs in with the first link.
class Tls : public ::testing::Test {
 protected:
  DaemonProcess::Options options() {
    files.write(authority.issue({{"DNS:localhost", "DNS:rig.example.org", "IP:192.0.2.7"}}));
    DaemonProcess::Options options = DaemonProcess::fake();
    options.host = "0.0.0.0";
    options.extra = "[server]\ntls_certificate = \"" + files.certificate.string() +
                    "\"\ntls_key = \"" + files.key.string() +
                    "\"\n[people]\npassword_memory_mib = 1\npassword_passes = 1\n";
    options.arguments = {"--first-admin", "root"};
    return options;
  }
  [[nodiscard]] HttpConnection connect() const {
    return HttpConnection(daemon.http(), 0, authority.pem());
  }
  [[nodiscard]] std::string said() const { return daemon.printed(); }
  [[nodiscard]] std::string grpc_address() const {
    return "localhost" + daemon.address().substr(daemon.address().rfind(':'));
  }
  /// The Host header that a browser sends.
  static std::string named(const std::string& host) { return "Host: " + host + "\r\n"; }
  HttpAnswer get_as(const std::string& host, const std::string& target = "/healthz") {
    HttpConnection connection = connect();
    connection.send("GET " + target + " HTTP/1.1\r\n" + named(host) + "\r\n");
    return connection.read_answer();
  }
  HttpAnswer sign_in() {
    const std::string words = said();
    const std::size_t from = words.find("/sign-in#") + 9;
    const nlohmann::json link = {{"linkToken", words.substr(from, words.find('\n', from) - from)}};
    return connect().ask("POST", "/v1/session:signIn", link.dump());
  }
  /// Whether new connections to both servers show a certificate of this authority.
  [[nodiscard]] bool shows(const Authority& one) const {
    try {
      HttpConnection(daemon.http(), 0, one.pem());
    } catch (const std::runtime_error&) {
      return false;
    }
    Client client(grpc_address(), "", one.pem());
    return client.channel->WaitForConnected(std::chrono::system_clock::now() + milliseconds(2000));
  }
  [[nodiscard]] bool comes_to_log(const std::string& words) const {
    return wait_until([&] { return daemon.log().find(words) != std::string::npos; }, kPatience_s);
  }

  TemporaryFolder folder;
  Authority authority;
  KeyPairFiles files{folder.path()};
  DaemonProcess daemon{folder.path(), options()};
};

TEST_F(Tls, CertificateEnablesTlsOnBothServers) {
  EXPECT_EQ(connect().ask("GET", "/healthz").status, 200);
  Client client(grpc_address(), "", authority.pem());
  v1::WhoAmIResponse who;
  const auto status = client.people->WhoAmI(client.context().get(), {}, &who);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED) << status.error_message();
}

TEST_F(Tls, ExposedDaemonRequiresUsersEverywhere) {
  // people.accounts is "loopback-open", and this call comes from loopback.
  EXPECT_EQ(connect().ask("GET", "/v1/jobs").reason(), "SIGN_IN_NEEDED");
}

TEST_F(Tls, SessionCookieIsSecure) {
  const HttpAnswer in = sign_in();
  EXPECT_EQ(in.status, 200) << in.body;
  const std::string cookie = in.field("set-cookie");
  EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict; Secure"), std::string::npos) << cookie;
  EXPECT_NE(said().find("https://rig.example.org:"), std::string::npos) << said();
  const std::string fields = "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n" +
                             "X-Hydroprint-Csrf: " + in.json().at("csrfToken").get<std::string>() +
                             "\r\n";
  EXPECT_EQ(connect().ask("GET", "/v1/jobs", "", fields).status, 200);
  const auto pause = [&](const std::string& origin) {
    return connect().ask("POST", "/v1/queue:pause", "{\"reason\":\"film\"}",
                         fields + "Origin: " + origin + "\r\n");
  };
  EXPECT_EQ(pause("http://localhost").reason(), "ORIGIN_FORBIDDEN")
      << "anyone on the network can forge a page from an origin without TLS";
  EXPECT_EQ(pause("https://localhost").status, 200);
  const HttpAnswer out = connect().ask("POST", "/v1/session:signOut", "{}", fields);
  EXPECT_NE(out.field("set-cookie").find("Secure; Max-Age=0"), std::string::npos);
}

TEST_F(Tls, HostMustBeInTheCertificateOrLoopback) {
  for (const char* host : {"rig.example.org", "RIG.example.org:8443", "192.0.2.7", "127.0.0.1"}) {
    EXPECT_EQ(get_as(host).status, 200) << host;
  }
  for (const char* host :
       {"elsewhere.example", "example.org", "rig.example.org.evil.example", "192.0.2.8"}) {
    EXPECT_EQ(get_as(host).reason(), "HOST_UNKNOWN") << host;
  }
}

TEST_F(Tls, StrictTransportSecurityIsSentExceptOnLocalhost) {
  EXPECT_EQ(get_as("rig.example.org").field("strict-transport-security"), "max-age=31536000");
  EXPECT_EQ(get_as("localhost:8443").field("strict-transport-security"), "");
}

TEST_F(Tls, PlainHttpClientGetsAnExplanation) {
  HttpConnection plain(daemon.http());
  plain.send(request_text("GET", "/"));
  const HttpAnswer answer = plain.read_answer();
  EXPECT_EQ(answer.status, 400);
  EXPECT_NE(answer.body.find("https://"), std::string::npos) << answer.body;
  EXPECT_TRUE(plain.is_ended());
}

TEST_F(Tls, InvalidTlsClosesOnlyItsOwnConnection) {
  HttpConnection good = connect();
  for (const std::string& words :
       {std::string("\x16\x03\x01\x00\x02\xff\xff"), std::string(70000, 'x'),
        std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n")}) {
    HttpConnection bad(daemon.http());
    bad.send(words);
    bad.end_sending();
    while (!bad.is_ended()) {
    }
  }
  EXPECT_EQ(good.ask("GET", "/healthz").status, 200);
}

TEST_F(Tls, SilentHandshakeTimesOutOnBothServers) {
  std::vector<HttpConnection> silent;
  for (int i = 0; i < 40; ++i) {
    silent.emplace_back(i % 2 == 0 ? daemon.http() : daemon.address());
    if (i % 4 >= 2) silent.back().send(kBeginOfHandshake);
  }
  for (HttpConnection& one : silent) EXPECT_TRUE(one.is_ended());
  EXPECT_TRUE(shows(authority));
}

TEST_F(Tls, LargeBodiesArriveCompletely) {
  const std::string document = connect().ask("GET", "/openapi.json").body;
  EXPECT_GT(document.size(), 100'000U);
  EXPECT_FALSE(nlohmann::json::parse(document, nullptr, false).is_discarded());
  const HttpAnswer in = sign_in();
  const std::string cookie = in.field("set-cookie");
  const std::string fields = "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n" +
                             "X-Hydroprint-Csrf: " + in.json().at("csrfToken").get<std::string>() +
                             "\r\n";
  std::string bytes(5'000'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i >> 7);
  const nlohmann::json wanted = {{"sizeBytes", bytes.size()}, {"sha256", hash_of(bytes)}};
  HttpConnection connection = connect();
  const std::string upload =
      connection.ask("POST", "/v1/uploads", wanted.dump(), fields).json().at("upload").at("name");
  const HttpAnswer sent =
      connection.ask("PATCH", "/v1/" + upload, bytes, fields + "Upload-Offset: 0\r\n");
  EXPECT_EQ(sent.json().value("sha256", ""), hash_of(bytes)) << sent.body;
}

TEST_F(Tls, RenewedCertificateAppliesToNewConnections) {
  HttpConnection before = connect();
  EXPECT_EQ(before.ask("GET", "/healthz").status, 200);
  Client client(grpc_address(), "", authority.pem());
  ASSERT_TRUE(client.channel->WaitForConnected(std::chrono::system_clock::now() +
                                               std::chrono::seconds(20)));
  const Authority other;
  ASSERT_FALSE(shows(other));
  files.write(other.issue());
  EXPECT_TRUE(wait_until([&] { return shows(other); }, kPatience_s, 0.05));
  EXPECT_FALSE(shows(authority));
  EXPECT_EQ(before.ask("GET", "/healthz").status, 200);
  EXPECT_EQ(client.channel->GetState(false), GRPC_CHANNEL_READY);
}

TEST_F(Tls, InvalidPairKeepsThePreviousOne) {
  const KeyPair one = authority.issue(), two = authority.issue();
  files.write({one.certificate, two.key});
  EXPECT_TRUE(comes_to_log("certificate_not_loaded")) << daemon.log();
  EXPECT_NE(daemon.log().find("is not the key of"), std::string::npos) << daemon.log();
  EXPECT_TRUE(shows(authority));
  const Authority other;
  files.write(other.issue());
  EXPECT_TRUE(wait_until([&] { return shows(other); }, kPatience_s, 0.05))
      << "a valid pair must be loaded after an invalid one";
}

TEST_F(Tls, ExpiryIsAMetricAndAWarning) {
  const std::string metrics = connect().ask("GET", "/metrics").body;
  const std::string name = "\nhydroprint_tls_certificate_expiry_timestamp_seconds ";
  const std::size_t from = metrics.find(name);
  ASSERT_NE(from, std::string::npos) << metrics;
  const double in_days =
      (std::stod(metrics.substr(from + name.size())) - static_cast<double>(std::time(nullptr))) /
      86400;
  EXPECT_NEAR(in_days, 30, 1);
  EXPECT_EQ(daemon.log().find("certificate_expires_soon"), std::string::npos);
  files.write(authority.issue({{"DNS:localhost"}, -1, 7}));
  EXPECT_TRUE(comes_to_log("certificate_expires_soon"));
  files.write(authority.issue({{"DNS:localhost"}, -9, -1}));
  EXPECT_TRUE(comes_to_log("certificate_expired"));
}

TEST_F(Tls, IdleConnectionsCostLittle) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  constexpr std::size_t kIdle = 400;
  connect().ask("GET", "/healthz");
  const std::size_t before = memory_bytes(daemon.pid());
  std::vector<HttpConnection> idle;
  for (std::size_t i = 0; i < kIdle; ++i) {
    idle.push_back(connect());
    if (i % 2 != 0) continue;
    EXPECT_EQ(idle.back().ask("GET", "/healthz").status, 200);
  }
  const std::size_t each = (memory_bytes(daemon.pid()) - before) / kIdle;
  std::cout << "an idle connection over TLS costs " << each << " bytes\n";
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(each, 60'000U);
#endif
  EXPECT_EQ(daemon.terminate(), 0) << "idle connections do not delay the shutdown";
}

// The HTTP server in this process, with short timeouts.
using TlsLimits = HttpLimits;
INSTANTIATE_TEST_SUITE_P(Over, TlsLimits, ::testing::Values(true));

TEST_P(TlsLimits, IncompleteHandshakeTimesOut) {
  Limits limits;
  limits.header_time = milliseconds(200);
  serve(limits);
  HttpConnection silent(address());
  EXPECT_TRUE(silent.is_ended());
  HttpConnection half(address());
  half.send(kBeginOfHandshake);
  EXPECT_TRUE(half.is_ended());
  // On a busy machine, a complete handshake may take longer, too.
  const auto is_served = [&] {
    try {
      return connect().ask("GET", "/v1/queue").status == 200;
    } catch (const std::runtime_error&) {
      return false;
    }
  };
  EXPECT_TRUE(wait_until(is_served, kPatience_s));
}

TEST_P(TlsLimits, PendingHandshakesCountAsConnections) {
  Limits limits;
  limits.connections = 2;
  limits.header_time = std::chrono::minutes(10);  // the handshakes must not time out before the end
  serve(limits);
  HttpConnection one(address());
  HttpConnection two(address());
  HttpAnswer answer;
  const auto answers = [&](int status) {
    answer = connect().ask("GET", "/v1/queue");
    return answer.status == status;
  };
  // The server needs time to accept both connections and, below, to remove them.
  EXPECT_TRUE(wait_until([&] { return answers(503); }, kPatience_s));
  EXPECT_EQ(answer.reason(), "CONNECTIONS_FULL");
  one.close();
  two.close();
  EXPECT_TRUE(wait_until([&] { return answers(200); }, kPatience_s));
}

TEST_P(TlsLimits, ServerStopsDuringPendingHandshakes) {
  EXPECT_TRUE(stops_at_once([this] {
    std::vector<HttpConnection> open;
    for (int i = 0; i < 20; ++i) open.emplace_back(address());
    return open;
  }));
}

// Each error that certificate and key files can have.
class TlsIdentity : public ::testing::Test {
 protected:
  std::string refusal() const {
    const auto read = tls::Identity::read(files.certificate, files.key);
    return read ? "accepted" : read.error().message;
  }
  /// Expects an error that contains `part`, from read() and, in one line, from the daemon.
  void expect_refusal(const std::string& part) const {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
    const Ended ended = run_daemon({"--tls-certificate", files.certificate.string(), "--tls-key",
                                    files.key.string(), "--check-config"});
    EXPECT_EQ(ended.status, 3);
    EXPECT_NE(ended.words.find(part), std::string::npos) << ended.words;
    EXPECT_EQ(std::count(ended.words.begin(), ended.words.end(), '\n'), 1) << ended.words;
  }

  TemporaryFolder folder;
  Authority authority;
  KeyPair pair = authority.issue({{"DNS:*.example.org", "DNS:localhost", "IP:fd00::20"}});
  KeyPairFiles files{folder.path()};
};

TEST_F(TlsIdentity, CoversTheNamesOfItsCertificate) {
  files.write({pair.certificate + authority.pem(), pair.key});
  const auto identity = tls::Identity::read(files.certificate, files.key);
  ASSERT_TRUE(identity) << identity.error().message;
  for (const char* host : {"rig.example.org", "RIG.EXAMPLE.ORG", "localhost", "[fd00::20]"}) {
    EXPECT_TRUE(tls::stands_for(**identity, host)) << host;
  }
  for (const char* host : {"a.rig.example.org", "example.org", ".example.org", "rig.example.net",
                           "fd00::20", "*.example.net", ""}) {
    EXPECT_FALSE(tls::stands_for(**identity, host)) << host;
  }
}

TEST_F(TlsIdentity, MismatchedFilesAreRefused) {
  files.write({pair.certificate, authority.issue().key});
  expect_refusal("is not the key of the first certificate in " + files.certificate.string());
  files.write({authority.pem() + pair.certificate, pair.key});
  expect_refusal("is not the key of the first certificate");
}

TEST_F(TlsIdentity, InvalidPemIsRefused) {
  files.write({"-----BEGIN CERTIFICATE-----\nnonsense\n", pair.key});
  expect_refusal(files.certificate.string() + ": has no certificate");
  files.write({pair.certificate, "nonsense"});
  expect_refusal(files.key.string() + ": has no key");
  files.write({pair.certificate + std::string(2 << 20, 'x'), pair.key});
  expect_refusal("larger than 1 MiB");
}

TEST_F(TlsIdentity, MissingFilesAreRefused) {
  files.write(pair);
  std::filesystem::remove(files.key);
  expect_refusal(files.key.string() + ": the TLS key cannot be read");
  std::filesystem::create_directory(files.key);
  expect_refusal(files.key.string() + ": not a regular file");
}

TEST_F(TlsIdentity, WorldReadableKeyIsRefused) {
  files.write(pair);
  std::filesystem::permissions(files.key, std::filesystem::perms(0644));
  expect_refusal("chmod 640");
  std::filesystem::permissions(files.key, std::filesystem::perms(0640));
  EXPECT_EQ(refusal(), "accepted");
}

TEST_F(TlsIdentity, CertificateWithoutKeyIsRefused) {
  files.write(pair);
  const Ended ended = run_daemon({"--tls-certificate", files.certificate.string()});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.words.find("--tls-key"), std::string::npos) << ended.words;
  const Ended other = run_daemon({"--tls-key", files.key.string()});
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.words.find("--tls-certificate"), std::string::npos) << other.words;
}

TEST_F(TlsIdentity, AddressBeyondLoopbackRequiresAnAdmin) {
  files.write(pair);
  for (const char* door : {"--http", "--grpc"}) {
    const Ended ended =
        run_daemon({"--tls-certificate", files.certificate.string(), "--tls-key",
                    files.key.string(), "--state-dir", (folder.path() / "state").string(), door,
                    "0.0.0.0:0", door == std::string("--http") ? "--grpc" : "--http", "[::1]:0"});
    EXPECT_EQ(ended.status, 4);
    EXPECT_NE(ended.words.find("--first-admin NAME"), std::string::npos) << ended.words;
    EXPECT_NE(ended.words.find(door), std::string::npos) << ended.words;
  }
}

}  // namespace
}  // namespace hydroprint::tests
