// The serial line: its timing, its lock, and an independent client.
#include <modbus/modbus.h>

#include <algorithm>
#include <array>
#include <thread>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {
namespace {

/// Duration of a poll of the virtual drive in seconds: 8 bytes of request and 5 + 18 bytes of
/// reply, each of 11 bits (8E1), and a gap after each of the two frames.
double arithmetic_s(double baud, double gap_s) { return (8 + 23) * 11 / baud + 2 * gap_s; }

/// Shortest duration of a poll, because a busy machine only adds delays. Measures until a poll is
/// about as fast as the wire allows, for at most 5 s.
double measured_s(int baud, double expected_s) {
  BenchRig bench("rtu", {.arguments = {"--baud", std::to_string(baud)}});
  EXPECT_TRUE(bench.drive().connect());
  const Clock::time_point begun = Clock::now();
  double least_s = 1;
  do {
    // Measures two polls at a time, because the gap after a frame delays the next poll.
    const double two_s = seconds_of([&] {
      EXPECT_TRUE(bench.drive().poll());
      EXPECT_TRUE(bench.drive().poll());
    });
    least_s = std::min(least_s, two_s / 2);
  } while (least_s > 1.2 * expected_s && Clock::now() - begun < std::chrono::seconds(5));
  return least_s;
}

TEST(SerialLine, HasTheTimingOfALineAt9600Baud) {
  const double expected_s = arithmetic_s(9600, 3.5 * 11 / 9600.0);
  EXPECT_NEAR(measured_s(9600, expected_s), expected_s, 0.2 * expected_s);
}

TEST(SerialLine, HasTheTimingOfALineAt115200Baud) {
  const double expected_s = arithmetic_s(115200, 1.75e-3);
  EXPECT_NEAR(measured_s(115200, expected_s), expected_s, 0.2 * expected_s);
}

TEST(SerialLine, IsLockedByOneProgram) {
  BenchRig bench("rtu");
  HP_ASSERT_OK(bench.drive().connect());
  const auto other = bench.other_link({});
  const Status taken = other->connect();
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().reason, ErrorReason::RIG_OFFLINE);
  EXPECT_NE(taken.error().message.find("in use by another program. Stop that program"),
            std::string::npos)
      << taken.error().message;
  HP_ASSERT_OK(bench.drive().poll());
  bench.drive().disconnect();
  HP_ASSERT_OK(other->connect());
}

TEST(SerialLine, ErrorsNameTheRemedy) {
  const testing::TemporaryFolder folder;
  const auto message = [](const std::string& device) {
    drive::Link link(*drive::parse_endpoint("rtu:" + device), {});
    const Status opened = link.connect();
    return opened ? std::string("opened") : opened.error().message;
  };
  EXPECT_NE(message((folder.path() / "none").string()).find("Plug in"), std::string::npos);
  EXPECT_NE(message(folder.write("file", "x").string()).find("not a serial line"),
            std::string::npos);
}

TEST(Tcp, AMissingConnectionIsReportedAtOnce) {
  drive::Link link(*drive::parse_endpoint("tcp:127.0.0.1:1"), {});
  const double took_s = seconds_of([&] { EXPECT_FALSE(link.connect()); });
  EXPECT_LT(took_s, 0.05);
  const auto words = link.transact({1, drive::Function::kReadHolding, 0, 1, {}});
  ASSERT_FALSE(words);
  EXPECT_EQ(words.error().reason, ErrorReason::RIG_OFFLINE);
}

// The client of libmodbus, which shares no code with ours.
TEST(VirtualDrive, RespondsToAnIndependentClient) {
  BenchRig bench("tcp");
  modbus_t* peer = modbus_new_tcp("127.0.0.1", bench.endpoint().port);
  ASSERT_EQ(modbus_connect(peer), 0);
  modbus_set_slave(peer, 1);
  std::array<std::uint16_t, 9> words{};
  ASSERT_EQ(modbus_read_registers(peer, 0x0000, 2, words.data()), 2);
  EXPECT_EQ(words[0], 0x4850);
  ASSERT_EQ(modbus_read_input_registers(peer, 0x0100, 9, words.data()), 9);
  EXPECT_EQ(words[0], 0xa55a);
  EXPECT_EQ(words[1], 0x0080) << "only the bit of the stop input, which is normally closed, is set";
  ASSERT_EQ(modbus_write_register(peer, 0x0300, 1), 1);
  // A move to 1.5 mm at 20 mm/s with 200 mm/s^2.
  const std::array<std::uint16_t, 6> move = {4, 0, 15000, 0, 20000, 2000};
  ASSERT_EQ(modbus_write_registers(peer, 0x0300, 6, move.data()), 6);
  do {
    std::this_thread::sleep_for(milliseconds(20));
    ASSERT_EQ(modbus_read_input_registers(peer, 0x0100, 9, words.data()), 9);
  } while (words[1] == 0x0085);
  EXPECT_EQ(words[1], 0x0081) << "the drive must be enabled and at rest after the move";
  EXPECT_EQ(words[3] << 16 | words[4], 15000);
  EXPECT_EQ(modbus_read_registers(peer, 0x7000, 1, words.data()), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_register(peer, 0x0300, 3), 1);
  EXPECT_EQ(modbus_read_bits(peer, 0, 1, reinterpret_cast<std::uint8_t*>(words.data())), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  modbus_close(peer);
  modbus_free(peer);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
