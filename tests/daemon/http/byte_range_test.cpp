#include "daemon/http/protocol/byte_range.h"

#include <gtest/gtest.h>

#include "daemon/http/artifact_path.h"
#include "daemon/http/sse_text.h"
#include "hydroprint/v1/event_service.pb.h"
#include "hydroprint/v1/job_service.pb.h"

namespace hydroprint::http {
namespace {

using Kind = ByteRange::Kind;

void expect_part(std::string_view header, std::int64_t begin, std::int64_t end) {
  const ByteRange range = byte_range(header, 100);
  EXPECT_EQ(range.kind, Kind::kPart) << header;
  EXPECT_EQ(range.begin, begin) << header;
  EXPECT_EQ(range.end, end) << header;
}

TEST(HttpByteRange, SingleRangeIsAPart) {
  expect_part("bytes=0-0", 0, 1);
  expect_part("bytes=10-19", 10, 20);
  expect_part("bytes=10-", 10, 100);
  expect_part("bytes=-5", 95, 100);
  expect_part("bytes=-500", 0, 100);
  expect_part("bytes=99-99999999999999999999", 99, 100);
  expect_part("Bytes= 10-19 ", 10, 20);
}

TEST(HttpByteRange, RangeBeyondTheEndIsUnsatisfiable) {
  for (const char* header :
       {"bytes=100-", "bytes=100-200", "bytes=-0", "bytes=99999999999999999999-"}) {
    EXPECT_EQ(byte_range(header, 100).kind, Kind::kNone) << header;
  }
  EXPECT_EQ(byte_range("bytes=0-", 0).kind, Kind::kNone);
  EXPECT_EQ(byte_range("bytes=-5", 0).kind, Kind::kNone);
}

TEST(HttpByteRange, InvalidOrMultipleRangesMeanTheWholeFile) {
  for (const char* header :
       {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-4", "bytes=0-1,3-4", "lines=1-2",
        "bytes=+1-2", "bytes=1-2x", "bytes=--5"}) {
    const ByteRange range = byte_range(header, 100);
    EXPECT_EQ(range.kind, Kind::kAll) << header;
    EXPECT_EQ(range.end, 100) << header;
  }
}

TEST(HttpByteRange, TagIsFoundInAList) {
  EXPECT_TRUE(lists_tag("\"a\", \"b\"", "\"b\""));
  EXPECT_TRUE(lists_tag("W/\"b\"", "\"b\""));
  EXPECT_TRUE(lists_tag("*", "\"b\""));
  EXPECT_FALSE(lists_tag("\"ab\"", "\"b\""));
  EXPECT_FALSE(lists_tag("", "\"b\""));
}

TEST(HttpByteRange, FileNameNeverLeavesItsQuotes) {
  EXPECT_EQ(content_disposition(false, "film.png"), "attachment; filename=\"film.png\"");
  EXPECT_EQ(content_disposition(true, "a\"\r\n;b.png"),
            "inline; filename=\"a___;b.png\"; filename*=UTF-8''a%22%0D%0A%3Bb.png");
  EXPECT_EQ(content_disposition(false, "Gef\xc3\xa4\xc3\x9f.png"),
            "attachment; filename=\"Gef____.png\"; filename*=UTF-8''Gef%C3%A4%C3%9F.png");
}

TEST(HttpByteRange, TypesWithScriptsAreNeverShown) {
  for (const char* type : {"text/html", "image/svg+xml", "application/pdf", "text/xml", ""}) {
    EXPECT_FALSE(may_be_shown(type)) << type;
  }
  EXPECT_TRUE(may_be_shown("image/png"));
}

TEST(HttpArtifactTarget, NamesOneFileOfAJob) {
  const auto film = artifact_target("/v1/jobs/7/artifacts/film.png:download?inline=1");
  ASSERT_TRUE(film);
  EXPECT_EQ(film->name, "jobs/7/artifacts/film.png");
  EXPECT_TRUE(film->is_inline && film->is_good);
  EXPECT_EQ(artifact_target("/v1/jobs/7/artifacts/a%20b:download")->name, "jobs/7/artifacts/a b");
  EXPECT_FALSE(artifact_target("/v1/jobs/7/artifacts/a%2fb:download")->is_good);
  EXPECT_FALSE(artifact_target("/v1/jobs/7/artifacts/a%zz:download")->is_good);
  EXPECT_FALSE(artifact_target("/v1/jobs/7/artifacts/a:download?offset=3")->is_good);
  for (const char* other : {"/v1/jobs/7/artifacts/film.png", "/v1/jobs/7/artifacts/:download",
                            "/v1/jobs/7/artifacts/a/b:download", "/v1/jobs/7:download",
                            "/v1/jobs/artifacts/a:download", "/v2/jobs/7/artifacts/a:download"}) {
    EXPECT_FALSE(artifact_target(other)) << other;
  }
}

TEST(HttpEventText, KindNamesTheChangedObject) {
  v1::WatchEventsResponse message;
  message.set_seq(3);
  const char* method = "/hydroprint.v1.EventService/WatchEvents";
  EXPECT_EQ(event_kind(method, message.SerializeAsString()), "begin");
  message.mutable_rig();
  EXPECT_EQ(event_kind(method, message.SerializeAsString()), "rig");
  message.mutable_job();
  EXPECT_EQ(event_kind(method, message.SerializeAsString()), "job");
  EXPECT_EQ(event_kind("/hydroprint.v1.JobService/WatchJob", ""), "job");
  EXPECT_EQ(event_kind("/hydroprint.v1.RigService/WatchRig", ""), "rig");
  EXPECT_EQ(event_text("3", "job", "{}"), "id: 3\nevent: job\ndata: {}\n\n");
  EXPECT_EQ(event_text("", "end", "{}"), "event: end\ndata: {}\n\n");
}

}  // namespace
}  // namespace hydroprint::http
