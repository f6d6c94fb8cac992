// Previews while an object is rotated, with the real worker and with a fake one that misbehaves on
// request.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

#include "hydroprint/v1/preview_service.grpc.pb.h"
#include "tests/daemon/api/support.h"

namespace hydroprint::tests {
namespace {

// A pyramid on its tip, 20 mm high.
constexpr const char* kPyramid =
    "v 0 0 0\nv 15 15 20\nv -15 15 20\nv -15 -15 20\nv 15 -15 20\n"
    "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\nf 2 5 4 3\n";

class Previews : public ::testing::Test {
 protected:
  void start(const DaemonProcess::Options& options) {
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
    client = std::make_unique<Client>(daemon->address());
  }
  /// Requests a preview. The fake worker reports its pid as the depth.
  grpc::Status preview(const std::string& mesh, v1::Preview& out, const std::string& owner = "") {
    Client caller(daemon->address(), owner);
    v1::ComputePreviewRequest request;
    v1::SimulateSpec& spec = *request.mutable_simulate();
    spec.mutable_mesh()->set_name("m.obj");
    spec.mutable_mesh()->set_asset(caller.upload(mesh));
    spec.set_film("100x100");
    for (const double x : {1, 0, 0, 0}) spec.mutable_pose()->add_rotation_wxyz(x);
    for (const double x : {0, 0, 0}) spec.mutable_pose()->add_translation_mm(x);
    return v1::PreviewService::NewStub(caller.channel)
        ->ComputePreview(caller.context().get(), request, &out);
  }
  grpc::Status read(const std::string& mesh, v1::DisplayModel& out, const std::string& owner = "") {
    Client caller(daemon->address(), owner);
    v1::ReadModelRequest request;
    request.mutable_inspect()->mutable_mesh()->set_name("m.obj");
    request.mutable_inspect()->mutable_mesh()->set_asset(caller.upload(mesh));
    return v1::PreviewService::NewStub(caller.channel)
        ->ReadModel(caller.context().get(), request, &out);
  }
  void expect_refused(const std::string& mesh, int code, const std::string& reason) {
    v1::Preview out;
    const grpc::Status status = preview(mesh, out);
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_EQ(error_info(status).reason(), reason) << status.error_message();
  }

  TemporaryFolder folder;
  std::unique_ptr<DaemonProcess> daemon;
  std::unique_ptr<Client> client;
};

TEST_F(Previews, KeepTheMeshInTheirOwnWorker) {
  start(DaemonProcess::fake());
  v1::Preview first, second, other, third;
  ASSERT_TRUE(preview("a", first).ok());
  ASSERT_TRUE(preview("a", second).ok());
  EXPECT_EQ(first.depth_mm(), second.depth_mm()) << "the same mesh uses the same process";
  EXPECT_EQ(second.vertex_map(), std::string(16, 'm'));
  EXPECT_EQ(second.warnings_size(), 1);
  EXPECT_TRUE(std::isnan(second.stretch_max()));
  ASSERT_TRUE(preview("b", other).ok());
  EXPECT_NE(first.depth_mm(), other.depth_mm());
  ASSERT_TRUE(preview("a", third, "somebody").ok());
  EXPECT_NE(first.depth_mm(), third.depth_mm()) << "another user gets another process";
  if (proc_is_mounted()) {
    EXPECT_EQ(daemon->workers().size(), 2u) << "one process per user";
  }
  EXPECT_EQ(daemon->terminate(), 0);
}

TEST_F(Previews, ReadModelsInTheSameWorker) {
  start(DaemonProcess::fake());
  v1::DisplayModel model;
  const grpc::Status status = read("a", model);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(model.summary().format(), "OBJ");
  EXPECT_EQ(model.summary().shown_triangles(), 3);
  ASSERT_EQ(model.summary().warnings_size(), 1);
  EXPECT_EQ(model.summary().warnings(0).code(), v1::Warning::FAR_FROM_ORIGIN);
  v1::Preview dip;
  ASSERT_TRUE(preview("a", dip).ok());
  EXPECT_EQ(model.glb(), "glTF" + std::to_string(static_cast<long>(dip.depth_mm())))
      << "the same process";
  const grpc::Status refused = read("plain", model);
  EXPECT_EQ(refused.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_EQ(error_info(refused).reason(), "INPUT_REFUSED") << refused.error_message();
  EXPECT_EQ(refused.error_message(), "m.png");
}

TEST_F(Previews, TwoPeopleReadTheSameModelAtOnce) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  start({});
  std::array<v1::DisplayModel, 2> models;
  std::array<grpc::Status, 2> done;
  std::thread other([&] { done[1] = read(kPyramid, models[1], "somebody"); });
  done[0] = read(kPyramid, models[0]);
  other.join();
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(done[i].ok()) << done[i].error_message();
    EXPECT_EQ(models[i].summary().format(), "OBJ");
    EXPECT_EQ(models[i].summary().triangles(), 6);
    EXPECT_EQ(models[i].summary().highest_mm(2), 20);
    EXPECT_TRUE(models[i].glb().starts_with("glTF"));
  }
  EXPECT_EQ(models[0].glb(), models[1].glb());
}

TEST_F(Previews, ReadingNamesTheMissingTexture) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  start({});
  v1::ReadModelRequest request;
  v1::InspectSpec& spec = *request.mutable_inspect();
  spec.mutable_mesh()->set_name("m.obj");
  spec.mutable_mesh()->set_asset(
      client->upload("mtllib m.mtl\nusemtl skin\nvt 0 0\n"
                     "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1/1 2/1 3/1\n"));
  v1::InputFile& materials = *spec.add_extra_files();
  materials.set_name("m.mtl");
  materials.set_asset(client->upload("newmtl skin\nmap_Kd skin.png\n"));
  const auto read = [&](v1::DisplayModel& out) {
    return v1::PreviewService::NewStub(client->channel)
        ->ReadModel(client->context().get(), request, &out);
  };
  v1::DisplayModel model;
  const grpc::Status refused = read(model);
  EXPECT_EQ(error_info(refused).reason(), "INPUT_REFUSED");
  EXPECT_NE(refused.error_message().find("skin.png"), std::string::npos) << refused.error_message();
  spec.set_shape_only(true);
  const grpc::Status shape = read(model);
  ASSERT_TRUE(shape.ok()) << shape.error_message();
  EXPECT_EQ(model.summary().triangles(), 1);
  EXPECT_FALSE(model.summary().has_colour());
}

TEST_F(Previews, AreNoJobs) {
  start(DaemonProcess::fake());
  v1::Preview out;
  ASSERT_TRUE(preview("a", out).ok());
  EXPECT_EQ(client->simulate("").name(), "jobs/1");
}

TEST_F(Previews, NewRequestSupersedesThePreviousOne) {
  start(DaemonProcess::fake());
  std::atomic<bool> superseded = false;
  std::thread before([&] {
    expect_refused("mute", grpc::ABORTED, "PREVIEW_SUPERSEDED");
    superseded = true;
  });
  v1::Preview out;
  while (!superseded) (void)preview("a", out);
  before.join();
  EXPECT_TRUE(preview("a", out).ok());
}

TEST_F(Previews, FullPoolReplacesAnIdleWorker) {
  start(DaemonProcess::fake());
  v1::Preview out;
  for (int i = 0; i < 12; ++i) {
    EXPECT_TRUE(preview("a", out, "owner-" + std::to_string(i)).ok()) << i;
  }
  if (proc_is_mounted()) {
    EXPECT_LE(daemon->workers().size(), 4u);
  }
}

TEST_F(Previews, ErrorsAreReportedAndTheNextRequestWorks) {
  start(DaemonProcess::fake());
  expect_refused("exit 3 m.obj:7: not a number; fix the line", grpc::INVALID_ARGUMENT,
                 "INPUT_REFUSED");
  expect_refused("crash", grpc::INTERNAL, "WORKER_KILLED");
  expect_refused("end", grpc::INTERNAL, "COMPUTATION_FAILED");
  expect_refused("rubbish", grpc::INTERNAL, "WORKER_UNUSABLE");
  v1::Preview out;
  EXPECT_TRUE(preview("a", out).ok());

  v1::ComputePreviewRequest request;
  const auto refused = [&] {
    const grpc::Status status = v1::PreviewService::NewStub(client->channel)
                                    ->ComputePreview(client->context().get(), request, &out);
    return error_info(status).reason();
  };
  EXPECT_EQ(refused(), "SPEC_INVALID") << "the request has no mesh";
  request.mutable_simulate()->mutable_mesh()->set_name("m.obj");
  request.mutable_simulate()->mutable_mesh()->set_asset("assets/" + std::string(64, 'a'));
  EXPECT_EQ(refused(), "ASSET_MISSING");
  request.mutable_simulate()->mutable_mesh()->set_name("../m.obj");
  EXPECT_EQ(refused(), "NAME_INVALID");
}

TEST_F(Previews, EndWithTheDaemonEvenIfAWorkerIsSilent) {
  start(DaemonProcess::fake());
  std::thread waiting([this] {
    v1::Preview out;
    EXPECT_FALSE(preview("mute", out).ok());
  });
  const auto asked = daemon->state() / "runs" / "preview-1" / "work" / "asked";
  EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(asked); }, 120));
  EXPECT_EQ(daemon->terminate(), 0);
  waiting.join();
}

TEST_F(Previews, ReportWhereTheFilmLands) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  start({});
  v1::Preview out;
  const grpc::Status status = preview(kPyramid, out);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(out.vertex_map().size(), 5u * 16);
  std::array<float, 4> tip{};
  std::memcpy(tip.data(), out.vertex_map().data(), sizeof tip);
  EXPECT_NEAR(tip[0], 0, 0.5);
  EXPECT_NEAR(tip[1], 0, 0.5);
  EXPECT_NEAR(tip[2], 0, 0.01) << "the tip touches the water first, at time 0";
  EXPECT_NEAR(out.depth_mm(), 20, 0.01);
  EXPECT_GT(out.coverage(), 0.3);
  EXPECT_GE(out.stretch_p95(), out.stretch_p50());

  expect_refused("v 0 0 nothing\n", grpc::INVALID_ARGUMENT, "INPUT_REFUSED");
}

TEST_F(Previews, ImpossibleDipIsRefusedWithAReason) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  start({});
  v1::ComputePreviewRequest request;
  request.mutable_simulate()->mutable_mesh()->set_name("m.obj");
  request.mutable_simulate()->mutable_mesh()->set_asset(client->upload(kPyramid));
  for (const double x : {1, 0, 0, 0})
    request.mutable_simulate()->mutable_pose()->add_rotation_wxyz(x);
  for (const double x : {400, 0, 0})
    request.mutable_simulate()->mutable_pose()->add_translation_mm(x);
  v1::Preview out;
  const grpc::Status status = v1::PreviewService::NewStub(client->channel)
                                  ->ComputePreview(client->context().get(), request, &out);
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_EQ(error_info(status).reason(), "PREVIEW_REFUSED");
  EXPECT_NE(status.error_message().find("film"), std::string::npos) << status.error_message();
}

}  // namespace
}  // namespace hydroprint::tests
