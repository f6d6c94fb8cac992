// The rig and its lease from a client's view, through hydroprintd and hydroprint-virtual-rig.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tests/daemon/api/rig_support.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using std::chrono::milliseconds;

constexpr const char* kRigHealth = "hydroprint.v1.RigService";

TEST(NoRig, ApiIsServedAndReportsTheMissingRig) {
  const TemporaryFolder folder;
  const DaemonProcess daemon(folder.path(), DaemonProcess::fake());
  RigClient ann(daemon.address());
  const v1::Rig rig = ann.rig();
  EXPECT_EQ(rig.state(), v1::Rig::OFFLINE);
  EXPECT_NE(rig.trouble().find("no rig is configured"), std::string::npos) << rig.trouble();
  EXPECT_FALSE(rig.has_axis());
  EXPECT_TRUE(ann.stop().ok());
  EXPECT_EQ(reason_of(ann.arm()), "LEASE_REQUIRED");
  ann.take_lease();
  for (const grpc::Status& refused :
       {ann.arm(), ann.home(), ann.move_to(5), ann.jog(1), ann.disarm(), ann.reset()}) {
    EXPECT_EQ(reason_of(refused), "RIG_OFFLINE");
    EXPECT_EQ(refused.error_code(), grpc::FAILED_PRECONDITION);
  }
  v1::Job job;
  EXPECT_EQ(reason_of(ann.create_dip(short_dip(), job)), "RIG_OFFLINE");
  EXPECT_EQ(health_of(ann, kRigHealth), "NOT_SERVING");
  EXPECT_EQ(health_of(ann, "hydroprint.v1.LeaseService"), "SERVING");
  EXPECT_EQ(health_of(ann, "hydroprint.v1.JobService"), "SERVING");
}

TEST(NoRig, UnsafeConfigurationIsRefusedOnOneLine) {
  const auto refused = run_daemon({"--rig", "tcp:127.0.0.1:1502", "--rig-profile",
                                   testing::drive_profile_path("none"), "--check-config"});
  EXPECT_EQ(refused.status, 3) << refused.words;
  const TemporaryFolder folder;
  const auto torn = folder.write("torn.toml", "[rig]\n\"a\\nb\" = 2\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--config", torn, "--check-config"},
        {"--rig", "tcp:127.0.0.1:1502", "--rig-profile", torn, "--check-config"},
        {"--config", "no\nne.toml", "--check-config"}}) {
    const auto told = run_daemon(arguments);
    EXPECT_EQ(told.status, 3) << told.words;
    EXPECT_EQ(std::count(told.words.begin(), told.words.end(), '\n'), 1) << told.words;
  }
  const auto config = folder.write("d.toml", "[rig]\nkeep_out_mm = 2\n");
  const auto unsafe =
      run_daemon({"--rig", "tcp:127.0.0.1:1502", "--rig-profile",
                  testing::drive_profile_path("virtual"), "--config", config, "--check-config"});
  EXPECT_EQ(unsafe.status, 3);
  EXPECT_NE(unsafe.words.find("rig.keep_out_mm is 2"), std::string::npos) << unsafe.words;
  EXPECT_EQ(std::count(unsafe.words.begin(), unsafe.words.end(), '\n'), 1) << unsafe.words;
}

TEST(NoRig, SilentDriveIsOfflineWithAReason) {
  const TemporaryFolder folder;
  auto options = DaemonProcess::fake();
  options.extra = "[rig]\ndrive = \"tcp:127.0.0.1:1\"\nprofile = \"" +
                  testing::drive_profile_path("virtual") + "\"\n";
  const DaemonProcess daemon(folder.path(), options);
  RigClient ann(daemon.address());
  ASSERT_TRUE(wait_until([&] { return !ann.rig().trouble().empty(); }));
  EXPECT_EQ(ann.rig().state(), v1::Rig::OFFLINE);
  EXPECT_TRUE(ann.rig().axis().is_virtual());
  EXPECT_FALSE(ann.rig().has_position_mm());
  ann.take_lease();
  EXPECT_EQ(reason_of(ann.arm()), "RIG_OFFLINE");
}

class RigApi : public RigTest {};

TEST_F(RigApi, MotionRequiresArmingAndHoming) {
  ann.take_lease();
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  EXPECT_EQ(reason_of(ann.move_to(20)), "STATE_FORBIDS");
  ASSERT_TRUE(ann.arm().ok());
  EXPECT_EQ(ann.rig().state(), v1::Rig::UNHOMED);
  EXPECT_EQ(reason_of(ann.move_to(20)), "RIG_NOT_HOMED");
  EXPECT_EQ(reason_of(ann.jog(5)), "RIG_NOT_HOMED");
  ASSERT_TRUE(ann.home().ok());
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE, 30));
  EXPECT_TRUE(ann.rig().homed());
  ASSERT_TRUE(ann.move_to(12).ok());
  EXPECT_EQ(reason_of(ann.move_to(30)), "MOTION_IN_PROGRESS");
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  const v1::Rig now = ann.rig();
  EXPECT_NEAR(now.position_mm(), 12, 0.1);
  EXPECT_EQ(now.motion().kind(), v1::Motion::MOVE);
  EXPECT_EQ(now.motion().outcome(), v1::Motion::DONE);
  EXPECT_EQ(now.axis().min_mm(), 2);
  EXPECT_EQ(now.axis().max_mm(), 298);
  EXPECT_EQ(now.lease().holder(), "ann");
  EXPECT_EQ(now.lease().lease_id(), "") << "the lease id is a secret";
  EXPECT_GT(now.link_quality().polls(), 0U);
  v1::MoveToRequest plain;
  plain.set_lease_id(ann.lease_id);
  plain.set_position_mm(50);
  v1::Rig reply;
  ASSERT_TRUE(ann.rigs->MoveTo(ann.context().get(), plain, &reply).ok());
  EXPECT_TRUE(rig.gets_to(5)) << "the default speed is 5 mm/s";
  ASSERT_TRUE(ann.stop().ok());
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  ASSERT_TRUE(ann.disarm().ok());
  EXPECT_EQ(ann.rig().state(), v1::Rig::DISARMED);
  EXPECT_FALSE(ann.rig().homed());
}

TEST_F(RigApi, InvalidTargetsAreRefusedWithoutMotion) {
  ann.make_ready();
  const double rest_mm = rig.position_mm();
  const auto status = ann.move_to(299);
  EXPECT_EQ(status.error_code(), grpc::OUT_OF_RANGE);
  EXPECT_EQ(error_info(status).metadata().at("max"), "298");
  EXPECT_EQ(reason_of(ann.move_to(50, 11)), "LIMIT_EXCEEDED");
  EXPECT_EQ(reason_of(ann.jog(11)), "LIMIT_EXCEEDED");
  EXPECT_EQ(reason_of(ann.jog(0)), "LIMIT_EXCEEDED");
  EXPECT_EQ(reason_of(ann.jog(NAN)), "SPEC_INVALID");
  EXPECT_EQ(reason_of(ann.move_to(NAN)), "SPEC_INVALID");
  v1::MoveToRequest request;
  request.set_lease_id(ann.lease_id);
  v1::Rig reply;
  EXPECT_EQ(reason_of(ann.rigs->MoveTo(ann.context().get(), request, &reply)), "SPEC_INVALID");
  EXPECT_EQ(rig.position_mm(), rest_mm);
}

TEST_F(RigApi, HealthFollowsTheRig) {
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  EXPECT_TRUE(wait_until([&] { return health_of(ann, kRigHealth) == "SERVING"; }, 2));
  rig.act("unplug");
  EXPECT_TRUE(wait_until([&] { return health_of(ann, kRigHealth) == "NOT_SERVING"; }, 2));
  rig.act("replug");
  EXPECT_TRUE(wait_until([&] { return health_of(ann, kRigHealth) == "SERVING"; }, 5));
  rig.act("press stop");
  EXPECT_TRUE(wait_until([&] { return health_of(ann, kRigHealth) == "NOT_SERVING"; }, 2));
  EXPECT_EQ(ann.rig().state(), v1::Rig::ESTOPPED);
  EXPECT_TRUE(ann.rig().stop_button());
  EXPECT_EQ(ann.rig().cause(), "STOP_BUTTON");
  EXPECT_FALSE(ann.rig().trouble().empty());
}

TEST_F(RigApi, StopNeedsNoLease) {
  ann.make_ready();
  RigClient bob(daemon.address(), "bob");
  EXPECT_TRUE(bob.stop().ok()) << "a stop at rest is not an error";
  ASSERT_TRUE(ann.move_to(200, 10).ok());
  ASSERT_TRUE(rig.gets_to(10));
  const double asked_s = rig.now_s();
  ASSERT_TRUE(bob.stop().ok());
  EXPECT_LT(rig.rested_s() - asked_s, 0.3);
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  EXPECT_EQ(ann.rig().motion().outcome(), v1::Motion::STOPPED);
  EXPECT_TRUE(ann.move_to(10).ok()) << "the next order is accepted";
}

TEST_F(RigApi, StopIgnoresUnknownFields) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(290, 5).ok());
  ASSERT_TRUE(rig.gets_to(5));
  v1::StopMotionRequest request;
  auto* unknown = request.GetReflection()->MutableUnknownFields(&request);
  unknown->AddLengthDelimited(1, "\xff not a lease");
  unknown->AddFixed64(1, 7);
  v1::Rig reply;
  EXPECT_TRUE(ann.rigs->StopMotion(ann.context().get(), request, &reply).ok());
  EXPECT_TRUE(rig.gets_to(0));
}

TEST_F(RigApi, SecondOperatorMayBreakTheLeaseWithAReason) {
  ann.make_ready();
  RigClient bob(daemon.address(), "bob");
  v1::Lease lease;
  const auto held = bob.acquire(lease);
  EXPECT_EQ(held.error_code(), grpc::ABORTED);
  EXPECT_EQ(reason_of(held), "LEASE_HELD");
  EXPECT_EQ(error_info(held).metadata().at("holder"), "ann");
  EXPECT_EQ(error_info(held).metadata().at("purpose"), "test");
  EXPECT_EQ(reason_of(ann.acquire(lease)), "LEASE_HELD")
      << "the holder cannot acquire the lease twice, either";
  const auto required = bob.move_to(20);
  EXPECT_EQ(reason_of(required), "LEASE_REQUIRED");
  EXPECT_EQ(error_info(required).metadata().at("holder"), "ann");
  bob.lease_id = std::string(32, '0');
  EXPECT_EQ(reason_of(bob.move_to(20)), "LEASE_REQUIRED");
  EXPECT_EQ(reason_of(bob.break_lease("")), "SPEC_INVALID");
  EXPECT_TRUE(bob.break_lease("ann went home").ok());
  EXPECT_NE(daemon.log().find("event=lease_broken"), std::string::npos);
  EXPECT_NE(daemon.log().find("ann went home"), std::string::npos);
  EXPECT_EQ(reason_of(ann.move_to(20)), "LEASE_REQUIRED");
  bob.take_lease();
  EXPECT_TRUE(bob.move_to(20).ok());
  EXPECT_TRUE(ann.release().ok()) << "releasing a broken lease is not an error and has no effect";
  EXPECT_EQ(bob.rig().lease().holder(), "bob");
}

TEST_F(RigApi, LeaseIdIsSecretAndExpires) {
  v1::Lease none;
  EXPECT_EQ(reason_of(ann.leases->GetLease(ann.context().get(), {}, &none)), "LEASE_NOT_FOUND");
  v1::Lease first, second, shown;
  ASSERT_TRUE(ann.acquire(first, 600, "r1").ok());
  ASSERT_TRUE(ann.acquire(second, 600, "r1").ok())
      << "repeating the request returns the same lease";
  EXPECT_EQ(first.lease_id(), second.lease_id());
  EXPECT_EQ(first.lease_id().size(), 32U);
  ASSERT_TRUE(ann.leases->GetLease(ann.context().get(), {}, &shown).ok());
  EXPECT_EQ(shown.holder(), "ann");
  EXPECT_EQ(shown.lease_id(), "");
  ann.lease_id = first.lease_id();
  v1::RenewLeaseRequest renew;
  renew.set_lease_id(ann.lease_id);
  renew.mutable_ttl()->set_seconds(1);
  v1::Lease renewed;
  ASSERT_TRUE(ann.leases->RenewLease(ann.context().get(), renew, &renewed).ok());
  EXPECT_LT(renewed.expire_time().seconds(), first.expire_time().seconds());
  EXPECT_TRUE(wait_until([&] { return !ann.rig().has_lease(); }, 3));
  EXPECT_EQ(reason_of(ann.leases->RenewLease(ann.context().get(), renew, &renewed)),
            "LEASE_REQUIRED");
  EXPECT_EQ(reason_of(ann.acquire(second, 600, "r1")), "LEASE_REQUIRED");
  EXPECT_TRUE(ann.acquire(second, 600, "r2").ok());
  EXPECT_NE(second.lease_id(), first.lease_id());
  v1::Lease out_of_range;
  RigClient bob(daemon.address(), "bob");
  EXPECT_EQ(reason_of(bob.acquire(out_of_range, 0)), "SPEC_INVALID");
  EXPECT_EQ(reason_of(bob.acquire(out_of_range, 8 * 3600 + 1)), "SPEC_INVALID");
}

TEST_F(RigApi, LeaseSurvivesTheDaemon) {
  ann.take_lease();
  daemon.kill();
  daemon.start();
  RigClient again(daemon.address(), "ann");
  again.lease_id = ann.lease_id;
  EXPECT_EQ(again.rig().lease().holder(), "ann");
  EXPECT_NE(reason_of(again.move_to(20)), "LEASE_REQUIRED");
  v1::Lease lease;
  RigClient bob(daemon.address(), "bob");
  EXPECT_EQ(reason_of(bob.acquire(lease)), "LEASE_HELD");
}

TEST_F(RigApi, RepeatedRequestMovesOnce) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(6, 10, "m1").ok());
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  const auto motion = ann.rig().motion().number();
  EXPECT_TRUE(ann.move_to(6, 10, "m1").ok());
  EXPECT_EQ(ann.rig().motion().number(), motion);
  EXPECT_EQ(reason_of(ann.move_to(30, 10, "m1")), "REQUEST_ID_REUSED");
  EXPECT_EQ(reason_of(ann.move_to(299, 10, "m2")), "LIMIT_EXCEEDED");
  EXPECT_EQ(reason_of(ann.move_to(299, 10, "m2")), "LIMIT_EXCEEDED")
      << "a refused request is checked again";
  EXPECT_TRUE(ann.home("h1").ok());
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE, 30));
  EXPECT_TRUE(ann.home("h1").ok());
  EXPECT_EQ(ann.rig().motion().number(), motion + 1);
}

TEST_F(RigApi, JogStopsWithin500msOfTheLastCall) {
  ann.make_ready();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(ann.jog(5).ok());
    std::this_thread::sleep_for(milliseconds(100));
  }
  EXPECT_NEAR(rig.speed_mm_per_s(), 5, 0.01);
  const double last_s = rig.now_s();
  ASSERT_TRUE(ann.jog(5).ok());  // last call, as if the client were killed now
  EXPECT_LT(rig.rested_s() - last_s, 0.5);
}

/// Jogs until a call is refused, and returns the reason of the refusal; "" after 200 calls.
std::string jog_until_refused(RigClient& client) {
  for (int i = 0; i < 200; ++i) {
    const std::string reason = reason_of(client.jog(5));
    if (!reason.empty()) return reason;
    std::this_thread::sleep_for(milliseconds(20));
  }
  return "";
}

TEST_F(RigApi, BreakingTheLeaseStopsAHeldJogAtOnce) {
  ann.make_ready();
  RigClient bob(daemon.address(), "bob");
  std::string reason;
  std::thread holding([&] { reason = jog_until_refused(ann); });
  const bool jogs = rig.gets_to(5);
  const double asked_s = rig.now_s();
  const bool broken = bob.break_lease("test").ok();
  holding.join();
  EXPECT_TRUE(jogs && broken);
  EXPECT_LT(rig.rested_s() - asked_s, 0.2) << "a jog that ends by itself takes longer";
  EXPECT_NE(reason, "");
  EXPECT_EQ(reason_of(ann.jog(5)), "LEASE_REQUIRED");
}

TEST_F(RigApi, ExpiredLeaseStopsAJog) {
  ann.make_ready();
  v1::RenewLeaseRequest renew;
  renew.set_lease_id(ann.lease_id);
  renew.mutable_ttl()->set_seconds(1);
  v1::Lease renewed;
  ASSERT_TRUE(ann.leases->RenewLease(ann.context().get(), renew, &renewed).ok());
  EXPECT_EQ(jog_until_refused(ann), "LEASE_REQUIRED");
  const double refused_s = rig.now_s();
  EXPECT_LT(rig.rested_s() - refused_s, 0.3);
}

TEST_F(RigApi, MoveContinuesWhenTheLeaseEnds) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(12, 10).ok());
  ASSERT_TRUE(rig.gets_to(10));
  ASSERT_TRUE(ann.release().ok());
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  EXPECT_NEAR(rig.position_mm(), 12, 0.1);
}

TEST_F(RigApi, FaultRequiresAResetWhichStartsNoMotion) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(100, 10).ok());
  ASSERT_TRUE(rig.gets_to(10));
  rig.act("stall");
  ASSERT_TRUE(ann.becomes(v1::Rig::FAULT));
  EXPECT_FALSE(ann.rig().cause().empty());
  EXPECT_EQ(reason_of(ann.move_to(10)), "RIG_FAULTED");
  rig.act("clear");
  ASSERT_TRUE(ann.reset().ok());
  EXPECT_EQ(ann.rig().state(), v1::Rig::DISARMED);
  EXPECT_EQ(rig.speed_mm_per_s(), 0);
}

TEST_F(RigApi, CommandsNeverReturnUnavailable) {
  const auto begin = [&](const std::string& fault) {
    SCOPED_TRACE(fault);
    ann.make_ready();
    EXPECT_TRUE(ann.move_to(100).ok());
    EXPECT_TRUE(rig.gets_to(10));
    rig.act(fault);
    do {
      for (const grpc::Status& status :
           {ann.move_to(50), ann.jog(5), ann.home(), ann.arm(), ann.disarm(), ann.reset()}) {
        EXPECT_NE(status.error_code(), grpc::UNAVAILABLE) << status.error_message();
        EXPECT_EQ(status.ok(), reason_of(status).empty());
      }
    } while (ann.rig().motion().outcome() == v1::Motion::RUNNING);
  };
  for (const char* fault : {"fault busy all", "fault drop all", "silent"}) {
    begin(fault);
    rig.act("clear");
    ASSERT_TRUE(ann.becomes(v1::Rig::FAULT));
    ASSERT_TRUE(ann.reset().ok());
  }
  begin("unplug");
}

TEST_F(RigApi, WatchShowsEachStateAtTheRequestedRate) {
  ann.take_lease();
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  v1::WatchRigRequest request;
  const auto call = ann.context();
  const auto reader = ann.rigs->WatchRig(call.get(), request);
  std::vector<v1::Rig::State> seen;
  std::atomic<bool> watched{false}, armed{false};
  std::thread watching([&] {
    const auto begun = Clock::now();
    int messages = 0;
    std::int64_t latest = 0;
    for (v1::Rig now; reader->Read(&now); ++messages) {
      EXPECT_GT(now.revision(), latest);
      latest = now.revision();
      if (seen.empty() || seen.back() != now.state()) seen.push_back(now.state());
      watched = true;
      if (now.state() == v1::Rig::UNHOMED) armed = true;
    }
    EXPECT_LE(messages, 10 * seconds_since(begun) + 2);
  });
  EXPECT_TRUE(wait_until([&] { return watched.load(); }));
  EXPECT_TRUE(ann.arm().ok());
  EXPECT_TRUE(wait_until([&] { return armed.load(); }, 2));
  call->TryCancel();
  watching.join();
  EXPECT_EQ(seen, (std::vector{v1::Rig::DISARMED, v1::Rig::UNHOMED}));
}

TEST_F(RigApi, RevisionsIncreaseAcrossARestart) {
  const std::int64_t first = ann.rig().revision();
  const std::int64_t second = ann.rig().revision();
  EXPECT_GT(first, 0);
  EXPECT_GT(second, first);
  daemon.kill();
  daemon.start();
  EXPECT_GT(RigClient(daemon.address(), "ann").rig().revision(), second);
}

TEST_F(RigApi, TheLogTellsWhatTheControlLoopGot) {
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  const v1::LinkQuality link = ann.rig().link_quality();
  const std::string entry =
      "event=rig_thread scheduling=" + v1::LinkQuality::Scheduling_Name(link.scheduling()) +
      " memory_locked=" + (link.memory_locked() ? "yes" : "no");
  EXPECT_TRUE(wait_until([&] { return daemon.log().find(entry) != std::string::npos; }))
      << daemon.log();
}

TEST_F(RigApi, AStopThatIsNotObeyedIsLoggedOnceAsCritical) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(200).ok());
  rig.act("press deaf");
  ASSERT_TRUE(ann.stop().ok());
  const std::string entry = "level=critical event=rig_stop_not_obeyed message=\"the drive";
  ASSERT_TRUE(wait_until([&] { return daemon.log().find(entry) != std::string::npos; }));
  // The cause stays while the link is silent, lost and back, and so do its words.
  ASSERT_TRUE(ann.becomes(v1::Rig::FAULT));
  EXPECT_EQ(ann.rig().cause(), "STOP_NOT_OBEYED");
  EXPECT_NE(ann.rig().trouble().find("PRESS THE STOP BUTTON ON THE RIG"), std::string::npos);
  const std::string log = daemon.log();
  EXPECT_EQ(log.find("level=critical"), log.rfind("level=critical"));
}

TEST_F(RigApi, WatchesAndUploadsDoNotBlockAStop) {
  ann.make_ready();
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::Rig>>> watches;
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    contexts.push_back(ann.context());
    watches.push_back(ann.rigs->WatchRig(contexts.back().get(), {}));
    v1::Rig now;
    if (watches.back()->Read(&now)) continue;
    ++refused;
    EXPECT_EQ(reason_of(watches.back()->Finish()), "WATCHES_FULL");
  }
  EXPECT_EQ(refused, 8);
  // Silent uploads occupy all threads of the server.
  RigClient crowd(daemon.address(), "crowd");
  std::vector<std::unique_ptr<v1::UploadChunkResponse>> replies;
  std::vector<std::unique_ptr<grpc::ClientWriter<v1::UploadChunkRequest>>> uploads;
  for (int i = 0; i < 600; ++i) {
    contexts.push_back(crowd.context());
    replies.push_back(std::make_unique<v1::UploadChunkResponse>());
    uploads.push_back(crowd.assets->UploadChunk(contexts.back().get(), replies.back().get()));
  }
  ann.patient = false;
  v1::Rig reply;
  EXPECT_TRUE(wait_until([&] {
    return ann.rigs->GetRig(ann.context().get(), {}, &reply).error_code() ==
           grpc::RESOURCE_EXHAUSTED;
  })) << "the uploads must occupy the server for the test to be meaningful";
  const auto asked = Clock::now();
  EXPECT_TRUE(ann.stop().ok());
  EXPECT_LT(seconds_since(asked), 0.2);
  for (const auto& context : contexts) context->TryCancel();
  for (const auto& upload : uploads) upload->Finish();
}

}  // namespace
}  // namespace hydroprint::tests
