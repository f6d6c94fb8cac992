// Adapters that echo, and gateways that speak RTU over TCP or reply as another unit.
#include "tests/hardware/simulator/drive/adapter.h"

namespace hydroprint::simulated_drive {
namespace {

using Kind = Adapter::Kind;

/// The real client behind an adapter.
class OddBus : public ::testing::TestWithParam<Kind> {
 protected:
  [[nodiscard]] static const char* wire(Kind kind) {
    return kind == Kind::kUnit255 ? "tcp" : "rtu";
  }

  /// @param bus  the keys of the profile
  drive::Drive client(const Adapter& adapter, const BenchRig& bench, const drive::BusVariant& bus) {
    drive::DriveProfile profile = bench.profile();
    profile.bus = bus;
    const drive::LinkTiming timing{milliseconds(500), profile.response_timeout, profile.worst_delay,
                                   bus};
    return {profile, std::make_shared<drive::Link>(adapter.endpoint(), timing)};
  }
};

struct Remedy {
  drive::BusVariant bus;
  const char* what;
};

Remedy remedy(Kind kind) {
  switch (kind) {
    case Kind::kRtuOverTcp:
      return {{.rtu_over_tcp = true}, "rtu_over_tcp = true"};
    case Kind::kUnit255:
      return {{.unit_any = true}, "unit_any = true"};
    default:
      return {{.echo = true}, "echo = true"};
  }
}

TEST_P(OddBus, IsNamedWithItsRemedyAndNothingMoves) {
  BenchRig bench(wire(GetParam()));
  const Adapter adapter(GetParam(), bench);
  drive::Drive drive = client(adapter, bench, {});
  const auto found = drive.connect();
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find(remedy(GetParam()).what), std::string::npos)
      << found.error().message;
  EXPECT_FALSE(drive.enable());
  EXPECT_FALSE(drive.move_to(5, 5));
  EXPECT_EQ(bench.mode(), "off");
}

TEST_P(OddBus, IsSupportedByAKeyOfTheProfile) {
  BenchRig bench(wire(GetParam()));
  const Adapter adapter(GetParam(), bench);
  drive::Drive drive = client(adapter, bench, remedy(GetParam()).bus);
  HP_ASSERT_OK(drive.connect());
  HP_ASSERT_OK(drive.poll());
  HP_ASSERT_OK(drive.enable());
  HP_ASSERT_OK(drive.move_to(50, 10));
  EXPECT_EQ(bench.mode(), "move");
  HP_ASSERT_OK(drive.stop());
  EXPECT_NE(bench.mode(), "move");
  EXPECT_EQ(drive.link()->statistics().damaged_replies, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, OddBus,
                         ::testing::Values(Kind::kEcho, Kind::kRtuOverTcp, Kind::kUnit255),
                         [](const auto& kind) {
                           return std::string(kind.param == Kind::kEcho         ? "SerialEcho"
                                              : kind.param == Kind::kRtuOverTcp ? "SerialOverTcp"
                                                                                : "Unit255");
                         });

// The reply to a write of one register equals its request.
TEST(OddBusSerial, AnEchoIsNeverTakenForTheConfirmationOfAWrite) {
  BenchRig bench("rtu");
  const Adapter adapter(Kind::kDeafEcho, bench);
  drive::Link link(adapter.endpoint(),
                   {milliseconds(500), milliseconds(60), milliseconds(60), {.echo = true}});
  HP_ASSERT_OK(link.connect());
  const auto written = link.transact({1, drive::Function::kWriteOne, 0x0300, 0, {7}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().reason, ErrorReason::RIG_OFFLINE);
  EXPECT_TRUE(written.error().metadata.contains("timeout"));
}

TEST(OddBusSerial, AnEchoThatIsNotThereIsNamed) {
  BenchRig bench("rtu");
  drive::Link link(bench.endpoint(),
                   {milliseconds(500), milliseconds(60), milliseconds(60), {.echo = true}});
  HP_ASSERT_OK(link.connect());
  const auto words = link.transact({1, drive::Function::kReadHolding, 0, 1, {}});
  ASSERT_FALSE(words);
  EXPECT_NE(words.error().message.find("Remove echo = true"), std::string::npos)
      << words.error().message;
}

}  // namespace
}  // namespace hydroprint::simulated_drive
