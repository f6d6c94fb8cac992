// `hydroprint admin` on the daemon's machine, with and without a running daemon.
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <set>
#include <thread>

#include "daemon/admin/archive.h"
#include "daemon/admin/backup.h"
#include "daemon/store/database/database.h"
#include "sim/base/sha256.h"
#include "tests/client/people_cli.h"

namespace hydroprint::tests {
namespace {

constexpr char kNewPassword[] = "battery staple";

using Tree = std::map<std::string, std::string>;

// The contents of all files in a folder, by relative path.
Tree tree_of(const std::filesystem::path& folder) {
  Tree tree;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    tree[std::filesystem::relative(entry.path(), folder)] = content(entry.path());
  }
  return tree;
}

class AdminCli : public PeopleCli {
 protected:
  AdminCli() {
    add("ann", "ADMIN");
    log_in("ann");
  }
  Outcome admin(Arguments arguments, const std::filesystem::path& state) const {
    arguments.insert(arguments.begin(), "admin");
    arguments.insert(arguments.begin() + 2, {"--state-dir", state.string()});
    return client(arguments);
  }
  Outcome admin(const Arguments& arguments) const { return admin(arguments, daemon_.state()); }
  std::filesystem::path backup(const std::string& name = "backup.tar") const {
    const auto file = folder_.path() / name;
    const Outcome ended = admin({"backup", file});
    EXPECT_EQ(ended.status, 0) << ended.err;
    return file;
  }
  std::string simulate(const std::string& mesh) const {
    const std::string file = folder_.write("m.obj", mesh).string();
    return client_json({"submit", "simulate", "--mesh", file, "--wait"}).at("name");
  }
  // A folder to use instead of the daemon's state folder.
  [[nodiscard]] std::filesystem::path elsewhere() const { return other_.path() / "state"; }
  Outcome reset(const std::string& lines, const Arguments& more = {}) const {
    Arguments arguments{"admin", "reset-password", "--state-dir", daemon_.state().string(), "ann"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return told(lines, arguments);
  }

  TemporaryFolder other_;
};

TEST_F(AdminCli, ABackupOfARunningDaemonIsCompleteAndRestoresIt) {
  const std::string name = simulate("mesh");
  ASSERT_EQ(client({"pin", name}).status, 0);
  const auto out = folder_.path() / "got", film = out / "film.png";
  ASSERT_EQ(client({"download", name, "film.png", "--out", out.string()}).status, 0);
  const auto file = backup();
  struct stat info {};
  ASSERT_EQ(::stat(file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600U);  // the backup contains all users' data
  simulate("later");                      // the daemon still accepts jobs
  const Outcome restored = admin({"restore", file}, elsewhere());
  ASSERT_EQ(restored.status, 0) << restored.err;
  EXPECT_NE(restored.out.find("restored 1 jobs and "), std::string::npos) << restored.out;

  DaemonProcess second(other_.path(), options());
  Client reader(second.address());
  v1::SignInRequest request;
  request.set_user("ann");
  request.set_password(kPassword);
  v1::SignInResponse session;
  ASSERT_TRUE(reader.people->SignIn(reader.context().get(), request, &session).ok());
  reader.session = session.session_token();
  const v1::Job job = reader.job(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_TRUE(job.pinned());
  EXPECT_EQ(reader.download(name + "/artifacts/film.png"), content(film));
  v1::GetJobRequest later;
  later.set_name("jobs/2");
  v1::Job none;
  EXPECT_FALSE(reader.jobs->GetJob(reader.context().get(), later, &none).ok());
  v1::ListSessionsResponse sessions;
  ASSERT_TRUE(reader.people->ListSessions(reader.context().get(), {}, &sessions).ok());
  // The only session is the new one: sessions of the backup are not restored.
  EXPECT_EQ(sessions.sessions_size(), 1);
  EXPECT_EQ(reader.upload("mesh"), job.simulate().mesh().asset());
}

TEST_F(AdminCli, BackupsDuringJobChangesAreConsistent) {
  std::atomic<bool> is_over{false};
  std::thread busy([&] {
    for (int i = 0; !is_over; ++i) {
      const std::string name = simulate("mesh " + std::to_string(i));
      if (i % 2 == 0) (void)client({"delete", name});
    }
  });
  for (int i = 0; i < 6; ++i) {
    const std::string number = std::to_string(i);
    const auto file = backup("backup-" + number + ".tar");
    const Outcome restored = admin({"restore", file}, other_.path() / number);
    EXPECT_EQ(restored.status, 0) << restored.err;
  }
  is_over = true;
  busy.join();
}

TEST_F(AdminCli, ARunningJobIsBackedUpAndRestartedAfterARestore) {
  const std::string mesh = folder_.write("m.obj", "sleep 1000").string();
  const std::string name = client_json({"submit", "simulate", "--mesh", mesh}).at("name");
  Client watcher(daemon_.address());
  watcher.key = client_json({"keys", "add"}).at("key");
  watcher.wait_for(name, v1::Job::RUNNING);
  const auto file = backup();
  ASSERT_EQ(admin({"restore", file}, elsewhere()).status, 0);
  DaemonProcess second(other_.path(), options());
  Client reader(second.address());
  reader.key = watcher.key;
  reader.wait_for(name, v1::Job::RUNNING);
}

TEST_F(AdminCli, MissingFilesAreReportedAndOmitted) {
  const std::string name = simulate("mesh"), other = simulate("other");
  std::filesystem::remove(daemon_.state() / "artifacts" / "1" / "film.png");
  const auto file = folder_.path() / "backup.tar";
  const Outcome ended = admin({"backup", file});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("warning: artifacts/1/film.png is missing or damaged"),
            std::string::npos)
      << ended.err;
  EXPECT_EQ(admin({"restore", file}, elsewhere()).status, 0);
  EXPECT_TRUE(std::filesystem::exists(elsewhere() / "artifacts" / "2" / "film.png"));
}

TEST_F(AdminCli, ABackupNeverReplacesAFileAndLeavesNothingWhenItFails) {
  const auto file = folder_.write("precious.tar", "precious");
  const Outcome refused = admin({"backup", file});
  EXPECT_EQ(refused.status, 3) << refused.err;
  EXPECT_EQ(content(file), "precious");
  EXPECT_NE(admin({"backup", "/nowhere/backup.tar"}).status, 0);
  // other_ contains no store.
  EXPECT_EQ(admin({"backup", folder_.path() / "x.tar"}, other_.path()).status, 3);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "x.tar"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "x.tar.part"));
  EXPECT_TRUE(std::filesystem::is_empty(other_.path()));
}

/// A file system of the given size in KiB, mounted during the life of this object.
class SmallDisk {
 public:
  SmallDisk(std::filesystem::path path, int kib) : path_(std::move(path)) {
    std::filesystem::create_directories(path_);
    const std::string size = "size=" + std::to_string(kib) + "k";
    is_there = ::mount("none", path_.c_str(), "tmpfs", 0, size.c_str()) == 0;
  }
  ~SmallDisk() {
    if (is_there) ::umount2(path_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool is_there = false;

 private:
  std::filesystem::path path_;
};

// Tries many sizes, so that the space runs out at different moments.
TEST_F(AdminCli, OnAFullDiskBackupAndRestoreAreCompleteOrAbsent) {
  const auto small = other_.path() / "small";
  if (!SmallDisk(small, 100).is_there) GTEST_SKIP() << "needs root, to mount a small disk";
  simulate(std::string(1 << 20, '#'));
  const auto good = backup();
  int backups = 0, restores = 0, refused = 0;
  for (int kib = 512; kib <= 4096; kib += 128) {
    {
      const SmallDisk disk(small, kib);
      const bool is_done = admin({"backup", small / "b.tar"}).status == 0;
      EXPECT_EQ(tree_of(small).size(), is_done ? 1U : 0U) << kib;
      ++(is_done ? backups : refused);
    }
    const SmallDisk disk(small, kib);
    const Outcome ended = admin({"restore", good}, small / "state");
    const Tree left = tree_of(small / "state");
    EXPECT_EQ(left.contains("hydroprint.db"), ended.status == 0) << ended.err;
    // A failed restore leaves only the lock file.
    EXPECT_EQ(left.size() > 1, ended.status == 0) << ended.err;
    ++(ended.status == 0 ? restores : refused);
  }
  EXPECT_GT(backups, 0);
  EXPECT_GT(restores, 0);
  EXPECT_GT(refused, 4);
}

TEST_F(AdminCli, ARestoreRefusesAFolderThatIsInUseOrNotEmpty) {
  const std::string name = simulate("mesh");
  const auto file = backup();
  const Outcome in_use = admin({"restore", file, "--replace"});
  EXPECT_EQ(in_use.status, 3);
  EXPECT_NE(in_use.err.find("uses this state folder"), std::string::npos) << in_use.err;
  EXPECT_EQ(client({"show", name}).status, 0);  // the daemon is not affected

  std::filesystem::create_directories(elsewhere());
  std::ofstream(elsewhere() / "thesis.txt") << "mine";
  const Outcome full = admin({"restore", file}, elsewhere());
  EXPECT_EQ(full.status, 3);
  EXPECT_NE(full.err.find("--replace"), std::string::npos) << full.err;
  EXPECT_EQ(content(elsewhere() / "thesis.txt"), "mine");

  daemon_.kill();
  ASSERT_EQ(admin({"restore", file, "--replace"}).status, 0);
  daemon_.start();
  log_in("ann");
  EXPECT_EQ(client({"show", name}).status, 0);
}

TEST_F(AdminCli, ADamagedBackupIsRefusedWithoutChanges) {
  simulate("mesh");
  const std::string good = content(backup());
  daemon_.terminate();
  const Tree before = tree_of(daemon_.state());
  const auto bad = folder_.path() / "bad.tar";
  const auto expect_refused = [&](const std::string& bytes, const std::string& what) {
    std::ofstream(bad, std::ios::binary) << bytes;
    const Outcome refused = admin({"restore", bad, "--replace"});
    EXPECT_EQ(refused.status, 3) << what << ": " << refused.err;
    Tree after = tree_of(daemon_.state());
    after["lock"] = before.at("lock");
    EXPECT_EQ(after, before) << what;
  };
  for (const std::size_t tenth : {0, 1, 3, 5, 7, 9}) {
    expect_refused(good.substr(0, good.size() * tenth / 10), "cut off");
  }
  expect_refused("no archive", "no archive");
  std::string flipped = good;
  const std::size_t film = good.find("artifacts/1/film.png");
  ASSERT_NE(film, std::string::npos);
  flipped[film + 512] = static_cast<char>(flipped[film + 512] ^ 1);
  expect_refused(flipped, "a byte of a file");
  std::string in_database = good;
  const std::size_t schema = good.find("CREATE TABLE jobs");
  ASSERT_NE(schema, std::string::npos);
  in_database[schema] = 'X';
  expect_refused(in_database, "a byte of the database");
}

TEST_F(AdminCli, AnArchiveWithPathsOutsideTheFolderIsRefused) {
  const std::vector<std::string> names{"../evil",          "/tmp/hydroprint-evil",
                                       "assets/../evil",   "artifacts/1/../x",
                                       "artifacts/0/x",    "artifacts/1/",
                                       "assets/aa/bb",     "lock",
                                       "unrestored",       "dips/1/x",
                                       "hydroprint.db-wal"};
  int number = 0;
  for (const std::string& name : names) {
    const auto file = folder_.path() / ("evil" + std::to_string(number++) + ".tar");
    {
      const auto out = admin::ArchiveWriter::create(file).value();
      ASSERT_TRUE(out->add(name, "evil"));
      ASSERT_TRUE(out->finish());
    }
    const Outcome refused = admin({"restore", file}, elsewhere());
    EXPECT_EQ(refused.status, 3) << name;
    EXPECT_NE(refused.err.find("which is not part of a backup"), std::string::npos) << refused.err;
    EXPECT_EQ(tree_of(other_.path()).size(), 1U) << name;  // only the lock file
  }
  EXPECT_FALSE(std::filesystem::exists("/tmp/hydroprint-evil"));
  const auto folder = folder_.path() / "links";
  std::filesystem::create_directories(folder);
  std::filesystem::create_symlink("/etc/passwd", folder / "hydroprint.db");
  const auto file = (folder_.path() / "link.tar").string();
  ASSERT_EQ(
      hydroprint::testing::run({"/bin/tar", "-C", folder, "-cf", file, "hydroprint.db"}).status, 0);
  EXPECT_EQ(admin({"restore", file}, elsewhere()).status, 3);
}

TEST_F(AdminCli, ACheckNeedsNoLockAndIsOkWhereTheDaemonRuns) {
  const Outcome ended = admin({"check", "--config", daemon_.config()});
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_EQ(ended.out.find("FAULT"), std::string::npos) << ended.out;
  for (const char* what : {"configuration", "worker", "confinement", "state folder"}) {
    EXPECT_NE(ended.out.find(std::string("ok    ") + what + ": "), std::string::npos) << ended.out;
  }
}

TEST_F(AdminCli, ACheckNamesEachFaultWithItsRemedy) {
  const auto file = folder_.path() / "check.toml";
  const auto expect_fault = [&](const std::string& lines, const std::string& fault) {
    std::ofstream(file) << lines;
    const Outcome ended =
        client({"admin", "check", "--config", file, "--state-dir", elsewhere()}, {"PATH=/nowhere"});
    EXPECT_EQ(ended.status, 4) << lines;
    EXPECT_NE(ended.out.find("FAULT " + fault), std::string::npos) << ended.out;
  };
  expect_fault("[workers]\ncount = -1\n", "configuration: " + file.string() + ":2: ");
  expect_fault("[workers]\nprogram = \"/no/worker\"\n", "worker: /no/worker: ");
  expect_fault("", "state folder: " + elsewhere().string() + ": does not exist");
  const std::string slurm =
      "[workers]\nexecutor = \"slurm\"\n[workers.slurm]\nfolder = \"/no/folder\"\n";
  expect_fault(slurm, "shared folder: /no/folder: ");
  expect_fault(slurm,
               "Slurm programs: sbatch, squeue, scancel, sinfo: not in PATH; install the Debian "
               "package slurm-client");
  EXPECT_FALSE(std::filesystem::exists(elsewhere()));
}

TEST_F(AdminCli, ACheckNamesDamagedFilesBesideTheDaemon) {
  simulate("mesh");
  simulate("other");
  const auto artifacts = daemon_.state() / "artifacts";
  const auto check = [&] { return admin({"check", "--config", daemon_.config()}); };
  const std::string sound = check().out;
  EXPECT_NE(sound.find("ok    database: "), std::string::npos) << sound;
  EXPECT_NE(sound.find("ok    files: "), std::string::npos) << sound;
  std::string film = content(artifacts / "1" / "film.png");
  film.back() = static_cast<char>(film.back() ^ 1);
  std::ofstream(artifacts / "1" / "film.png", std::ios::binary) << film;
  std::filesystem::remove(artifacts / "2" / "film.png");
  ASSERT_EQ(::chmod(daemon_.state().c_str(), 0755), 0);
  const Outcome ended = check();
  EXPECT_EQ(ended.status, 4) << ended.out;
  for (const std::string& line :
       {"FAULT state folder: " + daemon_.state().string() + ": other users of this machine",
        std::string("FAULT file: artifacts/1/film.png: its content has changed; retry the job"),
        std::string("FAULT file: artifacts/2/film.png: missing; retry the job")}) {
    EXPECT_NE(ended.out.find(line), std::string::npos) << line << "\n" << ended.out;
  }
}

TEST_F(AdminCli, ADaemonCorrectsTheModeOfItsFolderWithAWarning) {
  daemon_.terminate();
  ASSERT_EQ(::chmod(daemon_.state().c_str(), 0755), 0);
  daemon_.start();
  struct stat info {};
  ASSERT_EQ(::stat(daemon_.state().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700U);
  EXPECT_NE(daemon_.log().find("event=mode_corrected path=" + daemon_.state().string() +
                               " before=0755 now=0700"),
            std::string::npos)
      << daemon_.log();
}

TEST_F(AdminCli, ADamagedDatabaseIsRefusedUntilItIsSetAside) {
  simulate("mesh");
  const auto database = daemon_.state() / "hydroprint.db";
  const Outcome running = admin({"set-aside"});
  EXPECT_EQ(running.status, 3);
  EXPECT_NE(running.err.find("uses this state folder"), std::string::npos) << running.err;
  daemon_.terminate();
  EXPECT_NE(admin({"set-aside"}).err.find("not damaged"), std::string::npos);
  std::string bytes = content(database);
  constexpr std::size_t kPage = 4096;  // the third page is the root of a table
  bytes.replace(2 * kPage, kPage, std::string(kPage, 'x'));
  std::ofstream(database, std::ios::binary) << bytes;

  const Ended refused = run_daemon({"--state-dir", daemon_.state(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(refused.status, 4);
  for (const std::string& part :
       {database.string() + ": the job database is damaged", std::string("admin set-aside")}) {
    EXPECT_NE(refused.words.find(part), std::string::npos) << refused.words;
  }
  const Outcome checked = admin({"check", "--config", daemon_.config()});
  EXPECT_EQ(checked.status, 4);
  EXPECT_NE(checked.out.find("FAULT database: "), std::string::npos) << checked.out;
  EXPECT_EQ(content(database), bytes);

  const Outcome aside = admin({"set-aside"});
  EXPECT_EQ(aside.status, 0) << aside.err;
  EXPECT_NE(aside.out.find((daemon_.state() / "set-aside").string()), std::string::npos)
      << aside.out;
  EXPECT_FALSE(std::filesystem::exists(database));
  daemon_.start();
  EXPECT_NE(daemon_.log().find("files_set_aside"), std::string::npos) << "those of the old jobs";
}

TEST(Archive, NamesAndContentsAreRestored) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.tar";
  const std::map<std::string, std::string> entries{
      {"artifacts/1/film.png", ""},
      {"artifacts/1/M\xc3\xbcnze \xe2\x82\xac.png", "utf-8"},
      {"artifacts/1/\xff\xfe.png", "no utf-8"},
      {"artifacts/1/" + std::string(255, 'x'), std::string(3 << 20, 'y')}};
  {
    const auto out = admin::ArchiveWriter::create(file).value();
    for (const auto& [name, bytes] : entries) {
      const auto done = out->add(name, bytes);
      ASSERT_TRUE(done) << done.error().message;
    }
    EXPECT_FALSE(std::filesystem::exists(file));  // the file appears only when it is complete
    ASSERT_TRUE(out->finish());
  }
  std::map<std::string, std::string> read;
  const auto in = admin::ArchiveReader::open(file).value();
  for (auto entry = in->next(); entry && *entry; entry = in->next()) {
    EXPECT_TRUE((*entry)->is_file);
    std::string& bytes = read[(*entry)->name];
    ASSERT_TRUE(in->read([&](std::string_view piece) -> Status {
      bytes += piece;
      return {};
    }));
  }
  EXPECT_EQ(read, entries);
}

TEST_F(AdminCli, NoDaemonStartsAfterAnInterruptedRestoreUntilItIsRepeated) {
  simulate("mesh");
  const auto file = backup();
  daemon_.terminate();
  std::ofstream(daemon_.state() / "unrestored") << "";  // as after a power failure at the last step
  std::filesystem::remove(daemon_.state() / "hydroprint.db");
  const Ended refused = run_daemon({"--state-dir", daemon_.state(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(refused.status, 4) << refused.words;
  EXPECT_NE(refused.words.find("hydroprint admin restore again"), std::string::npos)
      << refused.words;
  EXPECT_FALSE(std::filesystem::exists(daemon_.state() / "hydroprint.db"));
  // a repeated restore may replace what the interrupted one left
  ASSERT_EQ(admin({"restore", file}).status, 0);
  daemon_.start();
  log_in("ann");
  EXPECT_EQ(client({"show", "1"}).status, 0);
}

TEST_F(AdminCli, ANewPasswordEndsSessionsAtOnceEvenWhileTheDaemonRuns) {
  Client reader(daemon_.address());
  v1::SignInRequest request;
  request.set_user("ann");
  request.set_password(kPassword);
  v1::SignInResponse session;
  ASSERT_TRUE(reader.people->SignIn(reader.context().get(), request, &session).ok());
  reader.session = session.session_token();
  v1::WhoAmIResponse me;
  ASSERT_TRUE(reader.people->WhoAmI(reader.context().get(), {}, &me).ok());
  const Outcome done = reset(std::string(kNewPassword) + "\n", {"--stdin"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_FALSE(reader.people->WhoAmI(reader.context().get(), {}, &me).ok());
  reader.session.clear();
  EXPECT_FALSE(reader.people->SignIn(reader.context().get(), request, &session).ok());
  request.set_password(kNewPassword);
  EXPECT_TRUE(reader.people->SignIn(reader.context().get(), request, &session).ok());
  const json entries = client_json({"audit", "--what", "hydroprint admin"}).at("entries");
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].at("object"), "users/ann");
  EXPECT_EQ(entries[0].at("via"), "command line");
  daemon_.kill();
  EXPECT_EQ(reset(std::string(kPassword) + "\n").status, 0);  // also works without a running daemon
  daemon_.start();
  log_in("ann");
}

TEST_F(AdminCli, APasswordIsAskedForTwiceOnATerminalWithoutEcho) {
  Terminal terminal(
      command({"admin", "reset-password", "--state-dir", daemon_.state().string(), "ann"}));
  ASSERT_TRUE(terminal.shows("New password: "));
  terminal.type(std::string(kNewPassword) + "\n");
  ASSERT_TRUE(terminal.shows("Repeat password: "));
  terminal.type(std::string(kNewPassword) + "\n");
  EXPECT_TRUE(terminal.shows("ann has a new password"));
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_EQ(terminal.screen().find(kNewPassword), std::string::npos);
  EXPECT_TRUE(terminal.is_cooked());
}

TEST_F(AdminCli, WrongPasswordsAndUsersAreRefused) {
  EXPECT_EQ(reset("short\n").status, 3);
  EXPECT_EQ(reset("\n").status, 3);
  EXPECT_EQ(reset(std::string(1001, 'x') + "\n").status, 3);
  EXPECT_EQ(admin({"sign-in-link", "nobody"}).status, 3);
  EXPECT_EQ(client({"admin", "sign-in-link", "ann", "--state-dir", "/nowhere"}).status, 3);
  log_in("ann");  // the password is unchanged
}

TEST_F(AdminCli, ALinkSignsInOnce) {
  const Outcome made = admin({"sign-in-link", "ann"});
  ASSERT_EQ(made.status, 0) << made.err;
  const std::size_t at = made.out.find("/sign-in#");
  ASSERT_NE(at, std::string::npos) << made.out;
  Client reader(daemon_.address());
  v1::SignInRequest request;
  request.set_link_token(made.out.substr(at + 9, 64));
  v1::SignInResponse session;
  EXPECT_TRUE(reader.people->SignIn(reader.context().get(), request, &session).ok());
  EXPECT_FALSE(reader.people->SignIn(reader.context().get(), request, &session).ok());
}

TEST_F(AdminCli, AnotherUsersFolderIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to change the owner of a folder";
  daemon_.terminate();
  ASSERT_EQ(::chown(daemon_.state().c_str(), 65534, 65534), 0);
  for (const Arguments& arguments :
       {Arguments{"backup", folder_.path() / "x.tar"}, Arguments{"sign-in-link", "ann"},
        Arguments{"restore", folder_.path() / "x.tar", "--replace"}}) {
    const Outcome refused = admin(arguments);
    EXPECT_EQ(refused.status, 3) << arguments.front();
    EXPECT_NE(refused.err.find("sudo -u nobody"), std::string::npos) << refused.err;
  }
  const Ended refused = run_daemon({"--state-dir", daemon_.state(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.words.find(daemon_.state().string() + ": belongs to nobody"), std::string::npos)
      << refused.words;
}

// A store of a former build, with changes in its log.
std::unique_ptr<hydroprint::daemon::Database> other_store(const std::filesystem::path& path) {
  auto database =
      hydroprint::daemon::Database::open(path, "CREATE TABLE settings(name, value);").value();
  EXPECT_TRUE(database->run("INSERT INTO settings VALUES ('schema', '1')"));
  return database;
}

TEST_F(AdminCli, AStateFolderOfAnotherBuildIsRefusedAndUnchanged) {
  std::filesystem::create_directories(elsewhere());
  std::ofstream(elsewhere() / "lock") << "1234";
  const auto other = other_store(elsewhere() / "hydroprint.db");
  const Tree before = tree_of(elsewhere());
  const auto time = std::filesystem::last_write_time(elsewhere());
  const auto expect_refused = [&](const std::string& words) {
    for (const char* const part :
         {"hydroprint.db: was made by another build of hydroprint", "set the state folder aside"}) {
      EXPECT_NE(words.find(part), std::string::npos) << words;
    }
    EXPECT_EQ(tree_of(elsewhere()), before);
    EXPECT_EQ(std::filesystem::last_write_time(elsewhere()), time);
  };
  const Ended started = run_daemon({"--state-dir", elsewhere(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(started.status, 4);
  expect_refused(started.words);
  for (const Arguments& arguments :
       {Arguments{"sign-in-link", "ann"}, Arguments{"backup", folder_.path() / "x.tar"}}) {
    const Outcome refused = admin(arguments, elsewhere());
    EXPECT_EQ(refused.status, 3) << arguments.front();
    expect_refused(refused.err);
  }
  const Outcome checked = admin({"check", "--config", daemon_.config()}, elsewhere());
  EXPECT_EQ(checked.status, 4) << checked.err;
  expect_refused(checked.out);
}

TEST_F(AdminCli, ABackupOfAnotherBuildIsRefusedWithoutChanges) {
  daemon_.terminate();
  const auto path = folder_.path() / "other.db", file = folder_.path() / "other.tar";
  other_store(path);  // closed, so that its log is empty
  const std::string database = content(path);
  const auto out = admin::ArchiveWriter::create(file).value();
  ASSERT_TRUE(out->add(admin::kDatabaseName, database));
  const json manifest{{"format", admin::kBackupFormat}, {"database_sha256", sha256(database)}};
  ASSERT_TRUE(out->add(admin::kManifestName, manifest.dump()));
  ASSERT_TRUE(out->finish());
  const Tree before = tree_of(daemon_.state());
  const Outcome refused = admin({"restore", file, "--replace"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find(file.string() + ": was made by another build of hydroprint"),
            std::string::npos)
      << refused.err;
  Tree after = tree_of(daemon_.state());
  after["lock"] = before.at("lock");
  EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace hydroprint::tests
