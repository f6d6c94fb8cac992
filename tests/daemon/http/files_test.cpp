// Uploads and downloads over HTTP, through the daemon.
#include <fstream>

#include "sim/base/sha256.h"
#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

class HttpFiles : public HttpTest {
 protected:
  // Starts an upload; returns its path.
  std::string begin_upload(const std::string& bytes) {
    const nlohmann::json wanted = {{"sizeBytes", bytes.size()}, {"sha256", hash_of(bytes)}};
    return "/v1/" +
           post("/v1/uploads", wanted.dump()).json().at("upload").at("name").get<std::string>();
  }
  HttpAnswer patch(const std::string& path, std::size_t offset, const std::string& bytes) {
    return ask(daemon.http(), "PATCH", path, bytes,
               "Upload-Offset: " + std::to_string(offset) + "\r\n");
  }
  // Runs a job with an artifact of 64 MiB; returns its path.
  std::string huge() {
    const std::string name = simulate("huge");
    EXPECT_EQ(client.wait_for_end(name).state(), v1::Job::SUCCEEDED);
    return "/v1/" + name + "/artifacts/huge:download";
  }
};

std::string noise(std::size_t size) {
  std::string bytes(size, '\0');
  std::uint32_t state = 1;
  for (char& byte : bytes) byte = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  return bytes;
}

TEST_F(HttpFiles, BrokenUploadIsResumed) {
  const std::string bytes = noise(300'000);
  const std::string path = begin_upload(bytes);
  const HttpAnswer part = patch(path, 0, bytes.substr(0, 100'000));
  EXPECT_EQ(part.status, 204);
  EXPECT_EQ(part.field("upload-offset"), "100000");
  {
    HttpConnection broken(daemon.http());
    broken.send(
        "PATCH " + path +
        " HTTP/1.1\r\nHost: localhost\r\nUpload-Offset: 100000\r\nContent-Length: 200000\r\n\r\n" +
        bytes.substr(100'000, 50'000));
  }
  HttpAnswer state;
  for (int i = 0; i < 1000 && state.field("upload-offset") != "150000"; ++i) {
    state = ask(daemon.http(), "HEAD", path);
  }
  EXPECT_EQ(state.field("upload-offset"), "150000");
  EXPECT_EQ(state.field("upload-length"), "300000");
  HttpAnswer wrong;  // repeated, because the broken connection may still lock the upload
  for (int i = 0; i < 1000 && wrong.reason() != "OFFSET_MISMATCH"; ++i) {
    wrong = patch(path, 100'000, bytes.substr(100'000));
  }
  EXPECT_EQ(wrong.reason(), "OFFSET_MISMATCH");
  HttpAnswer done;  // repeated for the same reason
  for (int i = 0; i < 1000 && done.status != 200; ++i)
    done = patch(path, 150'000, bytes.substr(150'000));
  EXPECT_EQ(done.status, 200) << done.body;
  EXPECT_EQ(done.json().at("sha256"), hash_of(bytes));
  EXPECT_EQ(ask(daemon.http(), "HEAD", path).status, 404);
  EXPECT_EQ(get("/v1/assets/" + hash_of(bytes)).json().at("sizeBytes"), "300000");
}

TEST_F(HttpFiles, ManyUploadsAreAnsweredAndEndWithTheDaemon) {
#ifdef __SANITIZE_ADDRESS__
  constexpr std::size_t kUploads = 100;
#else
  constexpr std::size_t kUploads = 600;
#endif
  for (std::size_t i = 0; i < kUploads; ++i) {
    const std::string bytes = "file " + std::to_string(i);
    const HttpAnswer done = patch(begin_upload(bytes), 0, bytes);
    ASSERT_EQ(done.status, 200) << done.body;
    ASSERT_EQ(done.json().value("sha256", ""), hash_of(bytes)) << i;
  }
  EXPECT_EQ(daemon.terminate(), 0);
}

TEST_F(HttpFiles, WrongBytesBecomeNoAsset) {
  const std::string bytes = noise(1000);
  const std::string path = begin_upload(bytes);
  const HttpAnswer wrong = patch(path, 0, std::string(1000, 'x'));
  EXPECT_EQ(wrong.status, 400);
  EXPECT_EQ(wrong.reason(), "ASSET_HASH_MISMATCH");
  EXPECT_EQ(get("/v1/assets/" + hash_of(bytes)).status, 404);
  EXPECT_EQ(patch(path, 0, "x").reason(), "UPLOAD_NOT_FOUND");
  EXPECT_EQ(patch("/v1/uploads/..%2f..%2fx", 0, "x").status, 400);
  EXPECT_EQ(ask(daemon.http(), "PATCH", path, "x").reason(), "SPEC_INVALID");
}

TEST_F(HttpFiles, EmptyFileNeedsOnlyItsName) {
  const HttpAnswer done = patch(begin_upload(""), 0, "");
  EXPECT_EQ(done.json().at("sha256"), hash_of(""));
}

TEST_F(HttpFiles, ChunkedBodyIsAccepted) {
  const std::string bytes = noise(100'000);
  const std::string path = begin_upload(bytes);
  HttpConnection connection(daemon.http());
  connection.send(
      "PATCH " + path +
      " HTTP/1.1\r\nHost: localhost\r\nUpload-Offset: 0\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (std::size_t at = 0; at < bytes.size(); at += 10'000) {
    connection.send("2710\r\n" + bytes.substr(at, 10'000) + "\r\n");
  }
  connection.send("0\r\n\r\n");
  EXPECT_EQ(connection.read_answer().json().at("sha256"), hash_of(bytes));
  EXPECT_EQ(connection.ask("GET", "/v1/queue").status, 200);
}

TEST_F(HttpFiles, LargeUploadsAreNotKeptInMemory) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  const std::string bytes = noise(96 << 20);
  const std::string path = begin_upload(bytes);
  const std::size_t before = memory_bytes(daemon.pid());
  EXPECT_EQ(patch(path, 0, bytes).status, 200);
  EXPECT_LT(memory_bytes(daemon.pid()), before + (24 << 20));
}

TEST_F(HttpFiles, ArtifactEqualsTheWorkersFile) {
  const std::string name = simulate("");
  client.wait_for_end(name);
  const std::string path = "/v1/" + name + "/artifacts/film.png:download";
  const std::string bytes = client.download(name + "/artifacts/film.png");
  const HttpAnswer whole = get(path);
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.body, bytes);
  EXPECT_EQ(whole.field("content-type"), "image/png");
  EXPECT_EQ(whole.field("content-disposition"), "attachment; filename=\"film.png\"");
  EXPECT_EQ(whole.field("etag"), '"' + hash_of(bytes) + '"');
  EXPECT_EQ(whole.field("accept-ranges"), "bytes");
  EXPECT_EQ(get(path + "?inline=1").field("content-disposition"), "inline; filename=\"film.png\"");
  EXPECT_EQ(get(path + "?inline=2").status, 400);
  const HttpAnswer head = ask(daemon.http(), "HEAD", path);
  EXPECT_EQ(head.field("content-length"), std::to_string(bytes.size()));
  EXPECT_EQ(get("/v1/" + name + "/artifacts/none:download").reason(), "ARTIFACT_NOT_FOUND");
  EXPECT_EQ(get("/v1/" + name + "/artifacts/..%2f..%2flock:download").status, 400);
  EXPECT_EQ(ask(daemon.http(), "POST", path, "x").status, 405);
}

TEST_F(HttpFiles, RangesOfAnArtifactAreServed) {
  const std::string path = huge();
  const auto range = [&](const std::string& value, const std::string& more = "") {
    return get(path, "Range: bytes=" + value + "\r\n" + more);
  };
  const HttpAnswer some = range("1000-70999");
  EXPECT_EQ(some.status, 206);
  EXPECT_EQ(some.field("content-range"), "bytes 1000-70999/67108864");
  EXPECT_EQ(some.body, std::string(70'000, 'x'));
  EXPECT_EQ(range("-1").body, "x");
  EXPECT_EQ(range("67108863-").field("content-range"), "bytes 67108863-67108863/67108864");
  const HttpAnswer none = range("67108864-");
  EXPECT_EQ(none.status, 416);
  EXPECT_EQ(none.field("content-range"), "bytes */67108864");
  EXPECT_EQ(none.reason(), "RANGE_UNSATISFIABLE");
  const std::string tag = some.field("etag");
  EXPECT_EQ(range("0-9", "If-Range: " + tag + "\r\n").status, 206);
  EXPECT_EQ(range("0-9", "If-Range: \"other\"\r\n").status, 200);
  EXPECT_EQ(get(path, "If-None-Match: " + tag + "\r\n").status, 304);
}

TEST_F(HttpFiles, NoByteOfADamagedArtifactIsServed) {
  const std::string path = huge();
  EXPECT_EQ(get(path, "Range: bytes=0-9\r\n").status, 206);
  {
    std::fstream file(daemon.state() / "artifacts" / "1" / "huge",
                      std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(60 << 20);
    file << 'y';
    ASSERT_TRUE(file);
  }
  for (const char* const range : {"", "Range: bytes=0-9\r\n", "Range: bytes=-1\r\n"}) {
    const HttpAnswer refused = get(path, range);
    EXPECT_EQ(refused.status, 500) << range;
    EXPECT_EQ(refused.reason(), "ARTIFACT_DAMAGED") << range;
    EXPECT_NE(refused.body.find("hydroprint retry 1"), std::string::npos) << refused.body;
  }
}

TEST_F(HttpFiles, SlowReaderCostsLittleMemory) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  const std::string path = huge();
  const std::size_t before = memory_bytes(daemon.pid());
  std::vector<HttpConnection> slow;
  for (int i = 0; i < 20; ++i) {
    slow.emplace_back(daemon.http(), 4096);
    slow.back().send(request_text("GET", path));
    EXPECT_EQ(slow.back().read_head().status, 200);
  }
  EXPECT_EQ(get("/v1/queue").status, 200);
  EXPECT_LT(memory_bytes(daemon.pid()), before + (30 << 20));
}

}  // namespace
}  // namespace hydroprint::tests
