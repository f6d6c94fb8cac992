// A profile is untrusted. Either it is refused with a one-line error, or all values that are read
// from or written to a drive with it stay within bounds.
#include <cmath>
#include <fstream>
#include <span>

#include "hardware/drive/command_encoder.h"
#include "hardware/drive/state_decoder.h"
#include "tests/fuzz/expect.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::fuzz {
namespace {

using drive::DriveProfile;

void check_refusal(const Error& error, const std::string& file) {
  HP_EXPECT(error.message.find(file) != std::string::npos);
  HP_EXPECT(error.message.find('\n') == std::string::npos);
  HP_EXPECT(error.message.size() < 1000);
}

void check_polls(const DriveProfile& profile) {
  for (const unsigned word : {0x0000U, 0x0001U, 0x7fffU, 0x8000U, 0xffffU}) {
    std::vector<std::vector<std::uint16_t>> blocks;
    for (const drive::Block& block : profile.blocks) {
      HP_EXPECT(block.count >= 1 && block.count <= drive::kMaxReadWords);
      HP_EXPECT(block.address + block.count <= 0x10000);
      HP_EXPECT(block.mark.address - block.address < block.count);
      blocks.emplace_back(block.count, static_cast<std::uint16_t>(word));
    }
    const drive::DriveState state = drive::decode_state(profile, blocks);
    HP_EXPECT(!std::isnan(state.position_mm) && !std::isnan(state.velocity_mm_per_s));
  }
}

void check_commands(const DriveProfile& profile) {
  for (std::size_t i = 0; i < drive::kCommands; ++i) {
    const auto requests = drive::requests_for(profile, static_cast<drive::Command>(i), 10,
                                              profile.max_speed_mm_per_s);
    if (!requests) {
      HP_EXPECT(requests.error().reason == ErrorReason::LIMIT_EXCEEDED);
      continue;
    }
    for (const drive::Request& request : *requests) {
      const std::size_t words = request.values.size();
      HP_EXPECT(words >= 1 && words <= drive::kMaxWriteWords);
      HP_EXPECT(request.address + words <= 0x10000);
      HP_EXPECT(drive::encode_request(request).size() <= 253);
    }
  }
}

void try_profile(std::span<const char> text) {
  static const testing::TemporaryFolder folder;
  static const std::string file = folder.path() / "drive.toml";
  std::ofstream(file, std::ios::binary).write(text.data(), std::ssize(text));
  const auto profile = drive::read_drive_profile(file);
  if (!profile) return check_refusal(profile.error(), file);
  HP_EXPECT(profile->unit >= 1 && profile->unit <= 247);
  HP_EXPECT(profile->max_speed_mm_per_s > 0 && profile->stopping_deceleration_mm_per_s2 > 0);
  check_polls(*profile);
  check_commands(*profile);
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hydroprint::fuzz::try_profile({reinterpret_cast<const char*>(data), size});
  return 0;
}
