#include "tests/sim/worker/worker_fixture.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "sim/image/io/image_file.h"
#include "tests/sim/worker/bodies.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename());
  }
  return names;
}

void Worker::SetUp() {
  folder.write("sphere.obj", sphere_obj(12, 12, "0.2 0.6 0.4"));
  image::RgbImage texture{64, 32, std::vector<std::uint8_t>(3 * 64 * 32)};
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      std::uint8_t* pixel = texture.at(x, y);
      pixel[0] = static_cast<std::uint8_t>(4 * x);
      pixel[1] = static_cast<std::uint8_t>(8 * y);
      pixel[2] = 128;
    }
  }
  ASSERT_TRUE(image::write_png(folder.path() / "texture.png", texture, 100));
}

Arguments Worker::simulate(const Arguments& more, bool with_mesh) const {
  Arguments all = {
      testing::program_path("hydroprint-worker"), "simulate", "--out", out(), "--threads", "2"};
  if (with_mesh) all.insert(all.end(), {"--mesh", path("sphere.obj")});
  const auto has = [&](const char* flag) {
    return std::find(more.begin(), more.end(), flag) != more.end();
  };
  if (!has("--film")) all.insert(all.end(), {"--film", "60x70"});
  if (!has("--dpi")) all.insert(all.end(), {"--dpi", "100"});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Arguments Worker::predict(const Arguments& more) const {
  Arguments all = {testing::program_path("hydroprint-worker"),
                   "predict",
                   "--mesh",
                   path("sphere.obj"),
                   "--film-image",
                   path("film.png"),
                   "--film",
                   "60x70",
                   "--out",
                   out()};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

void Worker::expect_refusal(int status, const Arguments& command, const Arguments& words,
                            const ProcessOptions& options) const {
  const auto before = names_in(folder.path());
  const Ended ended = testing::run(command, options);
  EXPECT_EQ(ended.status, status) << "signal " << ended.signal << ": " << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_TRUE(ended.err.starts_with("hydroprint-worker: ")) << ended.err;
  for (const std::string& word : words) {
    EXPECT_NE(ended.err.find(word), std::string::npos) << word << " in " << ended.err;
  }
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(names_in(folder.path()), before);
}

}  // namespace hydroprint::worker
