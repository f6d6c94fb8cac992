#include "daemon/http/static_files.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::http {
namespace {

using hydroprint::testing::TemporaryFolder;

Head asked(const std::string& target, const std::string& name = "", const std::string& value = "") {
  Head head;
  head.method = "GET";
  head.target = target;
  if (!name.empty()) head.fields.add(name, value);
  return head;
}

class HttpStaticFiles : public ::testing::Test {
 protected:
  HttpStaticFiles() {
    std::filesystem::create_directories(folder.path() / "web" / "assets");
    folder.write("secret", "keep out");
    folder.write("web/index.html", "<!doctype html>page");
    folder.write("web/assets/app-3f.js", "plain");
    folder.write("web/assets/app-3f.js.br", "brotli");
    folder.write("web/assets/app-3f.js.gz", "gzip");
    folder.write("web/only.js.gz", "nothing of it is plain");
  }

  TemporaryFolder folder;
};

TEST_F(HttpStaticFiles, PathsCannotLeaveTheFolder) {
  std::filesystem::create_symlink("../secret", folder.path() / "web" / "link.txt");
  const auto files = StaticFiles::load(folder.path() / "web");
  ASSERT_TRUE(files);
  for (const char* target : {"/../secret.txt", "/assets/../../secret.", "/%2e%2e/secret.x",
                             "/link.txt", "//secret.x", "/assets/..%2f..%2fsecret.x", "/only.js",
                             "/missing.js", "secret.x", "*", "/assets/app-3f.js.br"}) {
    EXPECT_EQ(files->answer(asked(target)).status, 404) << target;
  }
}

TEST_F(HttpStaticFiles, ClientRoutesServeIndexHtml) {
  const auto files = StaticFiles::load(folder.path() / "web");
  for (const char* target : {"/", "/index.html", "/jobs?x=1", "/queue"}) {
    const Response page = files->answer(asked(target));
    EXPECT_EQ(page.content(), "<!doctype html>page") << target;
    EXPECT_EQ(page.fields.find("Content-Type"), "text/html; charset=utf-8");
    EXPECT_EQ(page.fields.find("Cache-Control"), "no-cache");
  }
}

TEST_F(HttpStaticFiles, PathsInFoldersRedirectToThePage) {
  const auto files = StaticFiles::load(folder.path() / "web");
  const std::pair<const char*, const char*> cases[] = {
      {"/jobs/7?x=1", "../"}, {"/a/b/c", "../../"}, {"//evil", "../"}, {"/jobs/", "../"}};
  for (const auto& [target, root] : cases) {
    const Response page = files->answer(asked(target));
    EXPECT_EQ(page.status, 302) << target;
    EXPECT_EQ(page.fields.find("Location"), root) << target;
  }
}

TEST_F(HttpStaticFiles, CompressedVariantsAreServedOnRequest) {
  const auto files = StaticFiles::load(folder.path() / "web");
  const auto with = [&](const char* codings) {
    return files->answer(asked("/assets/app-3f.js", "Accept-Encoding", codings));
  };
  EXPECT_EQ(with("gzip, deflate, br").content(), "brotli");
  EXPECT_EQ(with("gzip;q=0.5, br;q=0").content(), "gzip");
  EXPECT_EQ(with("identity").content(), "plain");
  EXPECT_EQ(with("br").fields.find("Content-Encoding"), "br");
  EXPECT_FALSE(with("identity").fields.find("Content-Encoding"));
  EXPECT_EQ(with("br").fields.find("Vary"), "Accept-Encoding");
  EXPECT_NE(*with("br").fields.find("ETag"), *with("gzip").fields.find("ETag"));
  EXPECT_NE(with("br").fields.find("Cache-Control")->find("immutable"), std::string::npos);
}

TEST_F(HttpStaticFiles, CachedFilesAreNotSentAgain) {
  const auto files = StaticFiles::load(folder.path() / "web");
  const std::string tag(*files->answer(asked("/")).fields.find("ETag"));
  const Response again = files->answer(asked("/", "If-None-Match", tag));
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.content(), "");
}

TEST_F(HttpStaticFiles, WithoutAClientAPageExplainsHowToBuildIt) {
  const auto files = StaticFiles::load(folder.path() / "none");
  ASSERT_TRUE(files);
  EXPECT_NE(files->answer(asked("/")).content().find("was not found"), std::string::npos);
  EXPECT_EQ(files->answer(asked("/app.js")).status, 404);
}

}  // namespace
}  // namespace hydroprint::http
