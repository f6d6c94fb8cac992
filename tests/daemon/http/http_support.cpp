#include "tests/daemon/http/http_support.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace hydroprint::tests {

std::string HttpTest::upload(const std::string& bytes) {
  const nlohmann::json wanted = {{"sizeBytes", bytes.size()}, {"sha256", hash_of(bytes)}};
  const auto started = post("/v1/uploads", wanted.dump()).json();
  if (started.contains("asset")) return started.at("asset").at("name");
  const std::string name = started.at("upload").at("name");
  const HttpAnswer sent = ask(daemon.http(), "PATCH", "/v1/" + name, bytes, "Upload-Offset: 0\r\n");
  return sent.json().at("name");
}

std::string HttpTest::simulate(const std::string& mesh) {
  const nlohmann::json job = {
      {"simulate", {{"mesh", {{"name", "m.obj"}, {"asset", upload(mesh)}}}}}};
  return post("/v1/jobs", job.dump()).json().at("name");
}

void HttpLimits::serve(const http::Limits& limits) {
  server.reset();
  http::Options options;
  options.host = "127.0.0.1";
  options.limits = limits;
  if (GetParam()) {
    const hydroprint::testing::KeyPairFiles files(folder.path());
    files.write(authority.issue());
    const auto identity = tls::Identity::read(files.certificate, files.key);
    if (!identity) throw std::runtime_error(identity.error().message);
    options.identity = [shown = *identity] { return shown; };
  }
  // This server admits every caller; the daemon behind it checks them.
  const auto admit = [](std::string_view, const auth::Credentials&) {
    return Result<std::optional<auth::Caller>>(std::nullopt);
  };
  http::Sources sources{admit,
                        [] {
                          return http::Health{true, "{}"};
                        },
                        [] { return std::string(); }};
  auto started = http::Server::start(options, client.channel, sources);
  if (!started) throw std::runtime_error(started.error().message);
  server = std::move(*started);
  address_ = "127.0.0.1:" + std::to_string(server->port());
}

bool HttpLimits::stops_at_once(const std::function<std::vector<HttpConnection>()>& open) {
  constexpr double kStopPatience_s = 2;  // kStopPatience in server.cpp
  for (int attempt = 0; attempt < 3; ++attempt) {
    serve({});
    const auto clients = open();
    if (hydroprint::testing::seconds_of([&] { server.reset(); }) < kStopPatience_s) return true;
  }
  return false;
}

std::size_t memory_bytes(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  std::size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace hydroprint::tests
