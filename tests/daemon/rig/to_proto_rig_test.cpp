// Order of the messages about the rig.
#include "daemon/rig/to_proto_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "daemon/platform/resource_names.h"
#include "daemon/store/database/schema.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

class RigMessages : public ::testing::Test {
 protected:
  hydroprint::testing::TemporaryFolder folder;
  std::unique_ptr<Database> database = open_store(folder.path() / "test.db").value();
  LeaseManager leases{*database, system_clock_ms};
  RigGateway gateway{nullptr, leases};
};

TEST_F(RigMessages, HaveIncreasingRevisionsAcrossRestarts) {
  std::int64_t latest = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t revision = rig_message(gateway).revision();
    ASSERT_GT(revision, latest);
    latest = revision;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const RigGateway next(nullptr, leases);
  EXPECT_GT(rig_message(next).revision(), latest);
}

TEST_F(RigMessages, OfAGreaterRevisionNeverShowAnOlderState) {
  constexpr std::size_t kMessages = 2000;
  std::atomic<bool> ends = false;
  std::thread changes([&] {  // the dip's number replaces any state that changes
    for (std::int64_t i = 1; !ends; ++i) gateway.set_dip(i);
  });
  std::array<std::vector<v1::Rig>, 2> seen;
  std::vector<std::thread> readers;
  for (auto& messages : seen) {
    readers.emplace_back([&] {
      while (messages.size() < kMessages) messages.push_back(rig_message(gateway));
    });
  }
  for (std::thread& reader : readers) reader.join();
  ends = true;
  changes.join();
  std::vector<v1::Rig> all = seen[0];
  all.insert(all.end(), seen[1].begin(), seen[1].end());
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.revision() < b.revision(); });
  const auto number = [](const v1::Rig& rig) {
    return rig.dip().empty() ? 0 : std::stoll(rig.dip().substr(rig.dip().find('/') + 1));
  };
  for (std::size_t i = 1; i < all.size(); ++i) {
    ASSERT_LT(all[i - 1].revision(), all[i].revision());
    ASSERT_LE(number(all[i - 1]), number(all[i]));
  }
}

TEST_F(RigMessages, LookTheSameWhateverTheirRevision) {
  const v1::Rig first = rig_message(gateway);
  v1::Rig second = rig_message(gateway);
  ASSERT_NE(first.revision(), second.revision());
  EXPECT_TRUE(looks_same(first, second));
  second.set_homed(true);
  EXPECT_FALSE(looks_same(first, second));
}

}  // namespace
}  // namespace hydroprint::daemon
