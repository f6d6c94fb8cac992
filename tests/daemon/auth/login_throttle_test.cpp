// Throttling of sign-in attempts, with an adjustable clock.
#include "daemon/auth/login_throttle.h"

#include <gtest/gtest.h>

#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::auth {
namespace {

class LoginThrottleTest : public ::testing::Test {
 protected:
  /// Fails to sign in until a wait is required; returns the number of attempts before that.
  int fail_at_once(const std::string& name, const std::string& peer) {
    int count = 0;
    while (attempts.begin(name, peer) == 0) ++count;
    return count;
  }
  /// Fails to sign in `times` times and waits as long as required; returns the last wait.
  std::int64_t fail_patiently(const std::string& name, const std::string& peer, int times) {
    std::int64_t wait_ms = 0;
    for (int i = 0; i < times;) {
      const std::int64_t left_ms = attempts.begin(name, peer);
      if (left_ms == 0) {
        ++i;
      } else {
        wait_ms = left_ms;
        now_ms += left_ms;
      }
    }
    return wait_ms;
  }

  std::int64_t now_ms = 1'000'000;
  LoginThrottle attempts{[this] { return now_ms; }};
};

TEST_F(LoginThrottleTest, WaitGrowsWithEachFailureUpToAMinute) {
  EXPECT_EQ(fail_at_once("ann", "p"), 3);
  EXPECT_EQ(attempts.begin("ann", "p"), 1000);
  EXPECT_EQ(fail_patiently("ann", "p", 1), 1000);
  EXPECT_EQ(fail_patiently("ann", "p", 1), 2000);
  EXPECT_EQ(fail_patiently("ann", "p", 1), 4000);
  EXPECT_EQ(fail_patiently("ann", "p", 30), 60'000);
}

TEST_F(LoginThrottleTest, WaitIsNotCutShort) {
  fail_at_once("ann", "p");
  now_ms += 999;
  EXPECT_EQ(attempts.begin("ann", "p"), 1);
  now_ms += 1;
  EXPECT_EQ(attempts.begin("ann", "p"), 0);
}

TEST_F(LoginThrottleTest, ManyNamesFromOneAddressAreThrottled) {
  int let_in = 0;
  for (int i = 0; i < 100; ++i) {
    if (attempts.begin("name" + std::to_string(i), "p") == 0) ++let_in;
  }
  EXPECT_EQ(let_in, 10);
  EXPECT_EQ(attempts.begin("ann", "q"), 0);
}

TEST_F(LoginThrottleTest, OneNameFromManyAddressesIsThrottledLess) {
  int let_in = 0;
  for (int i = 0; i < 100; ++i) {
    if (attempts.begin("ann", "p" + std::to_string(i)) == 0) ++let_in;
  }
  EXPECT_EQ(let_in, 10);
  for (int i = 0; i < 50; ++i) fail_patiently("ann", "q" + std::to_string(i), 1);
  EXPECT_LE(attempts.begin("ann", "r"), 10'000);
}

TEST_F(LoginThrottleTest, KnownAddressIsNeverLockedOut) {
  ASSERT_EQ(attempts.begin("ann", "home"), 0);
  attempts.succeeded("ann", "home");
  for (int i = 0; i < 100; ++i) (void)attempts.begin("ann", "p" + std::to_string(i));
  for (int i = 0; i < 100; ++i) (void)attempts.begin("x" + std::to_string(i), "home");
  EXPECT_GT(attempts.begin("ann", "elsewhere"), 0);
  EXPECT_GT(attempts.begin("bob", "home"), 0);
  EXPECT_EQ(attempts.begin("ann", "home"), 0);
}

TEST_F(LoginThrottleTest, SuccessResetsOnlyItsOwnFailures) {
  fail_at_once("ann", "p");
  now_ms += 1000;
  ASSERT_EQ(attempts.begin("ann", "p"), 0);
  attempts.succeeded("ann", "p");
  EXPECT_EQ(fail_at_once("ann", "p"), 3);
  EXPECT_EQ(attempts.failures(), 3 + 3);
}

TEST_F(LoginThrottleTest, FailuresAreForgottenAfterAnHour) {
  fail_patiently("ann", "p", 20);
  now_ms += 3'600'001;
  EXPECT_EQ(fail_at_once("ann", "p"), 3);
}

TEST_F(PeopleTest, ThrottlingAppliesToTheRightPasswordToo) {
  add("ann", Role::kAdmin);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(accounts->sessions().sign_in("ann", "wrong password", "p").error().reason,
              ErrorReason::SIGN_IN_FAILED);
  }
  const auto refused = accounts->sessions().sign_in("ann", kPassword, "p");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::TOO_MANY_ATTEMPTS);
  EXPECT_EQ(refused.error().metadata.at("retry_s"), "1");
  EXPECT_TRUE(accounts->sessions().sign_in("ann", kPassword, "q"));
  now_ms += 1000;
  EXPECT_TRUE(accounts->sessions().sign_in("ann", kPassword, "p"));
}

TEST_F(PeopleTest, UnknownNameIsRefusedLikeAWrongPassword) {
  add("ann", Role::kAdmin);
  const auto no_name = accounts->sessions().sign_in("nobody", "wrong password", "p").error();
  const auto no_password = accounts->sessions().sign_in("ann", "wrong password", "p").error();
  EXPECT_EQ(no_name.message, no_password.message);
  EXPECT_EQ(no_name.reason, no_password.reason);
}

}  // namespace
}  // namespace hydroprint::auth
