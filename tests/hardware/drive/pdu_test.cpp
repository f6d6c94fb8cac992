#include "hardware/drive/pdu.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/campaign.h"

namespace hydroprint::drive {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Words = std::vector<std::uint16_t>;

const Request kRead{1, Function::kReadHolding, 0x006b, 3, {}};
const Request kWriteOneWord{1, Function::kWriteOne, 0x0001, 0, {0x0003}};
const Request kWriteTwoWords{1, Function::kWriteMany, 0x0001, 0, {0x000a, 0x0102}};

// The examples of the Modbus application protocol, 6.3, 6.6 and 6.12.
TEST(Frame, RequestsMatchTheExamplesInTheSpecification) {
  EXPECT_EQ(encode_request(kRead), Bytes({1, 3, 0x00, 0x6b, 0x00, 0x03}));
  EXPECT_EQ(encode_request(kWriteOneWord), Bytes({1, 6, 0x00, 0x01, 0x00, 0x03}));
  EXPECT_EQ(encode_request(kWriteTwoWords),
            Bytes({1, 0x10, 0x00, 0x01, 0x00, 0x02, 0x04, 0x00, 0x0a, 0x01, 0x02}));
}

TEST(Frame, RepliesMatchTheExamplesInTheSpecification) {
  EXPECT_EQ(*decode_reply(kRead, Bytes({1, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64})),
            Words({0x022b, 0x0000, 0x0064}));
  EXPECT_EQ(*decode_reply(kWriteOneWord, Bytes({1, 6, 0x00, 0x01, 0x00, 0x03})), Words());
  EXPECT_EQ(*decode_reply(kWriteTwoWords, Bytes({1, 0x10, 0x00, 0x01, 0x00, 0x02})), Words());
}

TEST(Frame, ExceptionsAreReportedAsTheDrivesReply) {
  const auto refused = decode_reply(kRead, Bytes({1, 0x83, 2}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::DRIVE_REFUSED);
  EXPECT_EQ(refused.error().code, Code::kFailedPrecondition);
  EXPECT_EQ(refused.error().metadata.at("exception"), "2");
  EXPECT_EQ(decode_reply(kRead, Bytes({1, 0x83, 6})).error().reason, ErrorReason::DRIVE_BUSY);
}

TEST(Frame, OtherBytesAreNotAReply) {
  const Bytes good = {1, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64};
  std::vector<std::pair<Request, Bytes>> cases = {
      {kRead, {2, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64}},     // another unit
      {kRead, {1, 4, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64}},     // another function
      {kRead, {1, 3, 4, 0x02, 0x2b, 0x00, 0x00}},                 // fewer words than requested
      {kRead, {1, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64, 0}},  // one byte too many
      {kRead, {1, 0x84, 2}},                                      // exception of another function
      {kRead, {1, 0x83, 2, 0}},
      {kWriteOneWord, {1, 6, 0x00, 0x02, 0x00, 0x03}},  // another address
      {kWriteOneWord, {1, 6, 0x00, 0x01, 0x00, 0x04}},  // another value
      {kWriteTwoWords, {1, 0x10, 0x00, 0x01, 0x00, 0x03}},
      {kWriteTwoWords, {1, 0x10, 0x00, 0x01}}};
  for (std::size_t cut = 0; cut < good.size(); ++cut) {
    cases.emplace_back(kRead, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(cut)));
  }
  for (const auto& [request, reply] : cases) {
    const auto words = decode_reply(request, reply);
    ASSERT_FALSE(words);
    EXPECT_EQ(words.error().reason, ErrorReason::REPLY_INVALID);
  }
}

TEST(Frame, RandomBytesNeitherCrashNorGiveExtraWords) {
  std::mt19937 random(testing::campaign_seed(3));
  for (int i = 0; i < testing::campaign_rounds(20000); ++i) {
    Bytes reply(random() % 20);
    for (auto& byte : reply)
      byte = static_cast<std::uint8_t>(random() % 8 == 0 ? random() : i % 17);
    if (reply.size() > 1 && i % 2 == 0) reply[0] = 1, reply[1] = i % 4 == 0 ? 3 : 16;
    const Request& request = i % 4 == 0 ? kRead : kWriteTwoWords;
    const auto words = decode_reply(request, reply);
    if (words) {
      EXPECT_EQ(words->size(), request.count);
    }
  }
}

}  // namespace
}  // namespace hydroprint::drive
