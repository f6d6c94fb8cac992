// Users, keys, sessions and links, with an adjustable clock.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "daemon/auth/secret.h"
#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::auth {
namespace {

using Users = PeopleTest;
using Keys = PeopleTest;
using Sessions = PeopleTest;
using Links = PeopleTest;

TEST_F(Users, FirstUserMustBeAnAdmin) {
  EXPECT_FALSE(accounts->users().any());
  const auto refused = accounts->users().create({"mae", Role::kOperator, false, "", 0}, kPassword);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::LAST_ADMIN);
  EXPECT_FALSE(accounts->users().any());
  add("ann", Role::kAdmin);
  EXPECT_TRUE(accounts->users().any());
}

TEST_F(Users, SurviveAKillOfTheDaemon) {
  add("ann", Role::kAdmin);
  add("mae");
  open();
  EXPECT_EQ(accounts->users().get("mae")->role, Role::kMaker);
  EXPECT_TRUE(accounts->sessions().sign_in("mae", kPassword, "p"));
  EXPECT_EQ(accounts->users().list("", 10).size(), 2U);
  EXPECT_EQ(accounts->users().list("ann", 10).front().name, "mae");
}

TEST_F(Users, LastAdminCannotBeRemoved) {
  add("ann", Role::kAdmin);
  EXPECT_EQ(accounts->users().remove("ann").error().reason, ErrorReason::LAST_ADMIN);
  EXPECT_EQ(accounts->users().update("ann", {Role::kMaker, {}}).error().reason,
            ErrorReason::LAST_ADMIN);
  EXPECT_EQ(accounts->users().update("ann", {{}, true}).error().reason, ErrorReason::LAST_ADMIN);
  add("bea", Role::kAdmin);
  EXPECT_TRUE(accounts->users().update("ann", {{}, true}));
  EXPECT_EQ(accounts->users().remove("bea").error().reason,
            ErrorReason::LAST_ADMIN);  // ann is disabled
  EXPECT_TRUE(accounts->users().remove("ann"));
}

TEST_F(Users, NamesAreCheckedAndUnique) {
  add("ann", Role::kAdmin);
  for (const char* const name : {"", ".", "a b", "a/b", "-a", "a\n", "\xC3\xA4"}) {
    EXPECT_FALSE(accounts->users().create({name, Role::kMaker, false, "", 0}, "")) << name;
  }
  EXPECT_EQ(accounts->users().create({"ann", Role::kMaker, false, "", 0}, "").error().reason,
            ErrorReason::USER_EXISTS);
  EXPECT_EQ(accounts->users().create({"bob", Role::kMaker, false, "", 0}, "short").error().reason,
            ErrorReason::SPEC_INVALID);
}

TEST_F(Users, PasswordIsStoredOnlyAsArgon2idHash) {
  add("ann", Role::kAdmin);
  EXPECT_TRUE(accounts->users().get("ann")->password.starts_with("$argon2id$"));
  std::ifstream file(folder.path() / "hydroprint.db-wal", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(bytes.find("$argon2id$"), std::string::npos);
  EXPECT_EQ(bytes.find(kPassword), std::string::npos);
}

TEST_F(Users, BarringAppliesAtOnceToKeysAndSessions) {
  add("ann", Role::kAdmin);
  add("mae");
  const auto session = accounts->sessions().sign_in("mae", kPassword, "p").value();
  const auto key = accounts->keys().create({"mae", "k", Role::kMaker, 0}).value();
  ASSERT_TRUE(accounts->sessions().caller(session.token));
  ASSERT_TRUE(accounts->keys().caller(key.second));
  ASSERT_TRUE(accounts->users().update("mae", {{}, true}));
  EXPECT_FALSE(accounts->sessions().caller(session.token));
  EXPECT_FALSE(accounts->keys().caller(key.second));
  EXPECT_FALSE(accounts->sessions().sign_in("mae", kPassword, "p"));
}

TEST_F(Users, PasswordChangeEndsOtherSessions) {
  add("ann", Role::kAdmin);
  const auto one = accounts->sessions().sign_in("ann", kPassword, "p").value();
  const auto two = accounts->sessions().sign_in("ann", kPassword, "p").value();
  ASSERT_TRUE(accounts->users().set_password("ann", "battery staple", one.session.id));
  EXPECT_TRUE(accounts->sessions().caller(one.token));
  EXPECT_FALSE(accounts->sessions().caller(two.token));
  EXPECT_FALSE(accounts->sessions().sign_in("ann", kPassword, "p"));
  EXPECT_TRUE(accounts->sessions().sign_in("ann", "battery staple", "p"));
}

TEST_F(Users, DeletingAUserDeletesKeysAndSessions) {
  add("ann", Role::kAdmin);
  add("mae");
  const auto session = accounts->sessions().sign_in("mae", kPassword, "p").value();
  const auto key = accounts->keys().create({"mae", "k", Role::kMaker, 0}).value();
  const auto link = accounts->sessions().make_link("mae").value();
  ASSERT_TRUE(accounts->users().remove("mae"));
  add("mae");  // another user with the same name
  for (int i = 0; i < 2; ++i, open()) {
    EXPECT_FALSE(accounts->sessions().caller(session.token));
    EXPECT_FALSE(accounts->keys().caller(key.second));
    EXPECT_FALSE(accounts->sessions().sign_in_by_link(link.first, "p"));
  }
}

TEST_F(Keys, AreShownOnceAndExpire) {
  add("ann", Role::kAdmin);
  const auto [key, text] =
      accounts->keys().create({"ann", "bench", Role::kOperator, kHour_ms}).value();
  EXPECT_TRUE(text.starts_with("hp_" + key.id + "_"));
  EXPECT_EQ(accounts->keys().get(key.id)->secret_hash.find(text.substr(20)), std::string::npos);
  open();
  const auto caller = accounts->keys().caller(text);
  ASSERT_TRUE(caller);
  EXPECT_EQ(caller->name, "ann");
  EXPECT_EQ(caller->role, Role::kOperator);
  now_ms += kHour_ms;
  EXPECT_FALSE(accounts->keys().caller(text));
}

TEST_F(Keys, CannotBeGuessedFromTheirParts) {
  add("ann", Role::kAdmin);
  const auto text = accounts->keys().create({"ann", "", Role::kAdmin, 0})->second;
  std::string other = text;
  other.back() = other.back() == '0' ? '1' : '0';
  for (const std::string& wrong :
       {other, text.substr(0, text.size() - 1), text + "0", text.substr(3), std::string("hp_"),
        text.substr(0, text.rfind('_')), text.substr(0, text.rfind('_') + 1), std::string()}) {
    EXPECT_FALSE(accounts->keys().caller(wrong)) << wrong;
  }
  EXPECT_TRUE(accounts->keys().caller(text));
}

TEST_F(Keys, NeverAllowMoreThanTheUsersRole) {
  add("ann", Role::kAdmin);
  add("mae", Role::kOperator);
  const auto text = accounts->keys().create({"mae", "", Role::kOperator, 0})->second;
  ASSERT_TRUE(accounts->users().update("mae", {Role::kViewer, {}}));
  EXPECT_EQ(accounts->keys().caller(text)->role, Role::kViewer);
}

TEST_F(Keys, TimeOfLastUseSurvivesARestart) {
  add("ann", Role::kAdmin);
  const auto [key, text] = accounts->keys().create({"ann", "", Role::kAdmin, 0}).value();
  EXPECT_EQ(accounts->keys().get(key.id)->use_ms, 0);
  ASSERT_TRUE(accounts->keys().caller(text));
  ASSERT_TRUE(accounts->clean_up());
  open();
  EXPECT_EQ(accounts->keys().get(key.id)->use_ms, now_ms);
}

TEST_F(Keys, AreLimitedInNumber) {
  options.most_keys = 2;
  open();
  add("ann", Role::kAdmin);
  EXPECT_TRUE(accounts->keys().create({"ann", "", Role::kAdmin, 0}));
  EXPECT_TRUE(accounts->keys().create({"ann", "", Role::kAdmin, 0}));
  EXPECT_EQ(accounts->keys().create({"ann", "", Role::kAdmin, 0}).error().reason,
            ErrorReason::KEYS_FULL);
  ASSERT_TRUE(accounts->keys().remove(accounts->keys().list("ann", "", 10).front().id));
  EXPECT_TRUE(accounts->keys().create({"ann", "", Role::kAdmin, 0}));
}

TEST_F(Sessions, EndWhenUnused) {
  add("ann", Role::kAdmin);
  const auto in = accounts->sessions().sign_in("ann", kPassword, "p").value();
  now_ms += 12 * kHour_ms - 1;
  EXPECT_TRUE(accounts->sessions().caller(in.token));
  now_ms += 12 * kHour_ms - 1;
  EXPECT_TRUE(accounts->sessions().caller(in.token));
  now_ms += 12 * kHour_ms;
  EXPECT_FALSE(accounts->sessions().caller(in.token));
  ASSERT_TRUE(accounts->clean_up());
  now_ms -= 12 * kHour_ms;
  // A session that has ended stays ended, whatever the clock says.
  EXPECT_FALSE(accounts->sessions().caller(in.token));
}

TEST_F(Sessions, AreNotKeptAliveByListing) {
  add("ann", Role::kAdmin);
  const auto in = accounts->sessions().sign_in("ann", kPassword, "p").value();
  now_ms += 11 * kHour_ms;
  EXPECT_TRUE(accounts->sessions().caller(in.token, false));
  now_ms += kHour_ms;
  EXPECT_FALSE(accounts->sessions().caller(in.token));
}

TEST_F(Sessions, EndAfterAWeekEvenIfUsed) {
  add("ann", Role::kAdmin);
  const auto in = accounts->sessions().sign_in("ann", kPassword, "p").value();
  for (int hour = 1; hour < 7 * 24; ++hour) {
    now_ms += kHour_ms;
    ASSERT_TRUE(accounts->sessions().caller(in.token)) << hour;
  }
  now_ms += kHour_ms;
  EXPECT_FALSE(accounts->sessions().caller(in.token));
}

TEST_F(Sessions, AreListedRevokedAndSurviveARestart) {
  add("ann", Role::kAdmin);
  add("mae");
  const auto one = accounts->sessions().sign_in("ann", kPassword, "1.2.3.4").value();
  const auto two = accounts->sessions().sign_in("mae", kPassword, "5.6.7.8").value();
  open();
  EXPECT_EQ(accounts->sessions().list("", "", 10).size(), 2U);
  ASSERT_EQ(accounts->sessions().list("mae", "", 10).size(), 1U);
  EXPECT_EQ(accounts->sessions().list("mae", "", 10).front().peer, "5.6.7.8");
  EXPECT_EQ(accounts->sessions().caller(two.token)->session, two.session.id);
  ASSERT_TRUE(accounts->sessions().end(two.session.id));
  EXPECT_FALSE(accounts->sessions().caller(two.token));
  EXPECT_TRUE(accounts->sessions().caller(one.token));
  EXPECT_EQ(accounts->sessions().get(two.session.id).error().reason,
            ErrorReason::SESSION_NOT_FOUND);
}

TEST_F(Sessions, LimitEndsTheLeastRecentlyUsed) {
  options.sessions.most = 2;
  open();
  add("ann", Role::kAdmin);
  const auto one = accounts->sessions().sign_in("ann", kPassword, "p").value();
  now_ms += 1;
  const auto two = accounts->sessions().sign_in("ann", kPassword, "p").value();
  now_ms += 1;
  ASSERT_TRUE(accounts->sessions().caller(one.token));
  now_ms += 1;
  const auto three = accounts->sessions().sign_in("ann", kPassword, "p").value();
  EXPECT_TRUE(accounts->sessions().caller(one.token));
  EXPECT_FALSE(accounts->sessions().caller(two.token));
  EXPECT_TRUE(accounts->sessions().caller(three.token));
}

TEST_F(Sessions, CsrfTokenIsDerivedFromTheSessionToken) {
  const std::string one = csrf_token("token 1");
  EXPECT_EQ(one.size(), 64U);
  EXPECT_EQ(one, csrf_token("token 1"));
  EXPECT_NE(one, csrf_token("token 2"));
}

TEST_F(Links, WorkOnce) {
  add("ann", Role::kAdmin);
  const auto link = accounts->sessions().make_link("ann").value();
  open();
  const auto in = accounts->sessions().sign_in_by_link(link.first, "p");
  ASSERT_TRUE(in);
  EXPECT_EQ(accounts->sessions().caller(in->token)->name, "ann");
  EXPECT_EQ(accounts->sessions().sign_in_by_link(link.first, "p").error().reason,
            ErrorReason::SIGN_IN_FAILED);
}

TEST_F(Links, ExpireAfter15Minutes) {
  add("ann", Role::kAdmin);
  const auto link = accounts->sessions().make_link("ann").value();
  now_ms += 15 * kMinute_ms;
  EXPECT_FALSE(accounts->sessions().sign_in_by_link(link.first, "p"));
}

TEST_F(Links, NewLinkReplacesEarlierOnes) {
  add("ann", Role::kAdmin);
  const auto one = accounts->sessions().make_link("ann").value();
  const auto two = accounts->sessions().make_link("ann").value();
  EXPECT_FALSE(accounts->sessions().sign_in_by_link(one.first, "p"));
  EXPECT_TRUE(accounts->sessions().sign_in_by_link(two.first, "p"));
}

}  // namespace
}  // namespace hydroprint::auth
