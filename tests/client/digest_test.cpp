#include "client/digest.h"

#include <gtest/gtest.h>

namespace hydroprint::client {
namespace {

// FIPS 180-2, appendix B.1.
TEST(Digest, OfAbcIsTheStandardsExample) {
  Digest digest;
  digest.add("ab");
  digest.add("c");
  EXPECT_EQ(digest.finish(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace hydroprint::client
