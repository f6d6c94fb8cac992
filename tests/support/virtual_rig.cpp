#include "tests/support/virtual_rig.h"

#include <signal.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/support/paths.h"
#include "tests/support/timing.h"

namespace hydroprint::testing {
namespace {

constexpr int kPatience_s = 60;     // long, for busy machines
constexpr int kNotePatience_s = 5;  // in a failed test, the rig may be stopped

std::vector<std::string> command(const VirtualRigOptions& options, const TemporaryFolder& folder) {
  for (const auto& [name, content] : options.files) folder.write(name, content);
  const auto scene =
      folder.write("scene.toml",
                   "[axis]\nstart_mm = " + std::to_string(options.start_mm) + "\n" + options.scene);
  std::vector<std::string> out = {testing::program_path("hydroprint-virtual-rig"),
                                  "--profile",
                                  options.profile,
                                  "--scene",
                                  scene,
                                  "--control",
                                  folder.path() / "control",
                                  "--json",
                                  "--" + options.wire,
                                  options.wire == "tcp" ? "0" : folder.path() / "drive"};
  out.insert(out.end(), options.arguments.begin(), options.arguments.end());
  return out;
}

/// Sends text to a socket and returns the whole reply; empty if nothing replies.
std::string reply_of(const std::string& path, const std::string& text,
                     int patience_s = kPatience_s) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const int out = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval limit{patience_s, 0};
  ::setsockopt(out, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  std::string reply;
  if (::connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::send(out, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size())) {
    ::shutdown(out, SHUT_WR);
    std::array<char, 512> chunk{};
    for (ssize_t got = 0; (got = ::read(out, chunk.data(), chunk.size())) > 0;) {
      reply.append(chunk.data(), static_cast<std::size_t>(got));
    }
  }
  ::close(out);
  return reply;
}

}  // namespace

VirtualRig::VirtualRig(const VirtualRigOptions& options)
    : profile_(options.profile), process_(command(options, folder_)) {
  const auto is_ready = [&] { return process_.out().ends_with('\n'); };
  (void)wait_until([&] { return is_ready() || !process_.running(); }, kPatience_s);
  if (!is_ready()) throw std::runtime_error("hydroprint-virtual-rig did not become ready");
  address_ = nlohmann::json::parse(process_.out()).at(options.wire);
}

std::string VirtualRig::act(const std::string& lines) const {
  const std::string reply = reply_of(control(), lines + "\n");
  if (reply.empty() || reply.starts_with("error")) throw std::runtime_error(lines + ": " + reply);
  return reply;
}

std::string VirtualRig::note() const {
  const std::string reply = reply_of(control(), "state\n", kNotePatience_s);
  return "hydroprint-virtual-rig " + (reply.empty() ? "does not respond\n" : "state: " + reply);
}

nlohmann::json VirtualRig::truth() const { return nlohmann::json::parse(act("state")); }

double VirtualRig::speed_mm_per_s() const {
  return std::abs(truth().at("velocity_mm_per_s").get<double>());
}

bool VirtualRig::gets_to(double wanted, double seconds) const {
  return wait_until([&] { return std::abs(speed_mm_per_s() - wanted) < 0.01; }, seconds);
}

double VirtualRig::rested_s() const {
  if (!wait_until([&] { return speed_mm_per_s() == 0; })) {
    throw std::runtime_error("the axis did not come to rest within the time limit");
  }
  return truth().at("rested_s");
}

std::string VirtualRig::section() const {
  return "[rig]\ndrive = \"" + address_ + "\"\nprofile = \"" + profile_ + "\"\n";
}

Ended VirtualRig::stop() {
  signal(SIGTERM);
  return process_.wait();
}

}  // namespace hydroprint::testing
