// kill -9 of the daemon at random moments of random motions: the drive stops in time, and
// everything acknowledged exists after a restart. `tests/campaign` runs more rounds and other seeds
// (campaign.h). The seed determines motions and moments, so a failed round can be repeated. The
// line that begins with {"row" is a summary.
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "hardware/rig/limits.h"
#include "tests/daemon/api/rig_support.h"
#include "tests/support/campaign.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using nlohmann::json;
using std::chrono::duration;
using std::chrono::milliseconds;

const int rounds = testing::campaign_rounds(10);
const std::uint32_t seed = testing::campaign_seed(1);

// Range of targets: near the home switch, so that homing is short, and beyond the soft limit at
// 2 mm.
constexpr double kNearest_mm = 3;
constexpr double kFarthest_mm = 12;
constexpr double kFastest_mm_per_s = 10;  // also the virtual drive's homing speed
constexpr double kSlowest_mm_per_s = 1;
// Tolerance beyond the drive's own bounds, for the uncertain moment of the kill and the delay of
// the signal.
constexpr double kSlack_s = 0.05;
constexpr milliseconds kBetweenCalls{40};
constexpr milliseconds kLookAgain{20};
constexpr int kLease_s = 8 * 3600;

enum class Kind { kHome, kMove, kJog, kDip };
constexpr std::array kNames = {"home", "move", "jog", "dip"};

/// One motion, and the moment of the kill.
struct Plan {
  Kind kind = Kind::kHome;
  double speed_mm_per_s = kFastest_mm_per_s;
  double target_mm = 0;          ///< target of a move; start of a dip
  double depth_mm = 0;           ///< only for a dip
  double after_s = 0;            ///< time from the command to the kill
  bool restart_at_once = false;  ///< restart the daemon while the axis may still move
};

Plan draw(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    // Not std::uniform_real_distribution, whose numbers differ between standard libraries.
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  Plan plan;
  plan.kind = static_cast<Kind>(random() % kNames.size());
  plan.restart_at_once = random() % 2 == 0;
  if (plan.kind == Kind::kHome) {
    plan.after_s = between(0, 1);
    return plan;
  }
  plan.speed_mm_per_s = between(kSlowest_mm_per_s, kFastest_mm_per_s);
  plan.target_mm = between(kNearest_mm, kFarthest_mm);
  plan.depth_mm = between(1, 8);
  double way_mm = plan.target_mm;  // from the home position
  if (plan.kind == Kind::kDip) {
    plan.target_mm = kNearest_mm + 1;
    way_mm = 2 * plan.depth_mm + 2;
  }
  plan.after_s = between(0, std::min(1.1 * way_mm / plan.speed_mm_per_s, 2.0));
  return plan;
}

std::string text(int round, const Plan& plan) {
  std::ostringstream out;
  out << "seed " << seed << ", round " << round << ": "
      << kNames.at(static_cast<std::size_t>(plan.kind)) << " at " << plan.speed_mm_per_s
      << " mm/s, killed after " << 1000 * plan.after_s << " ms"
      << (plan.restart_at_once ? ", restarted at once" : "");
  return out.str();
}

/// How the axis came to rest.
struct Standstill {
  bool happened = false;
  bool was_moving = false;
  double seconds = 0;
  double way_mm = 0;
  double position_mm = 0;
};

double number(const json& truth, const char* key) { return truth.at(key).get<double>(); }

bool stands(const json& truth) {
  return number(truth, "velocity_mm_per_s") == 0 && !truth.at("moving").get<bool>();
}

/// Waits until the axis rests. `killed` is the state of the drive just before the kill.
Standstill watch_it_stop(const VirtualRig& drive, const json& killed) {
  json first;
  const auto rests = [&] {
    first = drive.truth();
    if (!stands(first)) return false;
    // A command may still be on its way to the drive, so this looks twice.
    std::this_thread::sleep_for(kLookAgain);
    const json second = drive.truth();
    return stands(second) && second.at("position_mm") == first.at("position_mm");
  };
  Standstill out;
  out.was_moving = number(killed, "velocity_mm_per_s") != 0;
  out.happened = wait_until(rests, 3);
  // 0 if the axis was at rest all the time.
  out.seconds = std::max(number(first, "rested_s") - number(killed, "time_s"), 0.0);
  out.position_mm = number(first, "position_mm");
  out.way_mm = std::abs(out.position_mm - number(killed, "position_mm"));
  return out;
}

/// Brings the drive from any state to UNHOMED, without motion.
bool gets_armed(RigClient& client) {
  return wait_until([&] {
    const v1::Rig::State state = client.rig().state();
    if (state == v1::Rig::FAULT) (void)client.reset();
    if (state == v1::Rig::DISARMED) (void)client.arm();
    return state == v1::Rig::UNHOMED;
  });
}

bool renews_lease(RigClient& client) {
  v1::RenewLeaseRequest request;
  request.set_lease_id(client.lease_id);
  request.mutable_ttl()->set_seconds(kLease_s);
  v1::Lease lease;
  return client.leases->RenewLease(client.context().get(), request, &lease).ok();
}

v1::DipSpec dip_of(const Plan& plan) {
  v1::DipSpec spec;
  spec.set_depth_mm(plan.depth_mm);
  spec.set_speed_mm_per_s(plan.speed_mm_per_s);
  spec.set_hold_s(0.1);
  spec.set_clearance_mm(1);
  spec.set_yes_to_all(true);
  return spec;
}

/// First column of a query's result. The daemon may run meanwhile.
std::vector<std::string> rows_of(const std::filesystem::path& database, const char* sql) {
  std::vector<std::string> out;
  const auto keep = [](void* rows, int, char** values, char**) {
    const char* const value = values[0] == nullptr ? "" : values[0];
    static_cast<std::vector<std::string>*>(rows)->emplace_back(value);
    return 0;
  };
  sqlite3* db = nullptr;
  if (sqlite3_open_v2(database.c_str(), &db, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK ||
      sqlite3_busy_timeout(db, 5000) != SQLITE_OK ||
      sqlite3_exec(db, sql, keep, &out, nullptr) != SQLITE_OK) {
    out.emplace_back(sqlite3_errmsg(db));
  }
  sqlite3_close(db);
  return out;
}

class Campaign {
 public:
  void run();
  [[nodiscard]] nlohmann::ordered_json summary() const;

 private:
  [[nodiscard]] DaemonProcess::Options options() const {
    DaemonProcess::Options options = DaemonProcess::fake();
    options.max_jobs = 100000;
    options.extra = drive_.section();
    return options;
  }
  void meet_daemon();
  [[nodiscard]] bool is_prepared(const Plan& plan);
  void prepare(const Plan& plan);
  void move_until_killed(const Plan& plan);
  void keep_busy(const Plan& plan);
  void expect_obeyed(const grpc::Status& sent);
  void restart();
  void note_acknowledged(const v1::Job& job) { acknowledged_.push_back(job.name()); }
  void expect_stopped_in_time(const Plan& plan, const Standstill& stop);
  void expect_whole_store() const;
  void expect_cold_rig(const Standstill& stop);
  void expect_ended(const v1::Job& dip);
  void expect_jobs();

  TemporaryFolder folder_;
  VirtualRig drive_;
  DaemonProcess daemon_{folder_.path(), options()};
  std::unique_ptr<RigClient> client_;
  std::string lease_id_;
  std::string asset_;
  std::vector<std::string> acknowledged_;       // names of acknowledged jobs
  std::string dip_;                             // dip of this round, if acknowledged
  std::map<std::string, v1::Job::State> dips_;  // final states of earlier dips
  Standstill stop_;
  int moving_ = 0, in_dips_ = 0, spoilt_ = 0;
  double most_time_share_ = 0, most_way_share_ = 0, longest_start_s_ = 0;
};

void Campaign::meet_daemon() {
  client_ = std::make_unique<RigClient>(daemon_.address());
  client_->lease_id = lease_id_;
}

/// Arms the rig and, if needed, homes it and moves to the start of the motion.
bool Campaign::is_prepared(const Plan& plan) {
  if (!gets_armed(*client_)) return false;
  if (plan.kind == Kind::kHome) return true;
  if (!client_->home().ok() || !client_->becomes(v1::Rig::IDLE)) return false;
  if (plan.kind != Kind::kDip) return true;
  return client_->move_to(plan.target_mm).ok() && client_->becomes(v1::Rig::IDLE) &&
         client_->rig().motion().outcome() == v1::Motion::DONE;
}

void Campaign::prepare(const Plan& plan) {
  for (int spoilt = 0; spoilt < 3; ++spoilt, ++spoilt_) {
    if (is_prepared(plan)) return;
    (void)client_->stop();
    (void)client_->disarm();
  }
  FAIL() << "the rig does not become ready: " << client_->rig().trouble();
}

/// Counts rounds in which the motion was refused or stopped before the kill. On a busy machine, a
/// reply of the drive or a call that continues a jog may be late; the daemon then stops the axis.
void Campaign::expect_obeyed(const grpc::Status& sent) {
  if (sent.ok() || sent.error_code() == grpc::UNAVAILABLE) return;
  ++spoilt_;
  std::cout << "motion not as planned: " << reason_of(sent) << ": " << sent.error_message()
            << std::endl;
}

/// Sends the command, then keeps calling the daemon until it is gone.
void Campaign::keep_busy(const Plan& plan) {
  client_->patient = false;
  v1::Job job;
  grpc::Status sent;
  if (plan.kind == Kind::kHome) sent = client_->home();
  if (plan.kind == Kind::kMove) sent = client_->move_to(plan.target_mm, plan.speed_mm_per_s);
  if (plan.kind == Kind::kDip) {
    sent = client_->create_dip(dip_of(plan), job);
    if (sent.ok()) note_acknowledged(job);
    dip_ = job.name();
  }
  expect_obeyed(sent);
  while (sent.ok()) {
    if (plan.kind == Kind::kJog) sent = client_->jog(plan.speed_mm_per_s);
    if (sent.error_code() != grpc::OUT_OF_RANGE && !sent.ok()) return expect_obeyed(sent);
    auto request = simulate_request(asset_);
    sent = client_->create(request, job);
    if (sent.ok()) note_acknowledged(job);
    std::this_thread::sleep_for(kBetweenCalls);
  }
}

void Campaign::move_until_killed(const Plan& plan) {
  dip_.clear();
  std::promise<void> killed;
  std::thread killer([&, pid = daemon_.pid()] {
    std::this_thread::sleep_for(duration<double>(plan.after_s));
    const json before = drive_.truth();
    ::kill(pid, SIGKILL);
    killed.set_value();
    stop_ = watch_it_stop(drive_, before);
  });
  keep_busy(plan);
  killed.get_future().wait();
  daemon_.kill();  // waits for the end of the process
  if (plan.restart_at_once) restart();
  killer.join();
  moving_ += stop_.was_moving ? 1 : 0;
  in_dips_ += dip_.empty() ? 0 : 1;
}

void Campaign::restart() {
  longest_start_s_ = std::max(longest_start_s_, testing::seconds_of([&] { daemon_.start(); }));
}

void Campaign::expect_stopped_in_time(const Plan& plan, const Standstill& stop) {
  const auto profile = drive::read_drive_profile(testing::drive_profile_path("virtual"));
  ASSERT_TRUE(profile);
  const double watchdog_s = profile->watchdog->largest_time_s;
  // Homing always uses the same speed, whatever the plan.
  const double speed = plan.kind == Kind::kHome ? kFastest_mm_per_s : plan.speed_mm_per_s;
  const double in_s = watchdog_s + speed / profile->stopping_deceleration_mm_per_s2;
  const double in_mm = drive::stopping_distance_mm(*profile, speed, watchdog_s);
  ASSERT_TRUE(stop.happened) << "the axis still moves after 3 s";
  EXPECT_LE(stop.seconds, in_s + kSlack_s);
  EXPECT_LE(stop.way_mm, in_mm + speed * kSlack_s);
  const rig::RigConfig config;
  EXPECT_GE(stop.position_mm, config.end_low_mm);
  EXPECT_LE(in_mm, rig::stopping_distance_mm(config, *profile, speed))
      << "the rig's keep-out would be shorter than the drive's stopping distance";
  if (!stop.was_moving) return;
  most_time_share_ = std::max(most_time_share_, stop.seconds / in_s);
  most_way_share_ = std::max(most_way_share_, stop.way_mm / in_mm);
}

void Campaign::expect_whole_store() const {
  const auto database = daemon_.state() / "hydroprint.db";
  EXPECT_EQ(rows_of(database, "PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  EXPECT_EQ(rows_of(database, "PRAGMA foreign_key_check"), std::vector<std::string>{});
}

/// Expects that homing is required and that nothing moves before homing.
void Campaign::expect_cold_rig(const Standstill& stop) {
  // The daemon may have found the drive in motion. Two polls show that it stands still.
  ASSERT_TRUE(wait_until([&] {
    const v1::Rig::State state = client_->rig().state();
    return state != v1::Rig::OFFLINE && state != v1::Rig::STOPPING;
  }));
  const v1::Rig rig = client_->rig();
  EXPECT_TRUE(rig.state() == v1::Rig::FAULT || rig.state() == v1::Rig::DISARMED)
      << v1::Rig::State_Name(rig.state());
  EXPECT_FALSE(rig.homed());
  EXPECT_EQ(rig.dip(), "");
  const std::string refused = reason_of(client_->move_to(kFarthest_mm));
  EXPECT_TRUE(refused == "RIG_FAULTED" || refused == "STATE_FORBIDS") << refused;
  EXPECT_TRUE(renews_lease(*client_)) << "the lease was acknowledged, so it must still exist";
  ASSERT_TRUE(gets_armed(*client_));
  EXPECT_EQ(reason_of(client_->move_to(kFarthest_mm)), "RIG_NOT_HOMED");
  EXPECT_EQ(reason_of(client_->jog(5)), "RIG_NOT_HOMED");
  EXPECT_EQ(drive_.position_mm(), stop.position_mm) << "neither reset nor arming may move the axis";
}

/// Checks the end of a dip that was open, or had just ended, at the kill.
void Campaign::expect_ended(const v1::Job& dip) {
  const auto [known, is_new] = dips_.emplace(dip.name(), dip.state());
  EXPECT_EQ(dip.state(), known->second) << dip.name() << " had already ended in this state";
  const bool may_be_done = !stop_.was_moving && dip.state() == v1::Job::SUCCEEDED;
  if (is_new && !may_be_done) {
    EXPECT_EQ(v1::Job::State_Name(dip.state()), "INTERRUPTED") << dip.name();
    EXPECT_EQ(client_->report(dip.name()).at("outcome"), "INTERRUPTED") << dip.name();
  }
}

/// Checks that all acknowledged jobs exist and no dip is open.
void Campaign::expect_jobs() {
  std::set<std::string> there;
  v1::ListJobsRequest request;
  request.set_page_size(1000);
  do {
    v1::ListJobsResponse page;
    ASSERT_TRUE(client_->jobs->ListJobs(client_->context().get(), request, &page).ok());
    for (const v1::Job& job : page.jobs()) {
      there.insert(job.name());
      if (job.has_dip()) expect_ended(job);
    }
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  for (const std::string& name : acknowledged_) EXPECT_TRUE(there.contains(name)) << name;
}

void Campaign::run() {
  std::mt19937 random(seed);
  meet_daemon();
  client_->take_lease(kLease_s);
  lease_id_ = client_->lease_id;
  client_->pause();
  asset_ = client_->upload("sleep 0");
  for (int round = 1; round <= rounds; ++round) {
    const Plan plan = draw(random);
    SCOPED_TRACE(text(round, plan));
    prepare(plan);
    if (::testing::Test::HasFatalFailure()) return;
    move_until_killed(plan);
    expect_stopped_in_time(plan, stop_);
    if (!plan.restart_at_once) restart();
    expect_whole_store();
    meet_daemon();
    expect_cold_rig(stop_);
    expect_jobs();
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_LE(spoilt_, 1 + rounds / 20) << "too many rounds did not go as planned";
}

nlohmann::ordered_json Campaign::summary() const {
  return {{"row", "kills"},
          {"seed", seed},
          {"rounds", rounds},
          {"failures", ::testing::Test::HasFailure() ? 1 : 0},
          {"killed_in_motion", moving_},
          {"killed_in_dips", in_dips_},
          {"acknowledged_jobs", acknowledged_.size()},
          {"most_time_share", most_time_share_},
          {"most_way_share", most_way_share_},
          {"spoilt", spoilt_},
          {"longest_start_s", longest_start_s_}};
}

TEST(Killed, AtAnyMomentTheDriveStopsAndTheStoreIsIntact) {
  Campaign campaign;
  campaign.run();
  std::cout << campaign.summary().dump() << std::endl;
}

}  // namespace
}  // namespace hydroprint::tests
