#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>

#include "daemon/store/assets/asset_retention.h"
#include "daemon/store/assets/asset_rows.h"
#include "daemon/store/assets/upload_writer.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_retention.h"
#include "daemon/store/job_store.h"
#include "sim/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {

/// A store in a folder of the test, with an adjustable clock.
class StoreTest : public ::testing::Test {
 protected:
  StoreTest() { open(); }

  /// Opens the store as a daemon does at the start, as if the previous one had been killed.
  void open() {
    open_stores();
    EXPECT_TRUE(jobs->interrupt_all(Interruption::kLoss));
    EXPECT_TRUE(job_retention->sweep());
    EXPECT_TRUE(asset_retention->sweep());
    EXPECT_TRUE(asset_retention->purge());
  }

  /// Opens the store without the repairs of the start.
  void open_stores() {
    close();
    database = open_store(layout.database()).value();
    const auto clock = [this] { return now_ms; };
    changes = std::make_unique<JobChanges>(*database, retention_times, clock);
    jobs = std::make_unique<JobStore>(*changes, layout, job_options);
    queue = std::make_unique<JobQueue>(*changes);
    device_jobs = std::make_unique<DeviceJobs>(*changes);
    job_retention = std::make_unique<JobRetention>(*changes, layout);
    assets = std::make_unique<AssetStore>(*database, layout, clock);
    uploads = std::make_unique<Uploads>(*database, *assets, layout, upload_options, clock);
    asset_retention = std::make_unique<AssetRetention>(*database, layout, keep_unused_ms, clock);
  }

  /// Closes the store and leaves it as a killed daemon would.
  void close() {
    asset_retention.reset();
    uploads.reset();
    assets.reset();
    job_retention.reset();
    device_jobs.reset();
    queue.reset();
    jobs.reset();
    changes.reset();
    database.reset();
  }

  /// Creates a job with this digest, owned by `owner`.
  Job add(const std::string& digest = "d", const std::string& owner = "ann", int priority = 0) {
    NewJob definition;
    definition.owner = owner;
    definition.priority = priority;
    definition.work.verb = "simulate";
    definition.digest = digest;
    return jobs->create(definition, {}).value();
  }

  /// Runs a job to its end with one artifact.
  Job complete(std::int64_t id, const std::string& content = "film") {
    EXPECT_TRUE(jobs->start(id));
    std::filesystem::create_directories(layout.artifacts(id));
    std::ofstream(layout.artifacts(id) / "film.png") << content;
    return jobs->succeed(id, {{"film.png", 4, sha256(content), "image/png"}}).value();
  }

  [[nodiscard]] std::vector<JobState> states(std::int64_t id) {
    std::vector<JobState> out;
    const auto events = jobs->events(id, 0, 1000).value();
    for (const JobEvent& event : events) out.push_back(event.state);
    return out;
  }

  /// Contents of all files that were set aside.
  [[nodiscard]] std::multiset<std::string> set_aside() const {
    std::multiset<std::string> out;
    std::error_code none;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(layout.set_aside(), none)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path());
      out.insert({std::istreambuf_iterator<char>(file), {}});
    }
    return out;
  }

  hydroprint::testing::TemporaryFolder folder;
  Layout layout{folder.path()};
  std::int64_t now_ms = 1'000'000;
  JobStoreOptions job_options{5};
  RetentionTimes retention_times{1000};
  UploadOptions upload_options{100, 3, 1000, 0};
  std::int64_t keep_unused_ms = 30LL * 24 * 3600 * 1000;
  std::unique_ptr<Database> database;
  std::unique_ptr<JobChanges> changes;
  std::unique_ptr<JobStore> jobs;
  std::unique_ptr<JobQueue> queue;
  std::unique_ptr<DeviceJobs> device_jobs;
  std::unique_ptr<JobRetention> job_retention;
  std::unique_ptr<AssetStore> assets;
  std::unique_ptr<Uploads> uploads;
  std::unique_ptr<AssetRetention> asset_retention;
};

}  // namespace hydroprint::daemon
