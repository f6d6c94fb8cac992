#include "hardware/drive/frame.h"

#include <gtest/gtest.h>

#include <random>

#include "hardware/drive/reply_reader.h"
#include "tests/support/campaign.h"

namespace hydroprint::drive {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Words = std::vector<std::uint16_t>;
using Found = ReplyReader::Found;

const Request kReadOfThree{1, Function::kReadHolding, 0x006b, 3, {}};
const Request kWriteOfOne{1, Function::kWriteOne, 0x0001, 0, {0x0003}};
const Bytes kReply = {1, 3, 6, 0x02, 0x2b, 0x00, 0x00, 0x00, 0x64};
const Words kWords = {0x022b, 0x0000, 0x0064};

Bytes rtu(const Bytes& body) { return frame_of(Framing::kRtu, 0, body); }
Bytes tcp(std::uint16_t transaction, const Bytes& body) {
  return frame_of(Framing::kTcp, transaction, body);
}
Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ReplyReader rtu_reader(const Request& request, const BusVariant& bus = {}) {
  return {request, 0, Framing::kRtu, bus};
}

// Modbus over serial line, 6.2.2: unit 2, function 7 has the checksum 0x1241. The check value of
// this CRC ("CRC-16/MODBUS") for the digits 1 to 9 is 0x4b37.
TEST(Frame, ChecksumsMatchPublishedOnes) {
  EXPECT_EQ(crc16(Bytes{0x02, 0x07}), 0x1241);
  EXPECT_EQ(crc16(Bytes{'1', '2', '3', '4', '5', '6', '7', '8', '9'}), 0x4b37);
  EXPECT_EQ(rtu({0x02, 0x07}), Bytes({0x02, 0x07, 0x41, 0x12}));
}

// The example of the Modbus messaging guide, 4.2: transaction 0x1501, one register at 4.
TEST(Frame, TheHeaderOfTcpMatchesTheSpecification) {
  EXPECT_EQ(tcp(0x1501, {0xff, 3, 0, 4, 0, 1}),
            Bytes({0x15, 0x01, 0, 0, 0, 6, 0xff, 3, 0, 4, 0, 1}));
}

TEST(Frame, AReplyIsFoundHoweverItsBytesArrive) {
  for (const Framing framing : {Framing::kRtu, Framing::kTcp}) {
    const Bytes all = frame_of(framing, 7, kReply);
    for (std::size_t cut = 0; cut < all.size(); ++cut) {
      ReplyReader reader(kReadOfThree, 7, framing, {});
      ASSERT_EQ(reader.add(std::span(all).first(cut)), Found::kNothing);
      ASSERT_EQ(reader.add(std::span(all).subspan(cut)), Found::kReply);
      EXPECT_EQ(**reader.reply(), kWords);
    }
  }
}

TEST(Frame, RepliesToOtherRequestsArePassedOverAndCounted) {
  const std::vector<Bytes> others = {{1, 3, 4, 0, 1, 0, 2},        // another number of words
                                     {1, 4, 6, 0, 1, 0, 2, 0, 3},  // another function
                                     {2, 3, 6, 0, 1, 0, 2, 0, 3},  // another unit
                                     {1, 6, 0, 1, 0, 3},
                                     {1, 0x84, 2}};  // a write, another function's exception
  for (const Bytes& other : others) {
    ReplyReader reader = rtu_reader(kReadOfThree);
    EXPECT_EQ(reader.add(rtu(other)), Found::kNothing);
    EXPECT_NE(reader.trouble(), "");
    EXPECT_EQ(reader.add(rtu(kReply)), Found::kReply);
    EXPECT_EQ(**reader.reply(), kWords);
    EXPECT_EQ(reader.others(), 1U);
  }
}

TEST(Frame, OverTcpOnlyTheTransactionIdDecides) {
  ReplyReader reader(kReadOfThree, 7, Framing::kTcp, {});
  EXPECT_EQ(reader.add(tcp(6, {1, 3, 6, 9, 9, 9, 9, 9, 9})), Found::kNothing);
  EXPECT_NE(reader.trouble().find("another transaction id"), std::string::npos);
  EXPECT_EQ(reader.add(tcp(7, kReply)), Found::kReply);
  EXPECT_EQ(**reader.reply(), kWords);
}

TEST(Frame, NoiseBeforeAReplyDoesNotHideIt) {
  const std::vector<Bytes> noises = {{0}, {1}, {0xff, 0xff}, {1, 3}};
  for (const Bytes& noise : noises) {
    ReplyReader reader = rtu_reader(kReadOfThree);
    const Bytes all = noise + rtu(kReply);
    Found found = Found::kNothing;
    for (const std::uint8_t byte : all) found = reader.add(Bytes{byte});
    EXPECT_EQ(found, Found::kReply);
  }
}

TEST(Frame, ADamagedReplyIsReportedAtOnce) {
  Bytes bytes = rtu(kReply);
  bytes[4] ^= 0x10U;
  ReplyReader reader = rtu_reader(kReadOfThree);
  EXPECT_EQ(reader.add(bytes), Found::kDamaged);
}

TEST(Frame, AnEchoOfAReadIsRecognised) {
  const Bytes request = rtu(encode_request(kReadOfThree));
  ReplyReader reader = rtu_reader(kReadOfThree);
  Found found = Found::kNothing;
  for (const std::uint8_t byte : request) {
    ASSERT_EQ(found, Found::kNothing);
    found = reader.add(Bytes{byte});
  }
  EXPECT_EQ(found, Found::kEcho);
}

// The reply to function 6 equals its request, byte for byte.
TEST(Frame, WithAnEchoOnlyTheSecondCopyConfirmsAWrite) {
  const BusVariant bus{.echo = true};
  const Bytes copy = rtu(encode_request(kWriteOfOne));
  ReplyReader reader = rtu_reader(kWriteOfOne, bus);
  EXPECT_EQ(reader.add(copy), Found::kNothing);
  EXPECT_EQ(reader.add(copy), Found::kReply);
  ReplyReader at_once = rtu_reader(kWriteOfOne, bus);
  EXPECT_EQ(at_once.add(copy + copy), Found::kReply);
}

TEST(Frame, AnExpectedEchoThatIsMissingIsNamed) {
  ReplyReader reader = rtu_reader(kReadOfThree, {.echo = true});
  EXPECT_EQ(reader.add(rtu(kReply)), Found::kNothing);
  EXPECT_NE(reader.trouble().find("Remove echo = true"), std::string::npos) << reader.trouble();
}

TEST(Frame, UnitsOfGatewaysAreNamedOrAccepted) {
  for (const std::uint8_t unit : {std::uint8_t{0}, std::uint8_t{255}}) {
    Bytes reply = kReply;
    reply[0] = unit;
    ReplyReader reader(kReadOfThree, 7, Framing::kTcp, {});
    EXPECT_EQ(reader.add(tcp(7, reply)), Found::kNothing);
    EXPECT_NE(reader.trouble().find("set unit_any = true"), std::string::npos) << reader.trouble();
    ReplyReader any(kReadOfThree, 7, Framing::kTcp, {.unit_any = true});
    EXPECT_EQ(any.add(tcp(7, reply)), Found::kReply);
    EXPECT_EQ(**any.reply(), kWords);
  }
}

TEST(Frame, RtuFramesOverTcpAreNamed) {
  ReplyReader reader(kReadOfThree, 7, Framing::kTcp, {});
  EXPECT_EQ(reader.add(rtu(kReply)), Found::kNothing);
  EXPECT_NE(reader.trouble().find("Set rtu_over_tcp = true"), std::string::npos)
      << reader.trouble();
}

// Any bytes: no crash, and a reply is only ever one that is in the bytes with its checksum.
TEST(Frame, RandomBytesGiveNoReplyThatIsNotThere) {
  std::mt19937 random(testing::campaign_seed(5));
  for (int i = 0; i < testing::campaign_rounds(20000); ++i) {
    const Framing framing = i % 2 == 0 ? Framing::kRtu : Framing::kTcp;
    const Request& request = i % 3 == 0 ? kWriteOfOne : kReadOfThree;
    Bytes all = frame_of(framing, 7, i % 3 == 0 ? encode_request(request) : kReply);
    for (auto flips = random() % 3; flips > 0; --flips) {
      all[random() % all.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    if (i % 5 == 0) all.resize(random() % all.size());
    Bytes noise(random() % 12);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random() % 5);
    all = noise + all;
    ReplyReader reader(request, 7, framing, {.echo = i % 7 == 0, .unit_any = i % 11 == 0});
    Found found = Found::kNothing;
    for (std::size_t at = 0; at < all.size() && found == Found::kNothing;) {
      const std::size_t size = std::min(all.size() - at, std::size_t{1} + random() % 6);
      found = reader.add(std::span(all).subspan(at, size));
      at += size;
    }
    (void)reader.trouble();
    if (found != Found::kReply) continue;
    bool is_there = false;
    for (std::size_t begin = 0; begin < all.size(); ++begin) {
      const ReplyFrame frame = first_frame(framing, std::span(all).subspan(begin));
      is_there = is_there || (frame.kind == ReplyFrame::Kind::kWhole &&
                              (framing == Framing::kRtu || frame.transaction == 7));
    }
    EXPECT_TRUE(is_there);
  }
}

}  // namespace
}  // namespace hydroprint::drive
