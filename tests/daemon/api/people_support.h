#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "tests/daemon/api/support.h"

namespace hydroprint::tests {

/// A daemon with a user for each role: "admin", "operator", "maker", "other" (also a maker) and
/// "viewer", all with the password kPassword.
class PeopleApi : public ::testing::Test {
 protected:
  static constexpr const char* kPassword = "correct horse";

  static DaemonProcess::Options options() {
    DaemonProcess::Options options = DaemonProcess::fake();
    options.max_jobs_per_owner = 4;
    options.extra =
        "max_mib_per_owner = 4\n[people]\npassword_memory_mib = 1\npassword_passes = 1\n";
    return options;
  }

  PeopleApi() {
    Client nobody(daemon.address());
    create(nobody, "admin", v1::ADMIN);
    keys["admin"] = key_of("admin");
    const auto admin = as("admin");
    create(*admin, "operator", v1::OPERATOR);
    create(*admin, "maker", v1::MAKER);
    create(*admin, "other", v1::MAKER);
    create(*admin, "viewer", v1::VIEWER);
    for (const char* const name : {"operator", "maker", "other", "viewer"}) {
      keys[name] = key_of(name);
    }
  }

  static void create(Client& client, const std::string& name, v1::Role role) {
    v1::CreateUserRequest request;
    request.mutable_user()->set_name("users/" + name);
    request.mutable_user()->set_role(role);
    request.set_password(kPassword);
    v1::User user;
    throw_unless_ok(client.people->CreateUser(client.context().get(), request, &user),
                    "CreateUser");
  }
  v1::SignInResponse sign_in(const std::string& name) {
    Client client(daemon.address());
    v1::SignInRequest request;
    request.set_user(name);
    request.set_password(kPassword);
    v1::SignInResponse reply;
    throw_unless_ok(client.people->SignIn(client.context().get(), request, &reply), "SignIn");
    return reply;
  }
  std::string key_of(const std::string& name) {
    Client client(daemon.address());
    client.session = sign_in(name).session_token();
    v1::CreateApiKeyResponse reply;
    throw_unless_ok(client.people->CreateApiKey(client.context().get(), {}, &reply),
                    "CreateApiKey");
    return reply.key();
  }
  /// A client with that user's key; without a key for "".
  std::unique_ptr<Client> as(const std::string& name) {
    auto client = std::make_unique<Client>(daemon.address());
    if (!name.empty()) client->key = keys.at(name);
    return client;
  }

  TemporaryFolder folder;
  DaemonProcess daemon{folder.path(), options()};
  std::map<std::string, std::string> keys;
};

}  // namespace hydroprint::tests
