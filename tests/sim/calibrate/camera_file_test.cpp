// A camera's calibration as a file, with and without its fixed pattern.
#include "sim/calibrate/camera_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "sim/calibrate/base64.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::calibrate {
namespace {

using Json = nlohmann::json;

/// A camera whose pattern has incomplete patches at the image's edges.
registration::CameraCalibration camera() {
  registration::CameraCalibration out;
  out.lens.width_px = 66;
  out.lens.height_px = 50;
  out.lens.k1 = 0.1 / 3;
  out.covariance = scan::Lens::Matrix::Random();
  out.views = 12;
  out.rms_mm = 1.0 / 3;
  out.pattern = {66, 50, 4};
  const auto patches = static_cast<Eigen::Index>(out.pattern.patches());
  for (Eigen::Index i = 0; i < patches; ++i) {
    out.pattern.offset.push_back(static_cast<float>(i - 100) / 77);
    out.pattern.sigma.push_back(static_cast<float>(i) / static_cast<float>(patches));
  }
  out.pattern.set_shared(Eigen::MatrixXd::Random(15, patches));
  return out;
}

class CameraFile : public ::testing::Test {
 protected:
  [[nodiscard]] Result<registration::CameraCalibration> read(const std::string& text) const {
    return read_camera(folder.write("camera.json", text));
  }
  /// The error for a file whose pattern has `value` for `key`.
  [[nodiscard]] std::string refusal(const std::string& key, const Json& value) const {
    Json json = Json::parse(camera_json(camera()));
    json["pattern"][key] = value;
    const auto found = read(json.dump());
    if (found) return {};
    EXPECT_EQ(found.error().code, Code::kInvalidArgument);
    return found.error().message;
  }

  testing::TemporaryFolder folder;
};

TEST_F(CameraFile, ReadsBackAsTheSameCamera) {
  const auto wrote = camera();
  const auto read_back = read(camera_json(wrote));
  ASSERT_TRUE(read_back) << read_back.error().message;
  EXPECT_EQ(read_back->lens.parameters(), wrote.lens.parameters());
  EXPECT_EQ(read_back->covariance, wrote.covariance);
  EXPECT_EQ(read_back->views, wrote.views);
  EXPECT_EQ(read_back->rms_mm, wrote.rms_mm);
  EXPECT_EQ(read_back->pattern.patch_px, wrote.pattern.patch_px);
  EXPECT_EQ(read_back->pattern.width_px, 66);
  EXPECT_EQ(read_back->pattern.height_px, 50);
  EXPECT_EQ(read_back->pattern.offset, wrote.pattern.offset);
  EXPECT_EQ(read_back->pattern.sigma, wrote.pattern.sigma);
  EXPECT_EQ(read_back->pattern.step, wrote.pattern.step);
  EXPECT_EQ(read_back->pattern.shared, wrote.pattern.shared);
}

TEST_F(CameraFile, WithoutAPatternThePatternIsUnknown) {
  registration::CameraCalibration plain = camera();
  plain.pattern = {};
  const auto found = read(camera_json(plain));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_FALSE(found->pattern.is_known());
  EXPECT_EQ(found->lens.parameters(), camera().lens.parameters());
}

TEST_F(CameraFile, APatternOfAnotherImageIsRefused) {
  Json json = Json::parse(camera_json(camera()));
  json["width_px"] = 640;
  json["height_px"] = 480;
  const auto found = read(json.dump());
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("does not match the image size. Calibrate the camera again"),
            std::string::npos)
      << found.error().message;
  EXPECT_NE(refusal("patch_px", 8).find("pattern"), std::string::npos);
}

TEST_F(CameraFile, ABrokenPatternIsRefused) {
  const std::string broken = "camera.json: the fixed pattern is invalid";
  EXPECT_NE(refusal("offset", "!!!!").find(broken), std::string::npos);
  EXPECT_NE(refusal("offset", "AAAA").find(broken), std::string::npos);
  EXPECT_NE(refusal("sigma", "").find(broken), std::string::npos);
  EXPECT_NE(refusal("shared", "AAAA").find(broken), std::string::npos);
  EXPECT_NE(refusal("shared_step", "").find(broken), std::string::npos);
  for (const int patch_px : {0, -4, 1, 100000, 2147483647})
    EXPECT_NE(refusal("patch_px", patch_px).find(broken), std::string::npos) << patch_px;
  EXPECT_NE(refusal("offset", 3).find("not a camera calibration"), std::string::npos);
  EXPECT_NE(refusal("sigma", nullptr).find("not a camera calibration"), std::string::npos);
  // All values are NaN (0x7fc00000).
  std::vector<unsigned char> nan;
  for (std::size_t i = 0; i < camera().pattern.patches(); ++i)
    nan.insert(nan.end(), {0, 0, 0xc0, 0x7f});
  EXPECT_NE(refusal("offset", base64(nan)).find(broken), std::string::npos);
}

TEST(Base64, IsThatOfRfc4648) {
  const auto text = [](const std::string& s) {
    return base64({reinterpret_cast<const unsigned char*>(s.data()), s.size()});
  };
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(text("f"), "Zg==");
  EXPECT_EQ(text("fo"), "Zm8=");
  EXPECT_EQ(text("foo"), "Zm9v");
  EXPECT_EQ(text("foob"), "Zm9vYg==");
  EXPECT_EQ(text("fooba"), "Zm9vYmE=");
  EXPECT_EQ(text("foobar"), "Zm9vYmFy");
}

TEST(Base64, ReadsBackAllBytesAndNothingElse) {
  std::vector<unsigned char> bytes(256);
  std::iota(bytes.begin(), bytes.end(), static_cast<unsigned char>(0));
  for (std::size_t length = 250; length <= bytes.size(); ++length) {
    const std::vector<unsigned char> some(bytes.begin(),
                                          bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_EQ(from_base64(base64(some)), some);
  }
  for (const char* wrong :
       {"A", "AA", "AAA", "A===", "====", "=AAA", "AA=A", "AA A", "AA\nA", "A-_A"})
    EXPECT_FALSE(from_base64(wrong)) << wrong;
}

}  // namespace
}  // namespace hydroprint::calibrate
