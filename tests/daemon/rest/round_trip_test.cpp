// Random messages arrive unchanged when sent as by a client; answers can be read back.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/rest/json_text.h"
#include "daemon/rest/transcoder.h"
#include "hydroprint/v1/preview_service.pb.h"
#include "tests/daemon/rest/requests.h"
#include "tests/support/campaign.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using pb::util::MessageDifferencer;

std::vector<std::string> all_services() {
  std::vector<std::string> services = api_services();
  services.emplace_back("hydroprint.rest.test.Rules");
  return services;
}

TEST(RoundTrip, EveryRequestArrivesUnchanged) {
  const auto routes = read_routes(all_services());
  const auto transcoder = Transcoder::make(all_services());
  ASSERT_TRUE(routes && transcoder);
  std::mt19937 random(testing::campaign_seed(11));
  for (const Route& route : *routes) {
    for (int i = 0; i < testing::campaign_rounds(60); ++i) {
      const auto message = random_message(*route.method->input_type(), random, i % 4);
      const Sent request = sent(route, *message, random);
      const auto call = transcoder->read(route.http_method, request.target, request.body);
      ASSERT_TRUE(call) << call.error().message << "\n" << request.target << "\n" << request.body;
      EXPECT_EQ(call->method, rpc_name(*route.method)) << request.target;
      const auto read = new_message(*route.method->input_type());
      ASSERT_TRUE(read->ParseFromString(call->request));
      ASSERT_TRUE(MessageDifferencer::Equals(*message, *read))
          << request.target << "\n"
          << request.body << "\n"
          << message->ShortDebugString() << "\n"
          << read->ShortDebugString();
    }
  }
}

TEST(RoundTrip, EveryAnswerCanBeReadBack) {
  const auto routes = read_routes(all_services());
  const auto transcoder = Transcoder::make(all_services());
  ASSERT_TRUE(routes && transcoder);
  std::mt19937 random(testing::campaign_seed(12));
  for (const Route& route : *routes) {
    for (int i = 0; i < testing::campaign_rounds(60); ++i) {
      const auto message = random_message(*route.method->output_type(), random, i % 4);
      const auto text = transcoder->write(rpc_name(*route.method), message->SerializeAsString());
      ASSERT_TRUE(text) << text.error().message;
      const auto read = new_message(*route.method->output_type());
      const Status status = read_json(*text, *read);
      ASSERT_TRUE(status) << status.error().message << "\n" << *text;
      ASSERT_TRUE(MessageDifferencer::Equals(*message, *read)) << *text;
    }
  }
}

TEST(RawBody, IsTheFieldThatTheMethodNames) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  v1::DisplayModel model;
  model.set_glb(std::string("glTF\0", 5));
  model.mutable_summary()->set_format("OBJ");
  const auto body =
      transcoder->raw_body("/hydroprint.v1.PreviewService/ReadModel", model.SerializeAsString());
  ASSERT_TRUE(body && *body);
  EXPECT_EQ((*body)->media_type, "model/gltf-binary");
  EXPECT_EQ((*body)->bytes, model.glb());
  EXPECT_FALSE(transcoder->raw_body("/hydroprint.v1.JobService/GetJob", "").value());
}

TEST(RawBody, BeginsWithTheOtherFieldsIfTheMethodWantsIt) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  for (int length = 0; length < 9; ++length) {
    v1::Preview preview;
    preview.add_warnings()->set_message(std::string(length, '\n'));
    preview.set_vertex_map("\n\n\n\n");
    const auto body = transcoder->raw_body("/hydroprint.v1.PreviewService/ComputePreview",
                                           preview.SerializeAsString());
    ASSERT_TRUE(body && *body);
    const std::string& bytes = (*body)->bytes;
    const std::size_t end = bytes.find('\n');
    EXPECT_EQ(end % 8, 7U);
    EXPECT_EQ(bytes.substr(end + 1), preview.vertex_map());
    const auto others = nlohmann::json::parse(bytes.substr(0, end));
    EXPECT_EQ(others.at("warnings").at(0).at("message"), std::string(length, '\n'));
    EXPECT_EQ(others.at("vertexMap"), "");
  }
}

TEST(Answer, HasAllFieldsWithoutPresence) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  const auto text = transcoder->write("/hydroprint.v1.JobService/ListJobs", "");
  EXPECT_EQ(text, R"({"jobs":[],"nextPageToken":""})");
  const auto rig =
      nlohmann::json::parse(*transcoder->write("/hydroprint.v1.RigService/GetRig", ""));
  EXPECT_EQ(rig.at("state"), "STATE_UNSPECIFIED");
  EXPECT_EQ(rig.at("homed"), false);
  EXPECT_FALSE(rig.contains("positionMm"));  // an optional field
  EXPECT_FALSE(rig.contains("axis"));        // a field that is a message
  EXPECT_EQ(transcoder->write("/hydroprint.v1.JobService/DeleteJob", ""), "{}");
}

TEST(Answer, IsWrittenForClientStreamingCallsToo) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  EXPECT_EQ(transcoder->write("/hydroprint.v1.AssetService/UploadChunk", ""), "{}");
}

TEST(Answer, OfAnotherTypeIsRefused) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  for (const auto& [method, bytes] :
       {std::pair("/hydroprint.v1.JobService/None", ""), std::pair("", ""),
        std::pair("/hydroprint.v1.JobService/GetJob", "\x0a\xff")}) {
    const auto text = transcoder->write(method, bytes);
    ASSERT_FALSE(text) << method;
    EXPECT_EQ(text.error().code, Code::kInternal);
  }
}

}  // namespace
}  // namespace hydroprint::rest
