#include "hardware/printer/address.h"

#include <gtest/gtest.h>

namespace hydroprint::printer {
namespace {

TEST(PrinterAddress, ReadsHostPortAndPath) {
  const auto plain = parse_address("ipp://office.local/ipp/print");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->host, "office.local");
  EXPECT_EQ(plain->port, 631);
  EXPECT_EQ(plain->resource, "/ipp/print");
  EXPECT_FALSE(plain->encrypted);
  const auto tls = parse_address("ipps://192.0.2.7:8631/ipp/print/2");
  ASSERT_TRUE(tls);
  EXPECT_EQ(tls->port, 8631);
  EXPECT_EQ(tls->resource, "/ipp/print/2");
  EXPECT_TRUE(tls->encrypted);
}

TEST(PrinterAddress, RefusesInvalidAddresses) {
  for (const char* uri :
       {"", "office.local", "http://office.local/ipp", "ipp://", "ipp:///ipp/print",
        "lpd://office.local/queue", "ipp://office.local:99999/ipp"}) {
    const auto address = parse_address(uri);
    ASSERT_FALSE(address) << uri;
    EXPECT_EQ(address.error().code, Code::kInvalidArgument);
    EXPECT_EQ(address.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace hydroprint::printer
