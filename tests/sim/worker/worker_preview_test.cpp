// The verb preview, which keeps running and answers requests. A page uses it while an object is
// turned.

#include <fcntl.h>
#include <google/protobuf/util/json_util.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "hydroprint/v1/warning.pb.h"
#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

/// One end of a pipe, which child processes do not inherit by default.
class End {
 public:
  explicit End(int fd) : fd_(fd) { ::fcntl(fd, F_SETFD, FD_CLOEXEC); }
  ~End() { close(); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  return ends;
}

struct Answer {
  nlohmann::json head;
  std::vector<float> floats;  ///< the bytes that follow the head
};

/// The running program and its client.
class Session {
 public:
  explicit Session(const Arguments& arguments, std::array<int, 2> in = make_pipe(),
                   std::array<int, 2> out = make_pipe())
      : child_in_(in[0]),
        child_out_(out[1]),
        requests_(in[1]),
        answers_(out[0]),
        process_(arguments, {{}, false, {}, {{STDIN_FILENO, in[0]}, {STDOUT_FILENO, out[1]}}}) {
    child_in_.close();
    child_out_.close();
  }

  void ask(const std::string& lines) {
    ASSERT_EQ(::write(requests_.get(), lines.data(), lines.size()),
              static_cast<ssize_t>(lines.size()));
  }
  void close_requests() { requests_.close(); }
  /// Sends one request and waits for its answer.
  Answer answer_to(const nlohmann::json& request) {
    ask(request.dump() + "\n");
    return next();
  }
  Answer next() {
    std::string line;
    for (char c = 0; c != '\n'; line += c) {
      if (::read(answers_.get(), &c, 1) != 1) return {nlohmann::json::object(), {}};
    }
    Answer answer{nlohmann::json::parse(line), {}};
    answer.floats.resize(answer.head.at("bytes").get<std::size_t>() / sizeof(float));
    read(reinterpret_cast<char*>(answer.floats.data()), answer.floats.size() * sizeof(float));
    return answer;
  }
  void signal(int number) { process_.signal(number); }
  Ended wait() { return process_.wait(); }

 private:
  void read(char* to, std::size_t bytes) {
    while (bytes > 0) {
      const ssize_t got = ::read(answers_.get(), to, bytes);
      ASSERT_GT(got, 0);
      to += got;
      bytes -= static_cast<std::size_t>(got);
    }
  }

  End child_in_, child_out_, requests_, answers_;
  Process process_;
};

nlohmann::json turned(int id, double quarter_turns) {
  const double half_rad = quarter_turns * std::acos(-1) / 4;
  return {{"id", id},
          {"pose", {{"rotation_wxyz", {std::cos(half_rad), std::sin(half_rad), 0, 0}}}},
          {"film", "60x70"}};
}

class Preview : public Worker {
 protected:
  [[nodiscard]] Arguments preview(const Arguments& more = {}) const {
    Arguments all = {testing::program_path("hydroprint-worker"), "preview", "--threads", "2"};
    all.insert(all.end(), more.begin(), more.end());
    if (more.empty()) all.insert(all.end(), {"--mesh", path("sphere.obj")});
    return all;
  }
};

/// The places of a model for display: positions by the attribute _PLACE of its binary glTF.
std::vector<std::array<float, 3>> places_of(const Answer& shown) {
  const auto* bytes = reinterpret_cast<const char*>(shown.floats.data());
  std::uint32_t text_length = 0;
  std::memcpy(&text_length, bytes + 12, sizeof text_length);
  const auto json = nlohmann::json::parse(std::string(bytes + 20, text_length));
  const auto& attributes = json.at("/meshes/0/primitives/0/attributes"_json_pointer);
  const auto floats_of = [&](const char* name) {
    const auto& accessor = json.at("accessors").at(attributes.at(name).get<std::size_t>());
    const auto& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const std::size_t begin = 20 + text_length + 8 + view.at("byteOffset").get<std::size_t>();
    return &shown.floats[begin / sizeof(float)];
  };
  const float *positions = floats_of("POSITION"), *places = floats_of("_PLACE");
  const auto& accessor = json.at("accessors").at(attributes.at("_PLACE").get<std::size_t>());
  std::map<int, std::array<float, 3>> found;
  for (std::size_t i = 0; i < accessor.at("count").get<std::size_t>(); ++i) {
    const float* at = &positions[3 * i];
    found[static_cast<int>(places[i])] = {at[0], at[1], at[2]};
  }
  std::vector<std::array<float, 3>> out;
  for (const auto& [place, position] : found) {
    EXPECT_EQ(place, static_cast<int>(out.size()));
    out.push_back(position);
  }
  return out;
}

TEST_F(Preview, SendsTheModelForDisplayOnRequest) {
  Session session(preview());
  const Answer shown = session.answer_to({{"id", 3}, {"read", true}});
  EXPECT_EQ(shown.head.at("id"), 3);
  EXPECT_EQ(shown.head.at("summary").at("format"), "OBJ");
  EXPECT_EQ(shown.head.at("summary").at("shown_triangles"),
            shown.head.at("summary").at("triangles"));
  ASSERT_GT(shown.floats.size(), 3U);
  EXPECT_EQ(std::memcmp(shown.floats.data(), "glTF", 4), 0);
  for (const auto& at : places_of(shown)) EXPECT_NEAR(std::hypot(at[0], at[1], at[2]), 12, 1e-4);
  EXPECT_EQ(session.answer_to(turned(4, 0)).head.at("id"), 4);
  EXPECT_EQ(session.answer_to({{"id", 5}, {"read", 1}}).head.at("error").at("code"),
            "INVALID_ARGUMENT");
}

TEST_F(Preview, SendsTheLandingPointsOfThePlacesThatAreShown) {
  Session session(preview());
  const auto places = places_of(session.answer_to({{"id", 6}, {"read", true}}));
  nlohmann::json request = turned(7, 0);
  request["depth_mm"] = 12;
  const Answer dip = session.answer_to(request);
  EXPECT_EQ(dip.head.at("id"), 7);
  EXPECT_NEAR(dip.head.at("depth_mm").get<double>(), 12, 1e-9);
  EXPECT_GE(dip.head.at("coverage").get<double>(), 0.5)
      << "the lower half of the sphere must be covered";
  EXPECT_LT(dip.head.at("coverage").get<double>(), 0.6)
      << "only faces at the waterline may be covered in addition";
  ASSERT_EQ(dip.floats.size(), 4 * places.size());
  int below = 0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    const float z_mm = places[v][2];
    const float* const at = &dip.floats[4 * v];
    if (z_mm > 0.01) {
      EXPECT_TRUE(std::isnan(at[0]) && std::isnan(at[3]))
          << "there must be no film above the water";
    } else if (z_mm < -0.01) {
      ++below;
      EXPECT_TRUE(std::isfinite(at[0]) && std::isfinite(at[1])) << v;
      EXPECT_NEAR(at[2], (z_mm + 12) / 5, 0.05) << "the dip speed is 5 mm/s";
      EXPECT_GT(at[3], 0.9) << v;
    }
  }
  EXPECT_GT(below, 100);
  session.close_requests();
  EXPECT_EQ(session.wait().status, 0);
}

TEST_F(Preview, WarningsAreMessagesOfTheApi) {
  Session session(preview());
  const Answer whole = session.answer_to(turned(7, 0));  // its top faces up
  ASSERT_FALSE(whole.head.at("warnings").empty());
  for (const auto& entry : whole.head.at("warnings")) {
    v1::Warning warning;
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(entry.dump(), &warning).ok()) << entry;
    EXPECT_NE(warning.code(), v1::Warning::CODE_UNSPECIFIED) << entry;
  }
}

TEST_F(Preview, OfAVeryFineMeshMapsThePlacesThatAreShown) {
  // A sphere of 250,000 triangles, which is thinned.
  folder.write("fine.obj", sphere_obj(12, 252, "0.2 0.6 0.4"));
  Session session(preview({"--mesh", path("fine.obj")}));
  const Answer shown = session.answer_to({{"id", 6}, {"read", true}});
  EXPECT_GT(shown.head.at("summary").at("triangles"), 200'000);
  EXPECT_LE(shown.head.at("summary").at("shown_triangles"), 200'000);
  const auto places = places_of(shown);
  nlohmann::json request = turned(7, 0);
  request["depth_mm"] = 12;
  const Answer dip = session.answer_to(request);
  ASSERT_EQ(dip.floats.size(), 4 * places.size());
  for (std::size_t v = 0; v < places.size(); ++v) {
    const float* const at = &dip.floats[4 * v];
    if (places[v][2] > 0.1F) {
      EXPECT_TRUE(std::isnan(at[0])) << "above the water";
    } else if (places[v][2] < -0.1F) {
      EXPECT_NEAR(at[2], (places[v][2] + 12) / 5, 0.05) << v;
    }
  }
}

TEST_F(Preview, AnswersASecondPose) {
  Session session(preview());
  const auto places = places_of(session.answer_to({{"id", 3}, {"read", true}}));
  const Answer upright = session.answer_to(turned(1, 0));
  const Answer turned_over = session.answer_to(turned(2, 2));
  const auto first_to_touch = [&](const Answer& dip) {
    std::size_t first = 0;
    for (std::size_t v = 0; 4 * v < dip.floats.size(); ++v) {
      const float time_s = dip.floats[4 * v + 2];
      if (!std::isnan(time_s) && !(time_s >= dip.floats[4 * first + 2])) first = v;
    }
    return places[first][2];
  };
  EXPECT_NEAR(first_to_touch(upright), -12, 1e-3);
  EXPECT_NEAR(first_to_touch(turned_over), 12, 1e-3);
}

TEST_F(Preview, ANewerRequestCancelsThePreviousOne) {
  Session session(preview());
  constexpr int kMany = 40;
  std::string lines;
  for (int id = 1; id <= kMany; ++id) lines += turned(id, id / 20.0).dump() + "\n";
  session.ask(lines);
  int done = 0;
  for (int id = 1; id <= kMany; ++id) {
    const Answer answer = session.next();
    ASSERT_EQ(answer.head.at("id"), id) << "every request must be answered, in order";
    if (answer.head.contains("error")) {
      EXPECT_EQ(answer.head.at("error").at("reason"), "PREVIEW_SUPERSEDED");
    } else {
      ++done;
    }
    if (id == kMany) {
      EXPECT_FALSE(answer.head.contains("error")) << answer.head;
    }
  }
  EXPECT_LT(done, kMany) << "some requests must be superseded";
}

TEST_F(Preview, RefusesInvalidRequestsAndContinues) {
  Session session(preview());
  const auto refused = [&](const std::string& line, int id) {
    session.ask(line + "\n");
    const Answer answer = session.next();
    EXPECT_TRUE(answer.head.contains("error")) << line;
    EXPECT_EQ(answer.head.value("id", 0), id) << line;
    EXPECT_TRUE(answer.floats.empty());
    return answer.head.value("/error/message"_json_pointer, std::string());
  };
  refused("", -1);
  refused("{", -1);
  refused("[1]", -1);
  refused(R"({"film":"A4"})", -1);
  refused(R"({"id":-4})", -1);
  refused(std::string(1 << 17, 'x'), -1);
  EXPECT_NE(refused(R"({"id":1,"film":"A9"})", 1).find("A9"), std::string::npos);
  refused(R"({"id":2,"film":"polygon:/etc/passwd"})", 2);
  refused(R"({"id":3,"depth_mm":-1})", 3);
  refused(R"({"id":4,"depth_mm":1e999})", -1);
  refused(R"({"id":5,"pose":{"rotation_wxyz":[0,0,0,0]}})", 5);
  refused(R"({"id":6,"pose":{"translation_mm":[400,0,0]}})", 6);  // the object is beside the film
  refused(R"({"id":7,"colour":"red"})", 7);
  EXPECT_FALSE(session.answer_to(turned(8, 1)).head.contains("error"));
}

TEST_F(Preview, AnswersTheLastRequestAtEndOfInput) {
  Session session(preview());
  session.ask(turned(1, 0).dump() + "\n");
  session.close_requests();
  EXPECT_EQ(session.next().head.value("id", 0), 1);
  EXPECT_EQ(session.wait().status, 0);
}

TEST_F(Preview, EndsAsOtherVerbsDo) {
  Session session(preview());
  EXPECT_EQ(session.answer_to(turned(1, 0)).head.value("id", 0), 1);
  session.signal(SIGTERM);
  EXPECT_EQ(session.wait().status, 130);
  expect_refusal(3, preview({"--mesh", path("none.obj")}), {"none.obj"});
  expect_refusal(2, preview({"--mesh", path("sphere.obj"), "--film", "A9"}), {"--film", "A9"});
}

}  // namespace
}  // namespace hydroprint::worker
