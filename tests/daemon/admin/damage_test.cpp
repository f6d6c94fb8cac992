// Damaged databases and files: noticed at the start, when they are used, or by a check.
#include <algorithm>
#include <random>

#include "daemon/admin/damaged_database.h"
#include "daemon/admin/store_check.h"
#include "daemon/store/artifact_files.h"
#include "tests/daemon/store/store_fixture.h"
#include "tests/support/content.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;
using hydroprint::testing::content;

constexpr std::size_t kPage = 4096;
constexpr int kDraws = 25;

using Random = std::mt19937;

std::size_t draw(Random& random, std::size_t below) {
  return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
}

std::string noise(Random& random, std::size_t size) {
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(draw(random, 256));
  return bytes;
}

void replace(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

void flip_a_bit(Random& random, const fs::path& path) {
  std::string bytes = content(path);
  char& byte = bytes[draw(random, bytes.size())];
  byte = static_cast<char>(byte ^ (1 << draw(random, 8)));
  fs::permissions(path, fs::perms::owner_all);
  replace(path, bytes);
}

// Reads a big-endian number of a database file.
std::size_t number_at(const std::string& bytes, std::size_t offset) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < 4; ++i)
    out = out << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return out;
}

// Returns the pages of the list of free pages, from https://www.sqlite.org/fileformat.html.
std::set<std::size_t> free_pages(const std::string& database) {
  std::set<std::size_t> free;
  for (std::size_t page = number_at(database, 32); page != 0;) {
    free.insert(page);
    const std::size_t at = (page - 1) * kPage, count = number_at(database, at + 4);
    for (std::size_t i = 0; i < count; ++i) free.insert(number_at(database, at + 8 + 4 * i));
    page = number_at(database, at);
  }
  return free;
}

class Damage : public StoreTest {
 protected:
  /// Runs a job whose result is one file.
  Job compute(const std::string& digest, const std::string& bytes) {
    const Job job = add(digest);
    EXPECT_TRUE(jobs->start(job.id));
    fs::create_directories(layout.artifacts(job.id));
    replace(layout.artifacts(job.id) / "film.png", bytes);
    return jobs
        ->succeed(job.id, {{"film.png", static_cast<std::int64_t>(bytes.size()), sha256(bytes),
                            "image/png"}})
        .value();
  }
  Result<AssetOrUpload> ask(const std::string& bytes) {
    return uploads->start({"", sha256(bytes), static_cast<std::int64_t>(bytes.size()), 0, "x/y", 0},
                          {"ann"}, {});
  }
  void upload(const std::string& bytes) {
    const auto writer =
        UploadWriter::open(*uploads, std::get<Upload>(ask(bytes).value()).id, "ann").value();
    ASSERT_TRUE(writer->append(0, bytes));
    ASSERT_TRUE(writer->finish());
  }
  [[nodiscard]] Status lay_out(const std::string& sha256) {
    return lay_out_inputs(layout, {{"m.obj", sha256}}, layout.runs() / "1-1" / "in");
  }
  [[nodiscard]] std::vector<CheckLine> check() const {
    std::vector<CheckLine> lines;
    admin::check_store(
        layout, [&](const CheckLine& line) { lines.push_back(line); }, [] { return false; });
    return lines;
  }
  /// Lines of faults that contain a text.
  [[nodiscard]] static std::size_t faults(const std::vector<CheckLine>& lines,
                                          const std::string& text = "") {
    return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](auto& line) {
      return line.verdict == CheckLine::Verdict::kFault &&
             line.detail.find(text) != std::string::npos;
    }));
  }
  /// Closes the store and overwrites one of its pages.
  void overwrite(const std::string& good, std::size_t page, Random& random) {
    close();
    for (const char* const tail : {"-wal", "-shm"}) discard(layout.database().string() + tail);
    replace(layout.database(),
            std::string(good).replace((page - 1) * kPage, kPage, noise(random, kPage)));
  }

  Damage() {
    upload_options.max_bytes = 1 << 20;
    job_options.max_queued = 1000;
    open();
  }
};

TEST_F(Damage, EachOverwrittenPageIsNoticedAtTheStart) {
  Random random(1);
  for (int i = 0; i < 50; ++i) compute(std::to_string(i), "film");
  ASSERT_TRUE(database->run("UPDATE jobs SET body=zeroblob(10000) WHERE id%10=0"));
  open();  // reserves free pages
  close();
  const std::string good = content(layout.database());
  const std::set<std::size_t> free = free_pages(good);
  ASSERT_FALSE(free.empty());
  for (int i = 0; i < kDraws;) {
    const std::size_t page = 1 + draw(random, good.size() / kPage);
    if (free.contains(page)) continue;
    ++i;
    overwrite(good, page, random);
    const std::string damaged = content(layout.database());
    const auto refused = open_store(layout.database());
    ASSERT_FALSE(refused) << "page " << page;
    EXPECT_EQ(refused.error().reason,
              page == 1 ? ErrorReason::STORE_DIFFERS : ErrorReason::STORE_FAILED);
    for (const std::string& part :
         {layout.database().string() + ": ", std::string("hydroprint admin set-aside")}) {
      EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    }
    EXPECT_EQ(faults(check(), page == 1 ? "" : "damaged"), 1U) << "page " << page;
    EXPECT_EQ(content(layout.database()), damaged) << "nothing is changed silently";
  }
}

// As after a kill, with changes that are only in the log.
TEST_F(Damage, UncleanStopIsNoReasonToRefuse) {
  add("in the log");
  ASSERT_GT(fs::file_size(layout.database().string() + "-wal"), 0U);
  const auto copy = folder.path() / "copy.db";
  for (const char* const tail : {"", "-wal"}) {
    fs::copy_file(layout.database().string() + tail, copy.string() + tail);
  }
  const auto after = open_store(copy);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(select_numbers(**after, "SELECT count(*) FROM jobs", {})->front(), 1);
}

// As for a large database, which is not checked after a clean stop.
TEST_F(Damage, DamageIsNoticedAtUse) {
  Random random(2);
  for (int i = 0; i < 50; ++i) compute(std::to_string(i), "film");
  close();
  const std::string good = content(layout.database());
  replace(layout.database(), good.substr(0, kPage) + noise(random, good.size() - kPage));
  const auto opened = Database::open(layout.database(), "");
  const Status read =
      opened ? (*opened)->run("SELECT count(body) FROM jobs") : tl::unexpected(opened.error());
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("is damaged"), std::string::npos) << read.error().message;
}

TEST_F(Damage, FlippedArtifactsAreNeitherServedNorReused) {
  Random random(3);
  for (int i = 0; i < kDraws; ++i) {
    const std::string digest = "job " + std::to_string(i);
    const Job job = compute(digest, noise(random, 1 + draw(random, 300'000)));
    const auto file = layout.artifacts(job.id) / "film.png";
    const bool is_read_before = i % 2 == 0;  // its hash is then in memory
    if (is_read_before) {
      EXPECT_TRUE(jobs->sound_artifact(job.id, "film.png"));
    }
    flip_a_bit(random, file);
    const auto refused = jobs->sound_artifact(job.id, "film.png");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::kDataLoss);
    EXPECT_EQ(refused.error().reason, ErrorReason::ARTIFACT_DAMAGED);
    EXPECT_NE(refused.error().message.find("hydroprint retry " + std::to_string(job.id)),
              std::string::npos);
    EXPECT_EQ(add(digest).state, JobState::kQueued) << "computed again";
  }
  const auto lines = check();
  EXPECT_EQ(faults(lines, "its content has changed"), 20U) << "the first ones are named";
  EXPECT_EQ(faults(lines, "5 more are damaged"), 1U);
}

TEST_F(Damage, FlippedAssetsAreNotUsedAndCanBeUploadedAgain) {
  Random random(4);
  for (int i = 0; i < kDraws; ++i) {
    const std::string bytes = noise(random, 1 + draw(random, 300'000)), hash = sha256(bytes);
    upload(bytes);
    EXPECT_TRUE(lay_out(hash));
    EXPECT_TRUE(std::holds_alternative<Asset>(ask(bytes).value()));
    flip_a_bit(random, layout.asset(hash));
    EXPECT_EQ(faults(check(), "its content has changed; upload the file again"), 1U);
    const Status refused = lay_out(hash);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().reason, ErrorReason::ARTIFACT_DAMAGED);
    EXPECT_NE(refused.error().message.find("upload the file again"), std::string::npos);
    upload(bytes);
    EXPECT_TRUE(lay_out(hash));
    EXPECT_EQ(faults(check()), 0U);
  }
}

TEST_F(Damage, AssetThatIsTakenFromAJobAgainIsRepaired) {
  const Job job = compute("1", "film");
  const auto source = layout.artifacts(job.id) / "film.png";
  const Asset as{sha256("film"), 4, "image/png", 0};
  ASSERT_TRUE(assets->adopt(source, as));
  discard(layout.asset(as.sha256));  // no other link to the artifact
  replace(layout.asset(as.sha256), "fill");
  ASSERT_TRUE(assets->adopt(source, as));
  EXPECT_EQ(content(layout.asset(as.sha256)), "film");
}

TEST_F(Damage, CheckComparesFilesAndRows) {
  const Job gone = compute("1", "film"), shorter = compute("2", "film"),
            good = compute("3", "film");
  EXPECT_EQ(faults(check()), 0U);
  discard(layout.artifacts(gone.id) / "film.png");
  replace(layout.artifacts(shorter.id) / "film.png", "fi");
  replace(layout.artifacts(good.id) / "unknown", "");
  const auto lines = check();
  EXPECT_EQ(faults(lines), 2U);
  EXPECT_EQ(faults(lines, "artifacts/1/film.png: missing"), 1U);
  EXPECT_EQ(faults(lines, "artifacts/2/film.png: has 2 bytes instead of 4"), 1U);
  EXPECT_EQ(lines.back().verdict, CheckLine::Verdict::kNote);
  EXPECT_NE(lines.back().detail.find("such as artifacts/3/unknown"), std::string::npos);
  EXPECT_EQ(check().size(), lines.size()) << "the check changes nothing";
}

TEST_F(Damage, OnlyADamagedDatabaseIsSetAside) {
  Random random(5);
  compute("1", "film");
  close();
  const auto refused = admin::set_database_aside(layout.root);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("not damaged"), std::string::npos);
  overwrite(content(layout.database()), 3, random);
  const std::string damaged = content(layout.database());
  replace(layout.database().string() + "-wal", "log");
  const auto path = admin::set_database_aside(layout.root);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(content(*path), damaged);
  EXPECT_EQ(content(path->string() + "-wal"), "log");
  EXPECT_FALSE(fs::exists(layout.database()));
  open();
  EXPECT_TRUE(jobs->list({})->empty());
  EXPECT_TRUE(set_aside().contains("film")) << "the start sets aside the files, too";
}

}  // namespace
}  // namespace hydroprint::daemon
