#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>

#include "daemon/store/asset_store.h"
#include "daemon/store/database/schema.h"
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
    assets.reset();
    jobs.reset();
    database.reset();
    database = open_store(layout.database()).value();
    const auto clock = [this] { return now_ms; };
    jobs = std::make_unique<JobStore>(*database, layout, job_options, clock);
    assets = std::make_unique<AssetStore>(*database, layout, asset_options, clock);
    EXPECT_TRUE(jobs->interrupt_all(Interruption::kLoss));
    EXPECT_TRUE(jobs->sweep());
    EXPECT_TRUE(assets->sweep());
    EXPECT_TRUE(assets->purge());
  }

  /// A job with this digest, owned by `owner`.
  Job add(const std::string& digest = "d", const std::string& owner = "ann", int priority = 0) {
    NewJob made;
    made.owner = owner;
    made.priority = priority;
    made.work.verb = "simulate";
    made.digest = digest;
    return jobs->create(made, {}).value();
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
  JobStoreOptions job_options{5, 1000};
  AssetStoreOptions asset_options{100, 3, 1000, 0};
  std::unique_ptr<Database> database;
  std::unique_ptr<JobStore> jobs;
  std::unique_ptr<AssetStore> assets;
};

}  // namespace hydroprint::daemon
