// The program hydroprint-confine: its flags, its report, and how it starts a program.
#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/confine/confine_fixture.h"
#include "tests/daemon/confine/kernel_without.h"
#include "tests/support/content.h"

namespace hydroprint::testing {
namespace {

/// Flags with these folders; nullptr leaves a flag out.
Words flags_of(const char* in, const char* out, const char* memory_mib) {
  Words flags;
  if (in != nullptr) flags.insert(flags.end(), {"--inputs", in});
  if (out != nullptr) flags.insert(flags.end(), {"--work", out});
  if (memory_mib != nullptr) flags.insert(flags.end(), {"--memory-mib", memory_mib});
  return flags;
}

void expect_usage_error(Words arguments, const std::string& words, bool has_program = true) {
  if (has_program) arguments.insert(arguments.end(), {"--", "/bin/echo", "started"});
  const Ended ended = confine(arguments);
  EXPECT_EQ(ended.status, 2) << words;
  EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("--help"), std::string::npos) << ended.err;
  EXPECT_EQ(ended.out, "") << words;
}

TEST(ConfineUsage, MissingFlagsAreNamed) {
  expect_usage_error(flags_of(nullptr, "/tmp", "64"), "--inputs is required");
  expect_usage_error(flags_of("/tmp", nullptr, "64"), "--work is required");
  expect_usage_error(flags_of("/tmp", "/tmp", nullptr), "--memory-mib is required");
  expect_usage_error(flags_of("", "/tmp", "64"), "--inputs");
  expect_usage_error(flags_of("/tmp", "", "64"), "--work");
  for (const Words& end : {Words{}, Words{"--"}, Words{"--", ""}}) {
    Words flags = flags_of("/tmp", "/tmp", "64");
    flags.insert(flags.end(), end.begin(), end.end());
    expect_usage_error(flags, "-- PROGRAM is required", false);
  }
}

TEST(ConfineUsage, LimitsAreWholeNumbersFromOneOrUnlimited) {
  for (const char* wrong : {"0", "-1", "1.5", "64M", "", " 64", "99999999999999999999", "nan"}) {
    expect_usage_error(flags_of("/tmp", "/tmp", wrong), "--memory-mib");
    for (const std::string flag : {"--cpu-s", "--file-mib"}) {
      Words flags = flags_of("/tmp", "/tmp", "64");
      flags.push_back(flag + "=" + wrong);
      expect_usage_error(flags, flag);
    }
  }
}

TEST(ConfineUsage, UnknownFlagsAndProgramsWithoutMarkerAreRefused) {
  Words flags = flags_of("/tmp", "/tmp", "64");
  flags.emplace_back("--network");
  expect_usage_error(flags, "--network");
  flags.back() = "/bin/echo";
  expect_usage_error(flags, "/bin/echo", false);
  expect_usage_error({"--check"}, "--check");
  expect_usage_error({"--check", "--inputs", "/tmp"}, "--check", false);
  expect_usage_error({"--check", "--granted", "/tmp/x"}, "--check", false);
}

TEST(ConfineUsage, HelpAndVersionArePrinted) {
  const Ended help = confine({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* flag : {"--inputs", "--work", "--memory-mib", "--cpu-s", "--file-mib",
                           "--granted", "--check", kAllow}) {
    EXPECT_NE(help.out.find(flag), std::string::npos) << flag;
  }
  EXPECT_TRUE(confine({"--version"}).out.starts_with("hydroprint-confine 0."));
}

TEST_F(Confine, CheckSaysWhatTheKernelGrants) {
  const Ended ended = confine({"--check", kAllow, "--memory-mib", "100", "--cpu-s", "7"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto granted = nlohmann::json::parse(ended.out);
  EXPECT_TRUE(granted["seccomp"].get<bool>());
  EXPECT_EQ(granted["landlock_version"].get<int>() > 0, kernel_has_landlock());
  const auto& limits = granted["limits"];
  EXPECT_GE(limits["data_bytes"].get<std::int64_t>(), 100 << 20);
  EXPECT_LE(limits["data_bytes"].get<std::int64_t>(), 1 << 30);
  EXPECT_EQ(limits["cpu_s"], 7);
  EXPECT_TRUE(limits["file_bytes"].is_null());
  EXPECT_GT(limits["open_files"].get<int>(), 0);
}

// The hard limit of the caller is smaller than that of the flags.
TEST_F(Confine, CheckSaysTheSmallerLimit) {
  ProcessOptions options;
  options.limits = {{RLIMIT_CPU, 100}, {RLIMIT_FSIZE, 5 << 20}, {RLIMIT_NOFILE, 64}};
  const Ended ended = confine(
      {"--check", kAllow, "--cpu-s", "1000", "--file-mib", "3", "--memory-mib=unlimited"}, options);
  const auto limits = nlohmann::json::parse(ended.out)["limits"];
  EXPECT_EQ(limits["cpu_s"], 100);
  EXPECT_EQ(limits["file_bytes"], 3 << 20);
  EXPECT_EQ(limits["open_files"], 64);
  EXPECT_TRUE(limits["data_bytes"].is_null());
}

TEST_F(Confine, GrantedFileIsWrittenBeforeTheProgramStarts) {
  const std::string file = work + "/granted.json";
  const Ended ended = run_confined({"/bin/cat", file}, {"--granted", file, "--file-mib", "9"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto granted = nlohmann::json::parse(ended.out);
  EXPECT_TRUE(granted["seccomp"].get<bool>());
  EXPECT_EQ(granted["limits"]["file_bytes"], 9 << 20);
  const auto check = nlohmann::json::parse(
      confine({"--check", kAllow, "--memory-mib", "64", "--file-mib", "9"}).out);
  EXPECT_EQ(granted, check);
}

TEST_F(Confine, GrantedFileMayBeWhereTheProgramCannotWrite) {
  const auto file = folder.write("granted.json", std::string(5000, 'x'));
  EXPECT_EQ(run_confined({"/bin/true"}, {"--granted", file}).status, 0);
  EXPECT_TRUE(nlohmann::json::parse(content(file))["seccomp"].get<bool>());
}

void expect_not_started(const Ended& ended, const std::string& step, int reason) {
  EXPECT_EQ(ended.status, 127) << step;
  EXPECT_EQ(ended.err,
            "the worker cannot be started: " + step + ": " + strerrordesc_np(reason) + "\n");
  EXPECT_EQ(ended.out, "") << step;
}

TEST_F(Confine, ProgramThatCannotBeStartedIsNamed) {
  expect_not_started(run_confined({"/no/such/program"}), "/no/such/program", ENOENT);
  expect_not_started(run_confined({"no-such-program"}), "no-such-program", ENOENT);
  const std::string plain = folder.write("plain", "#!/bin/sh\n");
  expect_not_started(run_confined({plain}), plain, EACCES);
  expect_not_started(run_confined({inputs}), inputs, EACCES);
}

TEST_F(Confine, FoldersThatDoNotExistAreNamed) {
  const std::string missing = folder.path() / "missing", file = folder.write("file", "x");
  const auto started = [&](const std::string& in, const std::string& out) {
    return confine(
        {"--inputs", in, "--work", out, "--memory-mib", "64", kAllow, "--", "/bin/echo", "y"});
  };
  expect_not_started(started(missing, work), missing, ENOENT);
  expect_not_started(started(inputs, missing), missing, ENOENT);
  expect_not_started(started(file, work), file, ENOTDIR);
  expect_not_started(started(inputs, file), file, ENOTDIR);
  const std::string granted = missing + "/granted.json";
  expect_not_started(run_confined({"/bin/echo", "y"}, {"--granted", granted}), granted, ENOENT);
  expect_not_started(run_confined({"/bin/echo", "y"}, {"--granted", work}), work, EISDIR);
}

TEST_F(Confine, GrantedFileOnAFullDiskPreventsTheStart) {
  expect_not_started(run_confined({"/bin/echo", "y"}, {"--granted", "/dev/full"}), "/dev/full",
                     ENOSPC);
}

TEST_F(Confine, RelativePathsMeanTheWorkingDirectory) {
  (void)std::ofstream(inputs + "/model.obj").put('m');
  const Ended ended = run({"/usr/bin/env",
                           "-C",
                           folder.path(),
                           program_path("hydroprint-confine"),
                           "--inputs",
                           "in",
                           "--work",
                           "work",
                           "--memory-mib",
                           "64",
                           kAllow,
                           "--granted",
                           "granted",
                           "--",
                           program_path("daemon_confine_probe"),
                           "read",
                           "in/model.obj",
                           "write",
                           "work/film.png",
                           "write",
                           "film.png"});
  EXPECT_EQ(ended.out.substr(0, 21), "read: yes\nwrite: yes\n") << ended.err;
  EXPECT_EQ(std::filesystem::exists(folder.path() / "film.png"), !kernel_has_landlock());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "granted"));
}

TEST_F(Confine, ProgramIsFoundInPath) { EXPECT_EQ(run_confined({"echo", "found"}).out, "found\n"); }

// A program's modules are next to its file and not next to links to it.
TEST_F(Confine, FolderOfALinkedProgramIsReadable) {
  const auto own = folder.path() / "own", bin = folder.path() / "bin";
  std::filesystem::create_directory(own);
  std::filesystem::create_directory(bin);
  std::filesystem::copy_file(program_path("daemon_confine_probe"), own / "probe");
  (void)std::ofstream(own / "module.so").put('m');
  std::filesystem::create_symlink("../own/probe", bin / "probe");
  EXPECT_EQ(run_confined({bin / "probe", "read", own / "module.so"}).out, "read: yes\n");
}

TEST_F(Confine, InheritsOnlyTheFirstFourDescriptors) {
  const int null = ::open("/dev/null", O_RDWR);
  ProcessOptions options;
  options.inherited = {{0, null}, {3, null}, {4, null}, {9, null}, {200, null}};
  const Words actions{program_path("daemon_confine_probe"), "open", "x"};
  EXPECT_EQ(run_confined(actions, {}, options).out, "open: 0 1 2 3\n");
  EXPECT_EQ(run_confined(actions, {"--granted", work + "/granted"}, options).out,
            "open: 0 1 2 3\n");
  ::close(null);
}

TEST_F(Confine, StdinReachesTheProgram) {
  const auto file = folder.write("requests", "a request\n");
  const int requests = ::open(file.c_str(), O_RDONLY);
  ProcessOptions options;
  options.inherited = {{0, requests}};
  EXPECT_EQ(run_confined({program_path("daemon_confine_probe"), "echo", "0"}, {}, options).out,
            "a request\n");
  ::close(requests);
}

TEST_F(Confine, ArgumentsReachTheProgramUnchanged) {
  EXPECT_EQ(probe({"arguments", "--", "", "[a,b]", "--work", "--memory-mib=0", "a b", "%x"}),
            "--\n\n[a,b]\n--work\n--memory-mib=0\na b\n%x\n");
}

TEST_F(Confine, PassesOnTheEnvironmentWithoutPlacesOfThreads) {
  const Ended ended =
      run({"/usr/bin/env", "OMP_PROC_BIND=true", "OMP_PLACES=cores", "GOMP_CPU_AFFINITY=0",
           "OMP_NUM_THREADS=7", program_path("hydroprint-confine"), "--inputs", inputs, "--work",
           work, "--memory-mib", "64", kAllow, "--", "/usr/bin/env"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("OMP_NUM_THREADS=7"), std::string::npos);
  for (const char* name : {"OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY"}) {
    EXPECT_EQ(ended.out.find(name), std::string::npos) << ended.out;
  }
}

TEST_F(Confine, EndsAsItsProgramDoes) {
  EXPECT_EQ(run_confined({"/bin/sh", "-c", "echo words >&2; exit 42"}).status, 42);
  EXPECT_EQ(run_confined({"/bin/sh", "-c", "echo words >&2; exit 42"}).err, "words\n");
}

TEST_F(Confine, KernelWithoutSeccompIsRefused) {
  const std::string step =
      "cannot install the system call filter; use a kernel and a container that allow it";
  const KernelWithout missing({SYS_seccomp}, EPERM, /*also_prctl=*/true);
  expect_not_started(missing.call([&] {
    return run_confined({"/bin/echo", "started"});
  }),
                     step, EPERM);
  const Ended check = missing.call([] { return confine({"--check", kAllow}); });
  EXPECT_EQ(check.status, 4);
  EXPECT_FALSE(nlohmann::json::parse(check.out)["seccomp"].get<bool>());
  EXPECT_TRUE(check.err.starts_with("this machine cannot confine workers (" + step + ": "))
      << check.err;
}

// ENOSYS: not built in. EOPNOTSUPP: not among lsm= at boot. EPERM: refused by a container.
TEST_F(Confine, KernelWithoutLandlockIsRefusedWithTheRemedy) {
  for (const int error : {ENOSYS, EOPNOTSUPP, EPERM}) {
    const KernelWithout missing({SYS_landlock_create_ruleset}, error);
    expect_not_started(missing.call([&] {
      return confine(
          {"--inputs", inputs, "--work", work, "--memory-mib", "64", "--", "/bin/echo", "started"});
    }),
                       "this kernel or container has no Landlock; use one that has it, or set "
                       "workers.allow_without_landlock (flag --allow-without-landlock)",
                       error);
    const Ended check = missing.call([] { return confine({"--check"}); });
    EXPECT_EQ(check.status, 4);
    EXPECT_NE(check.err.find("workers.allow_without_landlock"), std::string::npos) << check.err;
  }
}

TEST_F(Confine, KernelWithoutLandlockIsUsedIfAllowed) {
  const KernelWithout missing({SYS_landlock_create_ruleset}, ENOSYS);
  const std::string file = work + "/granted";
  const Ended ended = missing.call([&] {
    return run_confined({program_path("daemon_confine_probe"), "socket", "x"},
                        {"--granted", file, kAllow});
  });
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out.find("yes"), std::string::npos);
  const auto granted = nlohmann::json::parse(content(file));
  EXPECT_TRUE(granted["seccomp"].get<bool>());
  EXPECT_EQ(granted["landlock_version"], 0);
  const Ended check = missing.call([] { return confine({"--check", kAllow}); });
  EXPECT_EQ(check.status, 0);
  EXPECT_EQ(nlohmann::json::parse(check.out)["landlock_version"], 0);
  EXPECT_NE(check.err.find("read, write and delete every file"), std::string::npos) << check.err;
}

TEST_F(Confine, CheckOfAKernelWithLandlockHasNoWarning) {
  if (!kernel_has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  for (const Words& flags : {Words{"--check"}, Words{"--check", kAllow}}) {
    const Ended check = confine(flags);
    EXPECT_EQ(check.status, 0);
    EXPECT_EQ(check.err, "");
  }
}

TEST_F(Confine, LandlockThatFailsIsRefused) {
  if (!kernel_has_landlock()) GTEST_SKIP() << "this kernel has no Landlock";
  const KernelWithout missing({SYS_landlock_restrict_self}, E2BIG);
  expect_not_started(missing.call([&] {
    return run_confined({"/bin/echo", "started"});
  }),
                     "cannot restrict file access", E2BIG);
}

}  // namespace
}  // namespace hydroprint::testing
