#include "hardware/simulator/drive/faults.h"

#include <gtest/gtest.h>

#include "hardware/simulator/drive/reply_bytes.h"

namespace hydroprint::simulated_drive {
namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

TEST(Faults, LinesOfTheControlSocketAreParsed) {
  const auto late = parse_action("fault late 700ms 3");
  ASSERT_TRUE(late) << late.error().message;
  EXPECT_EQ(late->kind, Action::Kind::kReplyFault);
  EXPECT_EQ(late->reply_fault.fault, ReplyFaultKind::kLate);
  EXPECT_EQ(late->reply_fault.delay, milliseconds(700));
  EXPECT_EQ(late->reply_fault.count, 3);
  EXPECT_EQ(parse_action("fault drop")->reply_fault.count, 1);
  EXPECT_EQ(parse_action("drop all")->reply_fault.count, -1);
  EXPECT_EQ(parse_action("silent")->reply_fault.fault, ReplyFaultKind::kDropRequest);
  EXPECT_EQ(parse_action("press stop")->input, Action::Input::kStopButton);
  EXPECT_EQ(parse_action("release positive-end")->kind, Action::Kind::kRelease);
  EXPECT_EQ(parse_action("stall")->kind, Action::Kind::kPress);
  EXPECT_EQ(parse_action("release stall")->input, Action::Input::kStall);
  EXPECT_EQ(parse_action("reboot 2s")->pause, milliseconds(2000));
  EXPECT_EQ(parse_action("unplug\r")->kind, Action::Kind::kUnplug);
  EXPECT_EQ(parse_action("camera frozen")->camera, simulated_scene::CameraState::kFrozen);
  const auto marker = parse_action("marker left knocked-over");
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->kind, Action::Kind::kMarker);
  EXPECT_EQ(marker->name, "left");
  EXPECT_EQ(marker->marker, simulated_scene::MarkerState::kKnockedOver);
  const auto push = parse_action("marker left pushed 3.5 -2");
  ASSERT_TRUE(push);
  EXPECT_EQ(push->kind, Action::Kind::kPush);
  EXPECT_EQ(push->push_mm, Eigen::Vector2d(3.5, -2));
  EXPECT_EQ(parse_action("hang held.json")->kind, Action::Kind::kSetObject);
  EXPECT_EQ(parse_action("hang held.json")->name, "held.json");
  EXPECT_EQ(parse_action("hang held.json mug.obj")->mesh, "mug.obj");
  const auto shown = parse_action("show \"/my home/held.json\" board.obj");
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->kind, Action::Kind::kShow);
  EXPECT_EQ(shown->name, "/my home/held.json");
  EXPECT_EQ(shown->mesh, "board.obj");
  EXPECT_EQ(parse_action("show nothing")->mesh, "");
}

TEST(Faults, OtherLinesAreRefusedWithTheListOfActions) {
  for (const char* line : {"",
                           " ",
                           "fault",
                           "fault late",
                           "fault late 5",
                           "fault late 5m",
                           "drop 0",
                           "drop x",
                           "drop 1 2",
                           "press",
                           "press all",
                           "stop",
                           "reboot soon",
                           "unplug 1s",
                           "fault late -1s",
                           "late 99999s",
                           "silent 3",
                           "camera",
                           "camera blue",
                           "marker left",
                           "marker left pushed 3",
                           "marker left pushed 3 x",
                           "marker left pushed 3 2000",
                           "hang",
                           "show held.json",
                           "show \"held.json board.obj",
                           "marker left gone"}) {
    const auto action = parse_action(line);
    ASSERT_FALSE(action) << line;
    EXPECT_NE(action.error().message.find("is not a known action. Use: "), std::string::npos);
  }
}

TEST(Faults, CommandLineFaultsHaveTimes) {
  const auto actions = parse_timed_actions("late=700ms@5s,press=stop@8s,stall");
  ASSERT_TRUE(actions) << actions.error().message;
  ASSERT_EQ(actions->size(), 3U);
  EXPECT_EQ((*actions)[0].at, milliseconds(5000));
  EXPECT_EQ((*actions)[0].action.reply_fault.delay, milliseconds(700));
  EXPECT_EQ((*actions)[1].action.input, Action::Input::kStopButton);
  EXPECT_EQ((*actions)[2].at, milliseconds(0));
  EXPECT_TRUE(parse_timed_actions("")->empty());
  for (const char* text : {"late@5s", "drop@5", "drop@", "drop,nonsense"}) {
    EXPECT_FALSE(parse_timed_actions(text)) << text;
  }
}

// The example in the Modbus serial line guide: unit 2, function 7, CRC 0x1241.
TEST(Wire, ChecksumMatchesTheSpecification) {
  EXPECT_EQ(serial_frame({0x02, 0x07}, ReplyFaultKind::kNone), Bytes({0x02, 0x07, 0x41, 0x12}));
}

TEST(Wire, EveryFaultChangesTheBytesItNames) {
  const Bytes reply = {1, 3, 4, 0xab, 0xcd, 0x12, 0x34};
  const Bytes header = {0, 7, 0, 0, 0, 6};
  const Bytes tcp = tcp_frame(header, reply, ReplyFaultKind::kNone);
  EXPECT_EQ(tcp, Bytes({0, 7, 0, 0, 0, 7, 1, 3, 4, 0xab, 0xcd, 0x12, 0x34}));
  const Bytes rtu = serial_frame(reply, ReplyFaultKind::kNone);
  EXPECT_TRUE(serial_frame(reply, ReplyFaultKind::kDrop).empty());
  EXPECT_EQ(serial_frame(reply, ReplyFaultKind::kTruncate), Bytes(rtu.begin(), rtu.begin() + 4));
  EXPECT_EQ(serial_frame(reply, ReplyFaultKind::kWrongId)[0], 0);
  EXPECT_EQ(serial_frame(reply, ReplyFaultKind::kWrongFunction)[1], 4);
  EXPECT_EQ(serial_frame(reply, ReplyFaultKind::kWrongLength).size(), rtu.size() - 2);
  const Bytes wrong_crc = serial_frame(reply, ReplyFaultKind::kWrongCrc);
  EXPECT_EQ(Bytes(wrong_crc.begin(), wrong_crc.end() - 2), reply);
  EXPECT_NE(wrong_crc, rtu);
  EXPECT_EQ(tcp_frame(header, reply, ReplyFaultKind::kWrongCrc)[1], 6)
      << "over TCP, the transaction id is wrong instead";
  EXPECT_EQ(tcp_frame(header, reply, ReplyFaultKind::kLate), tcp);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
