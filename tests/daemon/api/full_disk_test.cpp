// A state folder on a disk of a few MiB that becomes full during an operation.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include "tests/daemon/api/support.h"

namespace hydroprint::tests {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMiB = 1 << 20;

class FullDisk : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(disk);
    mounted = ::mount("none", disk.c_str(), "tmpfs", 0, "size=12m") == 0;
    if (!mounted) {
      GTEST_SKIP() << "cannot mount a small disk: " << std::strerror(errno) << " (needs root)";
    }
  }
  void TearDown() override {
    daemon.reset();
    if (mounted) ::umount2(disk.c_str(), MNT_DETACH);
  }
  void start(const DaemonProcess::Options& options = DaemonProcess::fake()) {
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
    client = std::make_unique<Client>(daemon->address());
  }
  [[nodiscard]] std::int64_t free_bytes() const {
    return static_cast<std::int64_t>(fs::space(disk).available);
  }
  // Fills the disk with other files until at most `bytes` remain free.
  void leave_free(std::int64_t bytes) const {
    std::ofstream(disk / "others", std::ios::app) << std::string(
        static_cast<std::size_t>(std::max<std::int64_t>(0, free_bytes() - bytes)), 'x');
    EXPECT_LE(free_bytes(), bytes);
  }
  void make_room() const { fs::remove(disk / "others"); }
  // Number of regular files below a folder of the store.
  [[nodiscard]] int files_in(const char* name) const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(disk / name)) {
      count += entry.is_directory() ? 0 : 1;
    }
    return count;
  }
  void expect_no_room_for(const v1::Job& job) const {
    EXPECT_EQ(job.state(), v1::Job::FAILED);
    EXPECT_EQ(job.error().code(), grpc::RESOURCE_EXHAUSTED) << job.error().message();
    EXPECT_EQ(job.error().reason(), v1::DISK_FULL) << job.error().message();
    EXPECT_EQ(files_in("artifacts"), 0);
    EXPECT_EQ(files_in("runs"), 0);
  }

  TemporaryFolder folder;
  const fs::path disk = folder.path() / "state";
  bool mounted = false;
  std::unique_ptr<DaemonProcess> daemon;
  std::unique_ptr<Client> client;
};

TEST_F(FullDisk, UploadThatFillsTheDiskIsRefusedAndDeleted) {
  start();
  const std::string bytes(4 * kMiB, 'x');
  v1::StartUploadRequest begin;
  begin.set_size_bytes(static_cast<std::int64_t>(bytes.size()));
  begin.set_sha256(hash_of(bytes));
  v1::StartUploadResponse begun;
  ASSERT_TRUE(client->assets->StartUpload(client->context().get(), begin, &begun).ok());
  leave_free(kMiB);

  v1::UploadChunkResponse reply;
  const auto call = client->context();
  const auto writer = client->assets->UploadChunk(call.get(), &reply);
  v1::UploadChunkRequest chunk;
  chunk.set_upload(begun.upload().name());
  for (std::size_t offset = 0; offset < bytes.size(); offset += chunk.data().size()) {
    chunk.set_offset(static_cast<std::int64_t>(offset));
    chunk.set_data(bytes.substr(offset, 65536));
    if (!writer->Write(chunk)) break;
  }
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(error_info(status).reason(), "DISK_FULL");
  EXPECT_NE(status.error_message().find("disk is full"), std::string::npos);
  EXPECT_EQ(files_in("uploads"), 0);
  EXPECT_EQ(files_in("assets"), 0);
  EXPECT_GT(free_bytes(), kMiB / 2);
  v1::GetUploadRequest get;
  get.set_name(begun.upload().name());
  v1::Upload upload;
  EXPECT_EQ(client->assets->GetUpload(client->context().get(), get, &upload).error_code(),
            grpc::NOT_FOUND);

  const grpc::Status again = client->assets->StartUpload(client->context().get(), begin, &begun);
  EXPECT_EQ(error_info(again).reason(), "DISK_FULL") << "the upload is refused before it starts";
  make_room();
  EXPECT_EQ(client->upload(bytes), "assets/" + hash_of(bytes));
}

TEST_F(FullDisk, RealJobFailsIfItsArtifactsDoNotFit) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  DaemonProcess::Options real = DaemonProcess::fake();
  real.worker.clear();
  start(real);
  const std::string mesh =
      "v 10 10 10 1 0 0\nv 10 -10 -10\nv -10 10 -10\nv -10 -10 10\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 "
      "4 3\n";
  auto request = simulate_request(client->upload(mesh), "tetrahedron.obj");
  request.mutable_job()->mutable_simulate()->set_film("circle:30");
  request.mutable_job()->mutable_simulate()->set_depth_mm(3);
  request.mutable_job()->mutable_simulate()->set_dpi(72);
  client->pause();
  v1::Job job;
  ASSERT_TRUE(client->create(request, job).ok());
  leave_free(kMiB / 4);
  client->resume();
  const v1::Job ended = client->wait_for_end(job.name());
  expect_no_room_for(ended);
  EXPECT_EQ(ended.error().exit_status(), 3) << "the worker itself reports the full disk";
  make_room();
  v1::RetryJobRequest retry;
  retry.set_name(job.name());
  ASSERT_TRUE(client->jobs->RetryJob(client->context().get(), retry, &job).ok());
  EXPECT_EQ(client->wait_for_end(job.name()).state(), v1::Job::SUCCEEDED);
}

// The artifacts fit, but their rows do not: they need more than the reserved space.
TEST_F(FullDisk, ArtifactsWithoutSpaceForTheirRowsAreDeleted) {
  start();
  const std::string name = client->simulate("many\nfill").name();
  expect_no_room_for(client->wait_for_end(name));
  EXPECT_EQ(client->wait_for_end(client->simulate("").name()).state(), v1::Job::SUCCEEDED);
}

TEST_F(FullDisk, JobThatFilledTheDiskCanBeCancelled) {
  start();
  const std::string name = client->simulate("fill\nsleep 60").name();
  client->wait(name, [&](const v1::Job&) { return free_bytes() == 0; });
  EXPECT_EQ(client->cancel(name).name(), name);
  EXPECT_EQ(client->wait_for_end(name).state(), v1::Job::CANCELLED);
  EXPECT_EQ(files_in("runs"), 0);
}

TEST_F(FullDisk, FullDatabaseRefusesChangesAndTheDaemonKeepsRunning) {
  start();
  const std::string done = client->simulate("#1").name();
  client->wait_for_end(done);
  client->pause();
  const std::string asset = client->upload("#2");
  const std::string waiting = client->simulate("#3").name();
  leave_free(0);
  // Each change uses space in the database's log, until the disk is full.
  grpc::Status refused;
  v1::Queue queue;
  for (int i = 0; i < 2000 && refused.ok(); ++i) {
    v1::PauseQueueRequest pause;
    pause.set_reason(std::string(150, static_cast<char>('a' + i % 26)));
    refused = client->queues->PauseQueue(client->context().get(), pause, &queue);
  }
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED) << refused.error_message();
  EXPECT_EQ(error_info(refused).reason(), "DISK_FULL");
  EXPECT_EQ(client->job(waiting).state(), v1::Job::QUEUED);
  EXPECT_FALSE(client->download(done + "/artifacts/film.png").empty());
  v1::Job job;
  EXPECT_EQ(error_info(client->create(simulate_request(asset), job)).reason(), "DISK_FULL");
  make_room();
  client->resume();
  EXPECT_EQ(client->wait_for_end(waiting).state(), v1::Job::SUCCEEDED);
}

TEST_F(FullDisk, DaemonStartsAgainAfterAJobFilledTheDisk) {
  start();
  const std::string name = client->simulate("fill\nsleep 60").name();
  client->wait(name, [&](const v1::Job&) { return free_bytes() == 0; });
  daemon->kill();
  daemon->start();
  client = std::make_unique<Client>(daemon->address());
  EXPECT_EQ(client->cancel(name).name(), name);
  EXPECT_EQ(client->wait_for_end(name).state(), v1::Job::CANCELLED);
  EXPECT_EQ(files_in("runs"), 0);
}

}  // namespace
}  // namespace hydroprint::tests
