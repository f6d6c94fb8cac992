#include <gtest/gtest.h>

#include "hardware/drive/serial_line.h"
#include "hardware/drive/transaction.h"

namespace hydroprint::drive {
namespace {

TEST(Endpoint, ParsingTheTextGivesTheSameEndpoint) {
  for (const char* text : {"tcp:192.168.1.20:502", "rtu:/dev/ttyUSB0?baud=9600&parity=N&stop=2",
                           "rtu:/dev/serial/by-id/usb-A_b?baud=115200&parity=E&stop=1"}) {
    const auto endpoint = parse_endpoint(text);
    ASSERT_TRUE(endpoint) << endpoint.error().message;
    EXPECT_EQ(endpoint->text(), text);
  }
}

TEST(Endpoint, OmittedOptionsHaveDefaults) {
  EXPECT_EQ(parse_endpoint("rtu:/dev/ttyUSB0")->text(),
            "rtu:/dev/ttyUSB0?baud=115200&parity=E&stop=1");
  EXPECT_EQ(parse_endpoint("tcp:localhost:1502")->text(), "tcp:127.0.0.1:1502");
}

TEST(Endpoint, ErrorsNameTheExpectedFormat) {
  for (const char* text :
       {"", "tcp", "tcp:", "tcp:1.2.3.4", "tcp:1.2.3.4:0", "tcp:1.2.3.4:65536", "tcp:drive.lan:502",
        "tcp:1.2.3:502", "tcp:1.2.3.4:5x", "rtu:", "rtu:ttyUSB0", "rtu:/dev/a?baud=12345",
        "rtu:/dev/a?parity=X", "rtu:/dev/a?stop=3", "rtu:/dev/a?speed=1", "rtu:/dev/a?baud",
        "udp:1.2.3.4:5", "tcp:1.2.3.4:502\n"}) {
    const auto endpoint = parse_endpoint(text);
    ASSERT_FALSE(endpoint) << text;
    EXPECT_EQ(endpoint.error().code, Code::kInvalidArgument);
    EXPECT_NE(endpoint.error().message.find("Use tcp:192.168.1.20:502"), std::string::npos);
    EXPECT_EQ(endpoint.error().message.find('\n'), std::string::npos);
  }
}

TEST(SerialLine, BytesAndGapsHaveTheSpecifiedDuration) {
  // A character has 11 bits with parity (8E1) and 10 bits without (8N1). The gap between frames is
  // 1.75 ms above 19200 baud, and otherwise 3.5 characters.
  const auto ms = [](auto time) { return std::chrono::duration<double, std::milli>(time).count(); };
  EXPECT_NEAR(ms(wire_time(*parse_endpoint("rtu:/a?baud=9600&parity=E"), 8)), 9.1667, 1e-3);
  EXPECT_NEAR(ms(wire_time(*parse_endpoint("rtu:/a?baud=115200&parity=N"), 25)), 2.1701, 1e-3);
  EXPECT_NEAR(ms(frame_gap(*parse_endpoint("rtu:/a?baud=9600&parity=E"))), 4.0104, 1e-3);
  EXPECT_NEAR(ms(frame_gap(*parse_endpoint("rtu:/a?baud=115200"))), 1.75, 1e-9);
}

}  // namespace
}  // namespace hydroprint::drive
