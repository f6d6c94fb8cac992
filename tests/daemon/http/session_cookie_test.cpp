// Sign-in with a browser: the cookie, the token that must accompany it, and API keys for scripts.
#include <gtest/gtest.h>

#include "tests/daemon/api/people_support.h"
#include "tests/daemon/http/http_client.h"

namespace hydroprint::tests {
namespace {

class HttpSession : public PeopleApi {
 protected:
  HttpAnswer post(const std::string& target, const nlohmann::json& body,
                  const std::string& fields = "") {
    return HttpConnection(daemon.http()).ask("POST", target, body.dump(), fields);
  }
  HttpAnswer get(const std::string& target, const std::string& fields = "") {
    return HttpConnection(daemon.http()).ask("GET", target, "", fields);
  }
  /// The Cookie header of a signed-in browser, and the CSRF token of its page.
  struct Browser {
    std::string cookie, csrf;
    [[nodiscard]] std::string both() const {
      return cookie + "X-Hydroprint-Csrf: " + csrf + "\r\n";
    }
  };
  Browser sign_in_there(const std::string& name) {
    const HttpAnswer answer = post("/v1/session:signIn", {{"user", name}, {"password", kPassword}});
    EXPECT_EQ(answer.status, 200) << answer.body;
    const std::string set = answer.field("set-cookie");
    EXPECT_NE(set.find("; HttpOnly; SameSite=Strict"), std::string::npos) << set;
    EXPECT_EQ(answer.json().at("sessionToken"), "")
        << "scripts of the page must not see the session token";
    return {"Cookie: " + set.substr(0, set.find(';')) + "\r\n", answer.json().at("csrfToken")};
  }
};

TEST_F(HttpSession, CookieIsHiddenFromScripts) {
  const Browser maker = sign_in_there("maker");
  const HttpAnswer who = get("/v1/session", maker.cookie);
  EXPECT_EQ(who.status, 200) << who.body;
  EXPECT_EQ(who.json().at("user"), "maker");
  EXPECT_EQ(who.json().at("csrfToken"), maker.csrf) << "a reloaded page gets the same token";
  EXPECT_EQ(get("/v1/jobs").status, 401);
  EXPECT_EQ(get("/v1/jobs", maker.cookie).status, 200);
}

TEST_F(HttpSession, ChangesRequireTheCsrfToken) {
  const Browser admin = sign_in_there("admin");
  const auto pause = [&](const std::string& fields) {
    return post("/v1/queue:pause", {{"reason", "new film"}}, fields);
  };
  EXPECT_EQ(pause(admin.cookie).status, 403);
  EXPECT_EQ(pause(admin.cookie).reason(), "CSRF_TOKEN_MISSING");
  EXPECT_EQ(pause(admin.cookie + "X-Hydroprint-Csrf: " + std::string(64, '0') + "\r\n").reason(),
            "CSRF_TOKEN_MISSING");
  EXPECT_EQ(pause(admin.cookie + "X-Hydroprint-Csrf: \r\n").reason(), "CSRF_TOKEN_MISSING");
  EXPECT_EQ(pause(admin.both() + "Origin: http://elsewhere.example\r\n").reason(),
            "ORIGIN_FORBIDDEN");
  EXPECT_EQ(pause(admin.both()).status, 200);
}

TEST_F(HttpSession, TheCallerIsCheckedBeforeTheBodyIsRead) {
  for (const char* const request : {"POST /v1/jobs", "PATCH /v1/uploads/x"}) {
    HttpConnection connection(daemon.http());
    connection.send(std::string(request) +
                    " HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n");
    EXPECT_EQ(connection.read_answer().status, 401) << request;
  }
}

TEST_F(HttpSession, CsrfTokenOfAnotherSessionIsRefused) {
  const Browser viewer = sign_in_there("viewer");
  const Browser admin = sign_in_there("admin");
  const auto pause = [&](const std::string& fields) {
    return post("/v1/queue:pause", {{"reason", "x"}}, fields);
  };
  EXPECT_EQ(pause(admin.cookie + "X-Hydroprint-Csrf: " + viewer.csrf + "\r\n").reason(),
            "CSRF_TOKEN_MISSING");
  EXPECT_EQ(pause(viewer.both()).reason(), "ROLE_TOO_LOW");
}

TEST_F(HttpSession, EndsWithSignOut) {
  const Browser maker = sign_in_there("maker");
  const HttpAnswer out = post("/v1/session:signOut", nlohmann::json::object(), maker.both());
  EXPECT_EQ(out.status, 200) << out.body;
  EXPECT_NE(out.field("set-cookie").find("hydroprint_session=; "), std::string::npos);
  EXPECT_NE(out.field("set-cookie").find("Max-Age=0"), std::string::npos);
  EXPECT_EQ(get("/v1/jobs", maker.cookie).reason(), "SIGN_IN_NEEDED");
}

TEST_F(HttpSession, ApiKeyNeedsNoCsrfToken) {
  const std::string key = "Authorization: Bearer " + keys.at("operator") + "\r\n";
  EXPECT_EQ(post("/v1/queue:pause", {{"reason", "x"}}, key).status, 200);
  EXPECT_EQ(
      post("/v1/queue:resume", nlohmann::json::object(), "Authorization: Bearer hp_nothing\r\n")
          .status,
      401);
}

TEST_F(HttpSession, WrongPasswordsAreCountedAndThrottled) {
  const auto attempt = [&] {
    return post("/v1/session:signIn", {{"user", "maker"}, {"password", "wrong"}});
  };
  EXPECT_EQ(attempt().reason(), "SIGN_IN_FAILED");
  HttpAnswer last;
  for (int i = 0; i < 20 && last.reason() != "TOO_MANY_ATTEMPTS"; ++i) last = attempt();
  EXPECT_EQ(last.status, 429) << last.body;
  EXPECT_EQ(get("/metrics").body.find("hydroprint_rejected_logins_total 0\n"), std::string::npos);
}

TEST_F(HttpSession, EventStreamEndsWithTheSession) {
  const Browser maker = sign_in_there("maker");
  HttpConnection stream(daemon.http());
  stream.send("GET /v1/events:watch?topics=queue HTTP/1.1\r\nHost: localhost\r\n" + maker.cookie +
              "\r\n");
  EXPECT_EQ(stream.read_head().status, 200);
  EXPECT_EQ(post("/v1/session:signOut", nlohmann::json::object(), maker.both()).status, 200);
  for (int i = 0; i < 1000; ++i) {
    const HttpEvent event = stream.read_event();
    if (event.kind != "error") continue;
    EXPECT_NE(event.data.find("SIGN_IN_NEEDED"), std::string::npos) << event.data;
    return;
  }
  FAIL() << "the stream continued after the sign-out";
}

}  // namespace
}  // namespace hydroprint::tests
