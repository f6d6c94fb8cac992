#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "daemon/auth/accounts.h"
#include "daemon/store/database/schema.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::auth {

/// Accounts in a folder of the test, with an adjustable clock and the cheapest password hashes.
class PeopleTest : public ::testing::Test {
 protected:
  static constexpr std::int64_t kMinute_ms = 60'000;
  static constexpr std::int64_t kHour_ms = 60 * kMinute_ms;
  static constexpr const char* kPassword = "correct horse";

  PeopleTest() { open(); }

  /// Opens the store as a daemon does at the start, as if the previous one had been killed.
  void open() {
    accounts.reset();
    database.reset();
    database = daemon::open_store(folder.path() / "hydroprint.db").value();
    options.password_cost = {kLeastPasswordMemory_kib, 1};
    accounts = Accounts::open(*database, options, [this] { return now_ms; }).value();
  }
  /// A user with kPassword.
  void add(const std::string& name, Role role = Role::kMaker) {
    const auto made = accounts->users().create({name, role, false, "", 0}, kPassword);
    ASSERT_TRUE(made) << made.error().message;
  }
  [[nodiscard]] std::string reason_of(const Error& error) const {
    return std::string(name_of(error.reason));
  }

  hydroprint::testing::TemporaryFolder folder;
  std::int64_t now_ms = 1'000'000'000;
  AccountsOptions options;
  std::unique_ptr<daemon::Database> database;
  std::unique_ptr<Accounts> accounts;
};

}  // namespace hydroprint::auth
