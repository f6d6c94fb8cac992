#include "daemon/store/calibration_store.h"

#include <gtest/gtest.h>

#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

class CalibrationStoreTest : public StoreTest {
 protected:
  void reopen() {
    store.reset();
    open();
    store = std::make_unique<CalibrationStore>(*database, [this] { return now_ms; });
  }
  CalibrationStoreTest() { reopen(); }

  Calibration enter(CalibrationKind kind = CalibrationKind::kObject, const std::string& id = "") {
    return store->create({kind, "ann", 0, 0, "body"}, {"CreateCalibration", id, "d"}).value();
  }
  /// Creates a running job and returns its number.
  std::int64_t running(const std::string& verb = "calibrate") {
    NewJob definition;
    definition.work.verb = verb;
    definition.use_cache = false;
    const Job job = jobs->create(definition, {}).value();
    return jobs->start(job.id).value().id;
  }

  std::unique_ptr<CalibrationStore> store;
};

TEST_F(CalibrationStoreTest, NewestIsActiveUntilAnotherIsActivated) {
  const auto active = [&](CalibrationKind kind) { return store->active(kind).value()->id; };
  EXPECT_FALSE(store->active(CalibrationKind::kObject).value());
  const auto first = enter().id, lens = enter(CalibrationKind::kCamera).id, second = enter().id;
  EXPECT_EQ(active(CalibrationKind::kObject), second);
  EXPECT_EQ(active(CalibrationKind::kCamera), lens);
  EXPECT_TRUE(store->activate(first).value().active);
  EXPECT_FALSE(store->get(second).value().active);
  reopen();
  EXPECT_EQ(active(CalibrationKind::kObject), first);
  EXPECT_EQ(active(CalibrationKind::kCamera), lens);
  EXPECT_TRUE(store->remove(first));
  EXPECT_FALSE(store->active(CalibrationKind::kObject).value())
      << "no other calibration becomes active";
  EXPECT_EQ(store->get(first).error().reason, ErrorReason::CALIBRATION_NOT_FOUND);
  EXPECT_EQ(store->activate(first).error().reason, ErrorReason::CALIBRATION_NOT_FOUND);
  EXPECT_EQ(store->remove(first).error().reason, ErrorReason::CALIBRATION_NOT_FOUND);
}

TEST_F(CalibrationStoreTest, RepeatedRequestStoresNothing) {
  const auto id = enter(CalibrationKind::kObject, "r").id;
  EXPECT_EQ(enter(CalibrationKind::kObject, "r").id, id);
  EXPECT_EQ(store->list(0, 10).value().size(), 1U);
}

TEST_F(CalibrationStoreTest, ListIsPagedNewestFirst) {
  for (int i = 0; i < 3; ++i) enter();
  const auto page = store->list(0, 2).value();
  ASSERT_EQ(page.size(), 2U);
  EXPECT_GT(page[0].id, page[1].id);
  EXPECT_EQ(store->list(page[1].id, 2).value().size(), 1U);
}

TEST_F(CalibrationStoreTest, IsStoredWithTheSuccessOfItsJobOrNotAtAll) {
  const std::int64_t done = running();
  ASSERT_TRUE(
      jobs->succeed(done, {}, NewCalibration{CalibrationKind::kObject, "ann", done, 0, ""}));
  ASSERT_EQ(store->list(0, 10).value().size(), 1U);
  EXPECT_EQ(store->list(0, 10).value().front().definition.job, done);
  const std::int64_t cancelled = running();
  ASSERT_TRUE(jobs->cancel(cancelled));
  ASSERT_TRUE(jobs->succeed(cancelled, {},
                            NewCalibration{CalibrationKind::kObject, "ann", cancelled, 0, ""}));
  EXPECT_EQ(store->list(0, 10).value().size(), 1U);
}

TEST_F(CalibrationStoreTest, PreventsTheDeletionOfItsJob) {
  const std::int64_t job = running();
  ASSERT_TRUE(jobs->succeed(job, {}, NewCalibration{CalibrationKind::kObject, "ann", job, 0, ""}));
  EXPECT_EQ(jobs->remove(job).error().reason, ErrorReason::STATE_FORBIDS);
  now_ms += 10 * retention_times.finished_ms;
  EXPECT_TRUE(job_retention->purge());
  EXPECT_TRUE(jobs->get(job));
  ASSERT_TRUE(store->remove(store->list(0, 1).value().front().id));
  EXPECT_TRUE(job_retention->purge());
  EXPECT_FALSE(jobs->get(job));
}

TEST_F(CalibrationStoreTest, RigStateOutlivesTheCapture) {
  const RigPlace place{true, true, 20.5, 3, 4};
  NewJob definition;
  definition.work.verb = "capture";
  definition.traits.computed = false;
  const Job capture = jobs->create(definition, {}).value();
  EXPECT_EQ(capture.state, JobState::kRunning);
  EXPECT_EQ(capture.start_ms, now_ms);
  EXPECT_EQ(jobs->create(definition, {}).error().reason, ErrorReason::STATE_FORBIDS)
      << "captures run one at a time";
  ASSERT_TRUE(store->note_capture(capture.id, place));
  ASSERT_TRUE(jobs->succeed(capture.id, {}));
  const auto id =
      store->create({CalibrationKind::kObject, "ann", 0, capture.id, ""}, {}).value().id;
  ASSERT_TRUE(jobs->remove(capture.id));
  reopen();
  const auto captured = store->get(id).value().captured;
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->place, place);
  EXPECT_EQ(captured->time_ms, now_ms);
  EXPECT_EQ(store->capture(capture.id).value()->place, place);
  EXPECT_FALSE(store->capture(77).value());
}

TEST_F(CalibrationStoreTest, LostCaptureStaysInterrupted) {
  NewJob definition;
  definition.work.verb = "capture";
  definition.traits.computed = false;
  const Job capture = jobs->create(definition, {}).value();
  reopen();
  EXPECT_EQ(jobs->get(capture.id).value().state, JobState::kInterrupted);
}

}  // namespace
}  // namespace hydroprint::daemon
