#include "hardware/drive/block_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/paths.h"

namespace hydroprint::drive {
namespace {

bool contains(const Part& part, int begin, int end) {
  return part.address <= begin && end <= part.address + part.count;
}

bool is_whole_in_one(const std::vector<Part>& parts, int begin, int end) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const Part& part) { return contains(part, begin, end); });
}

bool is_in(const Block& block, const Field& field) {
  return block.space == field.space &&
         contains({block.address, block.count}, field.address, field.address + field.format.words);
}

std::vector<DriveProfile> shipped() {
  std::vector<DriveProfile> out;
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::source_path("hardware/profiles"))) {
    out.push_back(*read_drive_profile(entry.path()));
  }
  return out;
}

TEST(BlockParts, OfTheVirtualDriveAreItsStatusAndItsMotion) {
  const auto profile = *read_drive_profile(testing::drive_profile_path("virtual"));
  const auto parts = parts_of(profile, profile.blocks[0]);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].address, 0x0100);
  EXPECT_EQ(parts[0].count, 3);
  EXPECT_EQ(parts[1].address, 0x0103);
  EXPECT_EQ(parts[1].count, 6);
}

TEST(BlockParts, DifferInLengthFromEveryBlockAndFromEachOther) {
  for (const DriveProfile& profile : shipped()) {
    for (const Block& block : profile.blocks) {
      const auto parts = parts_of(profile, block);
      ASSERT_FALSE(parts.empty()) << profile.name;
      for (const Part& part : parts) {
        for (const Block& other : profile.blocks) EXPECT_NE(part.count, other.count);
        EXPECT_TRUE(
            contains({block.address, block.count}, part.address, part.address + part.count));
      }
      EXPECT_NE(parts.front().count, parts.size() == 2 ? parts.back().count : block.count);
    }
  }
}

TEST(BlockParts, HoldWhatTheProfileUsesAndSeparateNoNumber) {
  for (const DriveProfile& profile : shipped()) {
    for (const Block& block : profile.blocks) {
      const auto parts = parts_of(profile, block);
      EXPECT_TRUE(is_whole_in_one(parts, block.mark.address, block.mark.address + 1));
      for (const auto& place : profile.bits) {
        if (!place || !is_in(block, {place->space, place->address, {}})) continue;
        EXPECT_TRUE(is_whole_in_one(parts, place->address, place->address + 1)) << profile.name;
      }
      for (const Field& field : {profile.position, profile.velocity.value_or(profile.position),
                                 profile.alarm_code, profile.demand.value_or(profile.position)}) {
        if (!is_in(block, field)) continue;
        EXPECT_TRUE(is_whole_in_one(parts, field.address, field.address + field.format.words));
      }
      if (!is_in(block, profile.position) || !is_in(block, *profile.velocity)) continue;
      EXPECT_TRUE(
          is_whole_in_one(parts, std::min(profile.position.address, profile.velocity->address),
                          std::max(profile.position.address, profile.velocity->address) + 2))
          << profile.name << ": the two must be read at the same time";
    }
  }
}

}  // namespace
}  // namespace hydroprint::drive
