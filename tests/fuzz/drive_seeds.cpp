// Creates inputs for fuzz_drive: real requests to each of the given drives, and the replies of the
// virtual rig. Usage: drive_seeds FOLDER PROFILE...
#include <filesystem>
#include <fstream>
#include <iostream>

#include "hardware/drive/command_encoder.h"
#include "hardware/simulator/drive/virtual_rig.h"
#include "tests/fuzz/exchange.h"

namespace hydroprint::fuzz {
namespace {

using drive::Command;
using drive::DriveProfile;
using drive::Function;
using drive::Request;

/// Writes inputs as files, and a list of them for -seed_inputs.
class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void add(const Bytes& input) {
    const std::string path = folder_ / std::to_string(count_++);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(input.data()), std::ssize(input));
    list_ += (list_.empty() ? "" : ",") + path;
  }
  [[nodiscard]] bool finish() const {
    return static_cast<bool>(std::ofstream(folder_ / "all") << list_ << std::flush);
  }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
  std::string list_;
};

simulated_drive::Plant plant_of(const DriveProfile& profile) {
  const auto& watchdog = profile.watchdog;
  const bool acts = watchdog && !watchdog->stopping.empty();
  simulated_drive::Registers registers(profile, watchdog ? watchdog->largest_time_s : 0,
                                       acts ? watchdog->stopping.front() : std::uint16_t{0});
  return {simulated_drive::machine_of(profile, {}), std::move(registers), 50};
}

Request read(const DriveProfile& profile, const drive::Block& block) {
  const Function function =
      block.space == drive::Space::kHolding ? Function::kReadHolding : Function::kReadInput;
  return {profile.unit, function, block.address, block.count, {}};
}

Bytes ask(simulated_drive::Plant& plant, const Request& request) {
  return plant.answer(encode_request(request)).reply;
}

void add_poll(Seeds& seeds, simulated_drive::Plant& plant, std::uint8_t number,
              const DriveProfile& profile) {
  std::vector<Bytes> replies;
  for (const drive::Block& block : profile.blocks) {
    replies.push_back(ask(plant, read(profile, block)));
  }
  seeds.add(input_of(number, replies));
}

void add_drive(Seeds& seeds, std::uint8_t number, const DriveProfile& profile) {
  simulated_drive::Plant plant = plant_of(profile);
  add_poll(seeds, plant, number, profile);
  for (std::size_t i = 0; i < drive::kCommands; ++i) {
    const auto requests = drive::requests_for(profile, static_cast<Command>(i), 12.5, 5);
    if (!requests) continue;
    for (const Request& request : *requests) seeds.add(input_of({request, ask(plant, request)}));
  }
  add_poll(seeds, plant, number, profile);
  const Request nowhere{profile.unit, Function::kReadHolding, 0xfff0, 4, {}};
  seeds.add(input_of({nowhere, ask(plant, nowhere)}));
  plant.set_reply_fault({simulated_drive::ReplyFaultKind::kBusy});
  const Request busy = read(profile, profile.blocks.front());
  seeds.add(input_of({busy, ask(plant, busy)}));
}

int make(const std::filesystem::path& folder, std::span<char*> profiles) {
  std::filesystem::create_directories(folder);
  Seeds seeds(folder);
  std::uint8_t number = 0;
  for (const char* const path : profiles) {
    const auto profile = drive::read_drive_profile(path);
    if (!profile) {
      std::cerr << "drive_seeds: " << profile.error().message << '\n';
      return 3;
    }
    add_drive(seeds, number++, *profile);
  }
  return seeds.finish() ? 0 : 4;
}

}  // namespace
}  // namespace hydroprint::fuzz

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  return hydroprint::fuzz::make(argv[1], {argv + 2, static_cast<std::size_t>(argc - 2)});
}
