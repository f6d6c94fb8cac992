// The daemon with a real Slurm.
#include "tests/daemon/workers/slurm/cluster.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "tests/daemon/api/support.h"
#include "tests/support/campaign.h"

namespace hydroprint::tests {
namespace {

using std::chrono::milliseconds;

bool runs(const v1::Job& job) {
  return job.state() == v1::Job::RUNNING && job.phase() == "velocity";
}

bool waits_for_resources(const v1::Job& job) {
  return job.state() == v1::Job::RUNNING && job.waits_for() == "Resources";
}

std::ptrdiff_t entries_of(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return std::distance(begin(entries), end(entries));
}

class ClusterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = Cluster::missing(); !missing.empty()) GTEST_SKIP() << missing;
    cluster.emplace();
    std::filesystem::create_directory(shared());
  }
  void TearDown() override { daemon.reset(); }

  [[nodiscard]] std::filesystem::path shared() const { return folder.path() / "shared"; }
  [[nodiscard]] DaemonProcess::Options options() const {
    DaemonProcess::Options out = DaemonProcess::fake();
    out.workers = "executor = \"slurm\"\n[workers.slurm]\nfolder = \"" + shared().string() +
                  "\"\ninstallation = \"lab\"\n";
    return out;
  }
  void start(const DaemonProcess::Options& with) {
    daemon.emplace(folder.path(), with);
    client = std::make_unique<Client>(daemon->address());
  }
  void restart() {
    daemon->start();
    client = std::make_unique<Client>(daemon->address());
  }
  [[nodiscard]] v1::Job::State end_of(const std::string& job) {
    return client->wait_for_end(job).state();
  }
  [[nodiscard]] std::vector<std::string> simulate(int count, const std::string& commands) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) {
      out.push_back(client->simulate(commands + "\n# " + std::to_string(i)).name());
    }
    return out;
  }
  /// How many times a job was started.
  [[nodiscard]] std::ptrdiff_t starts(const std::string& job) const {
    const auto events = client->events(job);
    return std::count_if(events.begin(), events.end(), [](const v1::JobEvent& event) {
      return event.kind() == v1::JobEvent::STATE_CHANGED && event.state() == v1::Job::RUNNING;
    });
  }

  /// Waits longer than usual, because a lost job is noticed after a minute. A controller that was
  /// killed gives ids of jobs out again, and drains nodes that know them.
  [[nodiscard]] v1::Job end_with_an_administrator(const std::string& name) const {
    constexpr double kPatience_s = 400;
    const auto begin = testing::Clock::now();
    v1::Job job = client->job(name);
    while (!finished(job) && testing::seconds_since(begin) < kPatience_s) {
      (void)Cluster::ask({"/usr/bin/scontrol", "update", "NodeName=node1,node2", "State=RESUME"});
      (void)wait_until([&] { return finished(job = client->job(name)); }, 5, 0.1);
    }
    return job;
  }

  TemporaryFolder folder;
  std::optional<Cluster> cluster;
  std::optional<DaemonProcess> daemon;
  std::unique_ptr<Client> client;
};

class ClusterFilms : public ClusterTest {
 protected:
  /// The film images of balls that three people submit at the same time, by a daemon with an empty
  /// store.
  [[nodiscard]] std::vector<std::string> films(const DaemonProcess::Options& with, int count) {
    daemon.reset();
    std::filesystem::remove_all(folder.path() / "state");
    start(with);
    std::vector<std::unique_ptr<Client>> people;
    for (const char* person : {"ada", "ben", "cleo"}) {
      people.push_back(std::make_unique<Client>(daemon->address(), person));
    }
    std::vector<std::string> jobs, out;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      Client& person = *people[i % people.size()];
      auto request = simulate_request(person.upload(ball_obj(20 + 0.1 * static_cast<double>(i))));
      request.mutable_job()->mutable_simulate()->set_dpi(50);
      request.mutable_job()->mutable_simulate()->set_film("60x60");
      v1::Job job;
      throw_unless_ok(person.create(request, job), "CreateJob");
      jobs.push_back(job.name());
    }
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      Client& person = *people[i % people.size()];
      const v1::Job end = person.wait_for_end(jobs[i]);
      EXPECT_EQ(end.state(), v1::Job::SUCCEEDED) << end.error().message();
      out.push_back(person.download(jobs[i] + "/artifacts/film.png"));
    }
    return out;
  }
};

TEST_F(ClusterFilms, EqualThoseOfTheLocalPoolBitForBit) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  const int count = testing::campaign_rounds(3);
  auto with = options();
  with.worker = "";
  const auto remote = films(with, count);
  EXPECT_TRUE(wait_until([&] { return entries_of(shared() / "lab") == 1; }))
      << "only the lock is left, and no folder of an ended job";
  const std::string jobs =
      Cluster::ask({"/usr/bin/squeue", "--states=all", "--noheader", "--format=%j %T"});
  for (int i = 1; i <= count; ++i) {
    const std::string line = "hydroprint-lab-" + std::to_string(i) + "-1 COMPLETED";
    EXPECT_NE(jobs.find(line), std::string::npos) << jobs;
  }
  with.workers = "";
  EXPECT_TRUE(films(with, count) == remote);
}

TEST_F(ClusterTest, FolderMayLieOnAnotherFileSystem) {
  ::setenv("TMPDIR", "/dev/shm", 1);
  const TemporaryFolder elsewhere;
  ::unsetenv("TMPDIR");
  auto with = options();
  with.workers =
      "executor = \"slurm\"\n[workers.slurm]\nfolder = \"" + elsewhere.path().string() + "\"\n";
  start(with);
  const std::string job = client->simulate("").name();
  ASSERT_EQ(end_of(job), v1::Job::SUCCEEDED) << client->job(job).error().message();
  EXPECT_EQ(client->download(job + "/artifacts/film.png"), "film of m.obj");
  EXPECT_TRUE(wait_until([&] { return entries_of(daemon->state() / "runs") == 0; }));
}

// Prints how long it takes: 1 s and 2 s are the goals on an idle machine.
TEST_F(ClusterTest, CancelEndsARunningWorkerAndAWaitingJob) {
  start(options());
  const auto jobs = simulate(5, "sleep 60");  // on two nodes with two cores
  for (int i = 0; i < 4; ++i) client->wait(jobs[static_cast<std::size_t>(i)], runs);
  client->wait(jobs[4], waits_for_resources);
  const auto seconds_to_cancel = [&](const std::string& job) {
    const auto begin = testing::Clock::now();
    client->cancel(job);
    EXPECT_EQ(end_of(job), v1::Job::CANCELLED);
    return testing::seconds_since(begin);
  };
  const double waiting_s = seconds_to_cancel(jobs[4]), running_s = seconds_to_cancel(jobs[0]);
  std::cout << "cancelled after " << running_s << " s (running), " << waiting_s << " s (waiting)\n";
  constexpr double kBusyMachine_s = 20;  // the worker would sleep for 60 s
  EXPECT_LT(std::max(waiting_s, running_s), kBusyMachine_s);
}

TEST_F(ClusterTest, WorkersOutliveAKilledAndAStoppedDaemonAndNoneRunsTwice) {
  start(options());
  const auto jobs = simulate(4, "sleep 4");
  for (const std::string& job : jobs) client->wait(job, runs);
  daemon->kill();
  restart();
  EXPECT_EQ(daemon->terminate(), 0);
  restart();
  for (const std::string& job : jobs) {
    EXPECT_EQ(end_of(job), v1::Job::SUCCEEDED) << job;
    EXPECT_EQ(starts(job), 1) << job;
  }
}

TEST_F(ClusterTest, ResultOfAWorkerThatEndedWithoutADaemonIsCollected) {
  start(options());
  const std::string job = simulate(1, "sleep 1").front();
  client->wait(job, runs);
  daemon->kill();
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(shared() / "lab/1-1/exit"); }));
  restart();
  EXPECT_EQ(end_of(job), v1::Job::SUCCEEDED);
  EXPECT_EQ(starts(job), 1);
}

TEST_F(ClusterTest, JobsAreHandedOverWhenTheControllerComesBack) {
  start(options());
  cluster->does("kill", "slurmctld");
  const auto jobs = simulate(2, "sleep 0.1");
  client->wait_for(jobs[1], v1::Job::RUNNING);
  cluster->does("restart", "slurmctld");
  for (const std::string& job : jobs) EXPECT_EQ(end_of(job), v1::Job::SUCCEEDED) << job;
}

TEST_F(ClusterTest, FailuresHaveTheWordsOfTheWorker) {
  auto with = options();
  with.memory_mib = 128;
  start(with);
  const std::string refused = client->simulate("exit 3 m.obj:7: not a number").name();
  const std::string eats = client->simulate("eat").name();
  const std::string crashes = client->simulate("crash").name();
  ASSERT_EQ(end_of(refused), v1::Job::FAILED);
  EXPECT_EQ(client->job(refused).error().message(), "m.obj:7: not a number");
  ASSERT_EQ(end_of(eats), v1::Job::FAILED);
  EXPECT_EQ(client->job(eats).error().reason(), v1::MEMORY_LIMIT);
  ASSERT_EQ(end_of(crashes), v1::Job::FAILED);
  EXPECT_EQ(client->job(crashes).error().reason(), v1::WORKER_KILLED);
}

// Slurm's shortest limit is a minute.
TEST_F(ClusterTest, LimitOfSlurmIsTheTimeLimitOfTheJob) {
  auto with = options();
  with.workers += "options = \"--time=1\"\n";
  start(with);
  const std::string job = client->simulate("sleep 110").name();
  ASSERT_EQ(end_of(job), v1::Job::FAILED);
  EXPECT_EQ(client->job(job).error().reason(), v1::TIME_LIMIT)
      << client->job(job).error().message();
  EXPECT_EQ(starts(job), 1);
}

TEST_F(ClusterTest, WorkerOfANodeThatDiffersIsRefusedWithBothIds) {
  const auto worker = folder.path() / "worker";
  std::ofstream(worker) << "#!/bin/sh\nif [ -n \"$SLURM_JOB_ID\" ]; then id=bb; else id=aa; fi\n"
                           "[ \"$1\" = --version ] && echo \"{\\\"build_id\\\": \\\"$id\\\"}\"\n";
  std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
  auto with = options();
  with.worker = worker;
  start(with);
  const std::string job = client->simulate("").name();
  ASSERT_EQ(end_of(job), v1::Job::FAILED);
  const v1::Failure error = client->job(job).error();
  EXPECT_EQ(error.reason(), v1::WORKER_DIFFERS);
  EXPECT_NE(error.message().find("build bb"), std::string::npos) << error.message();
  EXPECT_NE(error.message().find("build aa"), std::string::npos) << error.message();
}

TEST_F(ClusterTest, SlurmsRefusalIsShown) {
  auto with = options();
  with.workers += "partition = \"nope\"\n";
  start(with);
  const std::string job = client->simulate("").name();
  ASSERT_EQ(end_of(job), v1::Job::FAILED);
  EXPECT_NE(client->job(job).error().message().find("Invalid partition name"), std::string::npos)
      << client->job(job).error().message();
}

TEST_F(ClusterTest, SecondDaemonOfAnInstallationIsRefusedAtStart) {
  start(options());
  const Ended second = run_daemon({"--config", daemon->config(), "--state-dir",
                                   folder.path() / "other", "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(second.status, 4) << second.words;
  EXPECT_NE(second.words.find("another hydroprintd"), std::string::npos) << second.words;
}

/// Looks again and again for workers of the cluster. Each has its job and attempt in its arguments.
class WorkerWatch {
 public:
  explicit WorkerWatch(const std::filesystem::path& installation) : prefix_(installation / "") {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      for (; !stop.stop_requested(); std::this_thread::sleep_for(milliseconds(10))) look();
    });
  }
  /// The largest number of workers that one job had at the same time, over all jobs.
  [[nodiscard]] int most_at_once() const { return most_; }

 private:
  void look() {
    std::map<std::string, std::set<std::string>> attempts;  // by job
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
      std::string command;
      std::getline(std::ifstream(entry.path() / "cmdline"), command);  // empty if it has ended
      const std::string program = command.substr(0, command.find('\0'));
      const std::size_t at = command.find("--out=" + prefix_);
      if (!program.ends_with("daemon_fake_worker") || at == std::string::npos) continue;
      const std::string run = command.substr(at + 6 + prefix_.size());
      attempts[run.substr(0, run.find('-'))].insert(entry.path().filename());
    }
    for (const auto& [job, processes] : attempts) {
      most_ = std::max(most_.load(), static_cast<int>(processes.size()));
    }
  }

  std::string prefix_;
  std::atomic<int> most_{0};
  std::jthread thread_;
};

TEST_F(ClusterTest, RandomKillsLoseNothingAndRunNothingTwice) {
  start(options());
  std::mt19937 random(testing::campaign_seed(1));
  const WorkerWatch watch(shared() / "lab");
  for (int round = 0; round < testing::campaign_rounds(5); ++round) {
    const auto jobs = simulate(4, "sleep 3\n# round " + std::to_string(round));
    std::this_thread::sleep_for(milliseconds(random() % 4000));
    const std::string victim = std::array{"daemon", "slurmctld", "node1"}[random() % 3];
    const milliseconds away(random() % 3000);
    std::cout << "round " << round << ": " << victim << ", away for " << away.count() << " ms"
              << std::endl;
    victim == "daemon" ? daemon->kill() : cluster->does("kill", victim);
    std::this_thread::sleep_for(away);
    victim == "daemon" ? restart() : cluster->does("restart", victim);
    for (const std::string& job : jobs) {
      const v1::Job end = end_with_an_administrator(job);
      EXPECT_EQ(end.state(), v1::Job::SUCCEEDED) << job << ": " << end.error().message();
    }
  }
  EXPECT_EQ(watch.most_at_once(), 1);
}

}  // namespace
}  // namespace hydroprint::tests
