// Measures the rig's motion through the API: hydroprintd and hydroprint-virtual-rig, on an idle
// machine or with a simulation on every core.
//
//   bench_motion idle | busy MODEL.obj
//
// Prints one JSON object per row. README.md describes the method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "hardware/drive/profile.h"
#include "tests/daemon/api/rig_support.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr int kTries = 40;
constexpr int kCores = 2;  // tests/bench/run uses two cores
constexpr int kJobs = 400;
constexpr double kSpeed_mm_per_s = 10;
constexpr double kDipSpeed_mm_per_s = 5;
constexpr double kDepth_mm = 40;
constexpr double kHigh_mm = 10;
constexpr double kLow_mm = 60;

/// The drive's acceleration, also used for stopping.
double acceleration() {
  const auto profile = drive::read_drive_profile(testing::drive_profile_path("virtual"));
  if (!profile) throw std::runtime_error(profile.error().message);
  return profile->acceleration_mm_per_s2;
}

double time_of(const json& truth) { return truth.at("time_s").get<double>(); }
double speed_of(const json& truth) { return std::abs(truth.at("velocity_mm_per_s").get<double>()); }

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

ordered_json row(const std::string& name, const std::vector<double>& seconds) {
  return {{"row", name},
          {"median_s", median(seconds)},
          {"max_s", *std::max_element(seconds.begin(), seconds.end())},
          {"tries", seconds.size()}};
}

void check(const grpc::Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error_message());
}

class Bench {
 public:
  explicit Bench(std::string mode) : mode_(std::move(mode)) { client_.make_ready(); }

  /// Queues enough simulations to occupy every core until the end, and waits until they run.
  void make_busy(const std::string& model_path);
  void run();

 private:
  [[nodiscard]] DaemonProcess::Options options() const {
    DaemonProcess::Options options;
    options.slots = kCores;
    options.extra = drive_.section();
    return options;
  }
  /// Polls without pause until the drive's speed satisfies the condition; returns that state.
  json look_until(const std::function<bool(double)>& speed_is);
  double command_to_motion(double target_mm);
  double stop_to_standstill();
  void take_latencies();
  void take_dip();
  void take_sampling(const v1::LinkQuality& before);
  void check_busy();

  std::string mode_;
  TemporaryFolder folder_;
  VirtualRig drive_;
  DaemonProcess daemon_{folder_.path(), options()};
  RigClient client_{daemon_.address()};
  const double acceleration_ = acceleration();
};

void Bench::make_busy(const std::string& model_path) {
  std::ifstream file(model_path, std::ios::binary);
  const std::string model{std::istreambuf_iterator<char>(file), {}};
  for (int i = 0; i < kJobs; ++i) {
    // The same mesh with a different depth each time, so that no result comes from the cache.
    auto request = simulate_request(client_.upload(model), "model.obj");
    v1::SimulateSpec& spec = *request.mutable_job()->mutable_simulate();
    spec.set_depth_mm(60 + 0.05 * i);
    v1::Job job;
    check(client_.create(request, job));
  }
  while (client_.queue().running_jobs_size() < kCores) {
    std::this_thread::sleep_for(milliseconds(20));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
}

void Bench::check_busy() {
  if (mode_ == "idle") return;
  const v1::Queue queue = client_.queue();
  if (queue.queued_count() == 0) throw std::runtime_error("no simulations are left in the queue");
}

json Bench::look_until(const std::function<bool(double)>& speed_is) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  for (;;) {
    json now = drive_.truth();
    if (speed_is(speed_of(now))) return now;
    if (std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error("the expected speed was not reached in time");
  }
}

/// Returns the time from the call to the start of the motion, computed with v = a t from the
/// observed speed.
double Bench::command_to_motion(double target_mm) {
  const double before_s = time_of(drive_.truth());
  grpc::Status sent;
  std::thread call([&] { sent = client_.move_to(target_mm, kSpeed_mm_per_s); });
  const json moving = look_until([](double speed) { return speed > 0; });
  call.join();
  check(sent);
  return time_of(moving) - speed_of(moving) / acceleration_ - before_s;
}

/// Returns the time from the call to standstill, minus the braking time.
double Bench::stop_to_standstill() {
  look_until([](double speed) { return speed == kSpeed_mm_per_s; });
  const double before_s = time_of(drive_.truth());
  grpc::Status sent;
  std::thread call([&] { sent = client_.stop(); });
  const json still = look_until([](double speed) { return speed == 0; });
  call.join();
  check(sent);
  return still.at("rested_s").get<double>() - before_s - kSpeed_mm_per_s / acceleration_;
}

void Bench::take_latencies() {
  std::vector<double> commands, stops;
  for (int i = 0; i < kTries; ++i) {
    const bool is_high = drive_.position_mm() < (kHigh_mm + kLow_mm) / 2;
    commands.push_back(command_to_motion(is_high ? kLow_mm : kHigh_mm));
    // The delay varies, so that stops come at different times between two polls of the daemon.
    std::this_thread::sleep_for(milliseconds(60 + 7 * (i % 13)));
    stops.push_back(stop_to_standstill());
    if (!client_.becomes(v1::Rig::IDLE)) throw std::runtime_error("the rig did not become IDLE");
  }
  std::cout << row("motion-command-" + mode_, commands).dump() << '\n'
            << row("motion-stop-" + mode_, stops).dump() << std::endl;
}

void Bench::take_dip() {
  client_.go_to(kHigh_mm);
  v1::DipSpec spec;
  spec.set_depth_mm(kDepth_mm);
  spec.set_speed_mm_per_s(kDipSpeed_mm_per_s);
  spec.set_yes_to_all(true);
  const v1::Job job = client_.wait_for(client_.dip(spec).name(), v1::Job::SUCCEEDED);
  const json descent = client_.report(job.name()).at("descent");
  std::cout << ordered_json{{"row", "motion-dip-" + mode_},
                            {"deviation_share", descent.at("largest_deviation_share")},
                            {"deviation_mm", descent.at("largest_deviation_mm")},
                            {"uncertainty_mm", descent.at("deviation_uncertainty_mm")},
                            {"speed_mm_per_s", descent.at("speed_mm_per_s")},
                            {"samples", descent.at("samples")}}
                   .dump()
            << std::endl;
}

/// Lateness of the polls since `before`; the maximum is over all polls since the daemon started.
void Bench::take_sampling(const v1::LinkQuality& before) {
  const v1::LinkQuality now = client_.rig().link_quality();
  const auto squares = [](const v1::LinkQuality& of) {
    return of.rms_lateness_s() * of.rms_lateness_s() * static_cast<double>(of.polls());
  };
  const auto polls = static_cast<double>(now.polls() - before.polls());
  std::cout << ordered_json{{"row", "motion-sampling-" + mode_},
                            {"rms_s", std::sqrt((squares(now) - squares(before)) / polls)},
                            {"max_s", now.largest_lateness_s()},
                            {"polls", now.polls() - before.polls()},
                            {"skipped", now.skipped_polls() - before.skipped_polls()},
                            {"missed", now.missed_polls() - before.missed_polls()}}
                   .dump()
            << std::endl;
}

void Bench::run() {
  const v1::LinkQuality before = client_.rig().link_quality();
  take_latencies();
  take_dip();
  take_sampling(before);
  check_busy();
}

int bench(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (!(mode == "idle" && argc == 2) && !(mode == "busy" && argc == 3)) {
    std::cerr << "usage: bench_motion idle | busy MODEL.obj\n";
    return 2;
  }
  try {
    Bench bench(mode);
    if (mode == "busy") bench.make_busy(argv[2]);
    bench.run();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_motion: " << error.what() << '\n';
    return 4;
  }
}

}  // namespace
}  // namespace hydroprint::tests

int main(int argc, char** argv) { return hydroprint::tests::bench(argc, argv); }
