#include <gtest/gtest.h>

#include "sim/base/utf8.h"

namespace hydroprint {
namespace {

TEST(OneLine, ControlCharactersBecomeBlanks) {
  EXPECT_EQ(one_line("a\nb\r\tc\x1b[31m\x7f"), "a b  c [31m ");
}

TEST(OneLine, BytesThatAreNotUtf8BecomeReplacements) {
  EXPECT_EQ(one_line("Gr\xfcn.png"), "Gr\uFFFDn.png");
  EXPECT_EQ(one_line("Grün.png"), "Grün.png");
}

}  // namespace
}  // namespace hydroprint
