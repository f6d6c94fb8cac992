#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "hydroprint/v1/lease_service.grpc.pb.h"
#include "hydroprint/v1/rig_service.grpc.pb.h"
#include "tests/daemon/api/support.h"
#include "tests/support/virtual_rig.h"

namespace hydroprint::tests {

using testing::VirtualRig;
using testing::VirtualRigOptions;

/// A client that can command the rig. Calls that are expected to succeed throw on failure.
class RigClient : public Client {
 public:
  explicit RigClient(const std::string& address, const std::string& owner = "ann");

  v1::Rig rig();
  /// Acquires the lease and keeps its id for later calls.
  void take_lease(int seconds = 600);
  grpc::Status acquire(v1::Lease& lease, int seconds = 600, const std::string& request_id = "");
  grpc::Status break_lease(const std::string& reason);
  grpc::Status release();
  grpc::Status arm();
  grpc::Status disarm();
  grpc::Status home(const std::string& request_id = "");
  grpc::Status move_to(double position_mm, double speed_mm_per_s = 10,
                       const std::string& request_id = "");
  grpc::Status jog(double speed_mm_per_s);
  grpc::Status stop();
  grpc::Status reset();

  /// Waits until the rig is in this state; false after `seconds`.
  [[nodiscard]] bool becomes(v1::Rig::State state, double seconds = 10);
  /// Acquires the lease, arms and homes the rig.
  void make_ready();
  /// Moves to a position and waits until the axis is there.
  void go_to(double position_mm);

  /// Creates a dip; throws if that fails.
  v1::Job dip(const v1::DipSpec& spec);
  grpc::Status create_dip(const v1::DipSpec& spec, v1::Job& job);
  grpc::Status confirm(const std::string& job, v1::DipStatus::Step step);
  /// Waits until a dip reaches this step.
  v1::Job wait_for_step(const std::string& job, v1::DipStatus::Step step);
  /// Confirms steps until the dip reaches `step`. First contact is the present axis position.
  v1::Job guide_to(const std::string& job, v1::DipStatus::Step step);
  nlohmann::json report(const std::string& job);

  std::string lease_id;
  std::unique_ptr<v1::RigService::Stub> rigs;
  std::unique_ptr<v1::LeaseService::Stub> leases;
};

/// Reason of an error; "" if there is none.
[[nodiscard]] std::string reason_of(const grpc::Status& status);

/// Status of a service according to grpc.health.v1: "SERVING" or "NOT_SERVING".
[[nodiscard]] std::string health_of(const Client& client, const std::string& service);

/// A short dip: 5 mm deep from 3 mm above the water at 10 mm/s, with waiting times of 0.1 s.
[[nodiscard]] v1::DipSpec short_dip();

/// A daemon and its rig.
class RigTest : public ::testing::Test {
 protected:
  static DaemonProcess::Options options(const VirtualRig& rig) {
    auto options = DaemonProcess::fake();
    options.extra = rig.section();
    return options;
  }

  TemporaryFolder folder;
  VirtualRig rig;
  DaemonProcess daemon{folder.path(), options(rig)};
  RigClient ann{daemon.address(), "ann"};
};

}  // namespace hydroprint::tests
