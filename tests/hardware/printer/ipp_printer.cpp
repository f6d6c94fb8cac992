#include "tests/hardware/printer/ipp_printer.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <stdexcept>
#include <thread>

namespace hydroprint::printer {
namespace {

/// Returns a free port.
int free_port() {
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  const bool done = ::bind(file, reinterpret_cast<sockaddr*>(&at), sizeof at) == 0 &&
                    ::getsockname(file, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  ::close(file);
  if (!done) throw std::runtime_error("no free port");
  return ntohs(at.sin_port);
}

void wait_until(const std::function<bool()>& is_so, const std::string& program) {
  for (int i = 0; i < 2400; ++i) {  // a long limit, because a busy machine is slow
    if (is_so()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  throw std::runtime_error(program + " did not start within the time limit");
}

}  // namespace

IppPrinter::IppPrinter(const std::string& command) : port_(free_port()) {
  const std::string bus = "unix:path=" + (folder_.path() / "bus").string();
  bus_ = std::make_unique<testing::Process>(std::vector<std::string>{
      "/usr/bin/dbus-daemon", "--session", "--address=" + bus, "--nofork"});
  wait_until([&] { return std::filesystem::exists(folder_.path() / "bus"); }, "dbus-daemon");
  const auto script =
      folder_.write("print.sh", "#!/bin/sh\nfor file; do :; done\n" + command + "\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  std::filesystem::create_directory(folder_.path() / "spool");
  process_ = std::make_unique<testing::Process>(std::vector<std::string>{
      "/usr/bin/env", "DBUS_SYSTEM_BUS_ADDRESS=" + bus, "/usr/sbin/ippeveprinter", "-r", "off",
      "-n", "localhost", "-p", std::to_string(port_), "-d", (folder_.path() / "spool").string(),
      "-k", "-f", "application/pdf,image/png", "-c", script.string(), "Test printer"});
  const Printer printer(address());
  wait_until([&] { return printer.attributes().has_value(); }, "ippeveprinter");
}

Address IppPrinter::address() const {
  return parse_address("ipp://localhost:" + std::to_string(port_) + "/ipp/print").value();
}

void IppPrinter::pull_the_plug() { process_.reset(); }

void IppPrinter::finish() const { std::ofstream(folder_.path() / "print.sh.end"); }

std::filesystem::path IppPrinter::spooled() const {
  std::vector<std::filesystem::path> out;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(folder_.path() / "spool")) {
    // skips the output of the print command
    if (entry.path().extension() != ".prn") out.push_back(entry.path());
  }
  if (out.size() != 1)
    throw std::runtime_error(std::to_string(out.size()) + " spooled files, not one");
  return out.front();
}

}  // namespace hydroprint::printer
