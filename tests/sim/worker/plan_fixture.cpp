#include "tests/sim/worker/plan_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "proto/warning_message.h"
#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/report_file.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

template <class Value>
Value take(const std::string& bytes, std::size_t& at) {
  Value value{};
  if (at + sizeof value > bytes.size()) {
    ADD_FAILURE() << "the file is too short";
    return value;
  }
  std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

std::string header_of(std::size_t points, std::size_t triangles, std::size_t dips) {
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nproperty int dip\n",
      points);
  for (const char* name : {"weight", "stretch", "stretch_min"}) {
    for (std::size_t k = 1; k <= dips; ++k) out += fmt::format("property double {}_{}\n", name, k);
  }
  return out + fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                           triangles);
}

std::string without_comments(const std::string& header) {
  std::istringstream lines(header);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    out += line.starts_with("comment ") ? "" : line + '\n';
  return out;
}

}  // namespace

PlanPly read_plan_ply(const std::filesystem::path& path, std::size_t dips) {
  const std::string bytes = content(path);
  const auto count = [&](const std::string& what) -> std::size_t {
    return std::stoul(bytes.substr(bytes.find(what) + what.size()));
  };
  PlanPly out;
  const std::size_t points = count("element vertex ");
  out.triangles = count("element face ");
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  const std::string header = header_of(points, out.triangles, dips);
  EXPECT_EQ(without_comments(bytes.substr(0, at)), header);
  if (::testing::Test::HasFailure()) return {};
  for (std::size_t i = 0; i < points; ++i) {
    PlanPoint& point = out.points.emplace_back();
    for (double& x : point.xyz) x = take<double>(bytes, at);
    point.dip = take<std::int32_t>(bytes, at);
    for (std::size_t k = 0; k < dips; ++k) point.weight.push_back(take<double>(bytes, at));
    for (std::size_t k = 0; k < dips; ++k) point.stretch.push_back(take<double>(bytes, at));
    for (std::size_t k = 0; k < dips; ++k) point.stretch_min.push_back(take<double>(bytes, at));
  }
  EXPECT_EQ(bytes.size(), at + 13 * out.triangles);
  return out;
}

std::string hollow_sphere_obj(double radius_mm, double cavity_mm, int rings) {
  const std::string outer = sphere_obj(radius_mm, rings);
  const auto count = [&](const std::string& start) {
    std::istringstream lines(outer);
    int found = 0;
    for (std::string line; std::getline(lines, line);) found += line.starts_with(start) ? 1 : 0;
    return found;
  };
  const int vertices = count("v ");
  std::istringstream lines(sphere_obj(cavity_mm, rings));
  std::ostringstream out;
  out << outer;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("f ")) {
      out << line << '\n';
      continue;
    }
    // The faces of the cavity look inwards: their corners are listed the other way round.
    std::istringstream words(line.substr(2));
    std::array<int, 3> corner{};
    for (int& index : corner) {
      std::string word;
      words >> word;
      index = std::stoi(word) + vertices;
    }
    out << fmt::format("f {0}/{0} {1}/{1} {2}/{2}\n", corner[2], corner[1], corner[0]);
  }
  return out.str();
}

void PlanWorker::SetUp() {
  Worker::SetUp();
  write_immersions({{1, 0, 0, 0}, {0, 1, 0, 0}});
}

void PlanWorker::write_immersions(const std::vector<std::array<double, 4>>& rotations_wxyz) const {
  std::string list;
  for (const auto& q : rotations_wxyz) {
    list += fmt::format(
        R"({}{{"rotation_wxyz": [{}, {}, {}, {}], "translation_mm": [0, 0, 0], "depth_mm": "full"}})",
        list.empty() ? "" : ", ", q[0], q[1], q[2], q[3]);
  }
  folder.write("two.json", "[" + list + "]");
}

Arguments PlanWorker::plan(const Arguments& more) const {
  Arguments all = {testing::program_path("hydroprint-worker"), "plan", "--threads", "2"};
  const auto add = [&](const std::string& flag, const std::string& value) {
    if (std::find(more.begin(), more.end(), flag) == more.end())
      all.insert(all.end(), {flag, value});
  };
  add("--out", out());
  add("--mesh", path("sphere.obj"));
  add("--texture", path("texture.png"));
  add("--immersions", path("two.json"));
  add("--film", "60x70");
  add("--model", "stokes");
  add("--dpi", "100");
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

v1::PlanReport PlanWorker::planned(const Arguments& more) const {
  const Ended ended = testing::run(plan(more));
  EXPECT_EQ(ended.status, 0) << ended.err;
  if (ended.status != 0) return {};
  return testing::read_message<v1::PlanReport>(out() + "/report.json");
}

std::set<std::string> PlanWorker::warned(const v1::PlanReport& report) {
  std::set<std::string> out;
  for (const v1::Warning& message : report.run().warnings()) {
    const Warning warning = to_warning(message);
    EXPECT_NE(warning.code, WarningCode::CODE_UNSPECIFIED) << warning.message;
    out.insert(std::string(name_of(warning.code)) + " " + words_of(warning.where));
  }
  return out;
}

}  // namespace hydroprint::worker
