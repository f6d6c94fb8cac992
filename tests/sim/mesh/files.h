#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "sim/mesh/read/read_model.h"

namespace hydroprint::mesh {

/// A folder for one test, removed when this object is destroyed.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "hydroprint-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const auto path = path_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

 private:
  std::filesystem::path path_;
};

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

/// Reads the model in the file, which must succeed.
inline Model read(const std::filesystem::path& path, double scale = 1) {
  auto model = read_model(path, scale, {});
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  return *model;
}

/// Expects that the file is refused with one line that names it and contains `words`.
inline void expect_refused(const std::filesystem::path& path, const std::string& words,
                           Code code = Code::kInvalidArgument) {
  const auto model = read_model(path, 1, {});
  ASSERT_FALSE(model) << path << " was read; expected: " << words;
  EXPECT_EQ(model.error().code, code);
  const auto& message = model.error().message;
  EXPECT_EQ(message.rfind(path.string() + ":", 0), 0U) << message;
  EXPECT_NE(message.find(words), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

inline bool has_warning(const Warnings& warnings, WarningCode code) {
  for (const auto& w : warnings)
    if (w.code == code) return true;
  return false;
}

inline void expect_near(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  EXPECT_LT((a - b).norm(), 1e-5) << a.transpose() << " instead of " << b.transpose();
}

/// A tetrahedron in each file format. The corners of its first face are 0, 2, 1.
inline const std::string kTetrahedronObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

inline constexpr int kTetrahedron[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
inline constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

inline std::string tetrahedron_stl() {
  std::string bytes(80, 'x');
  put<std::uint32_t>(bytes, 4);
  for (const auto& face : kTetrahedron) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0F);
    for (const int corner : face)
      for (const float c : kCorners[corner]) put(bytes, c);
    put<std::uint16_t>(bytes, 0);
  }
  return bytes;
}

inline std::string tetrahedron_stl_text() {
  std::string text = "solid tetrahedron\n";
  for (const auto& face : kTetrahedron) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) {
      text += "vertex";
      for (const float c : kCorners[corner]) text += c > 0 ? " 1" : " 0";
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

inline std::string ply_header(const std::string& format, const std::string& vertices = "4",
                              const std::string& faces = "4", const std::string& more = "") {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more + "element face " +
         faces + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string tetrahedron_ply_body() {
  std::string bytes;
  for (const auto& corner : kCorners)
    for (const float c : corner) put(bytes, c);
  for (const auto& face : kTetrahedron) {
    put<std::uint8_t>(bytes, 3);
    for (const int corner : face) put<std::int32_t>(bytes, corner);
  }
  return bytes;
}

inline const std::string kTetrahedronPlyText =
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

}  // namespace hydroprint::mesh
