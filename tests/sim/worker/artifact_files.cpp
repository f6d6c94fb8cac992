#include "tests/sim/worker/artifact_files.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {

Ply read_ply(const std::filesystem::path& path) {
  const std::string bytes = content(path);
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  Ply ply{bytes.substr(0, at), {}, {}, {}};
  const auto count = [&](const std::string& what) {
    return std::stoul(ply.header.substr(ply.header.find(what) + what.size()));
  };
  ply.vertices.resize(count("element vertex "));
  ply.faces.resize(count("element face "));
  EXPECT_EQ(bytes.size(), at + 72 * ply.vertices.size() + 14 * ply.faces.size());
  std::memcpy(ply.vertices.data(), bytes.data() + at, 72 * ply.vertices.size());
  at += 72 * ply.vertices.size();
  for (auto& face : ply.faces) {
    EXPECT_EQ(bytes[at], 3);
    std::memcpy(face.data(), bytes.data() + at + 1, 12);
    ply.flags.push_back(static_cast<std::uint8_t>(bytes[at + 13]));
    at += 14;
  }
  return ply;
}

std::vector<LandedVertex> read_landed(const std::filesystem::path& path) {
  const std::string bytes = content(path);
  const std::string vertices = "element vertex ";
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  std::vector<LandedVertex> out(std::stoul(bytes.substr(bytes.find(vertices) + vertices.size())));
  for (LandedVertex& vertex : out) {
    std::memcpy(vertex.xyz.data(), bytes.data() + at, 24);
    std::memcpy(vertex.rgb_landed.data(), bytes.data() + at + 24, 4);
    at += 28;
  }
  return out;
}

}  // namespace hydroprint::worker
