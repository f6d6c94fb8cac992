// Inputs that print-image and template cannot put on paper.

#include <gtest/gtest.h>

#include "sim/image/io/image_file.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

/// The program with a blank film image of A4 at 100 dpi, and an object.
class BadPrint : public Worker {
 protected:
  void SetUp() override {
    Worker::SetUp();
    const image::RgbImage blank{827, 1169, std::vector<std::uint8_t>(3U * 827 * 1169, 255)};
    ASSERT_TRUE(image::write_png(path("film.png"), blank, 300));
    folder.write("pyramid.obj",
                 "v 0 0 0\nv -30 -20 50\nv 30 -20 50\nv 30 20 50\nv -30 20 50\n"
                 "f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 2 5\nf 2 3 4 5\n");
    folder.write("far.json", R"({"rotation_wxyz":[1,0,0,0],"translation_mm":[500,0,0]})");
  }
  [[nodiscard]] Arguments command(const std::string& verb, const std::string& flag,
                                  const std::string& file, const Arguments& more) const {
    Arguments all = {
        testing::program_path("hydroprint-worker"), verb, flag, path(file), "--out", out()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] Arguments print_image(const Arguments& more) const {
    return command("print-image", "--film-image", "film.png", more);
  }
  [[nodiscard]] Arguments placement(const Arguments& more) const {
    return command("template", "--mesh", "pyramid.obj", more);
  }
};

TEST_F(BadPrint, PrintImageErrorsAreOneLine) {
  expect_refusal(3, print_image({"--film", "A3"}),
                 {"film.png: has 827 x 1169 pixels, but a film image of A3 at 71 dpi"});
  expect_refusal(3, print_image({"--dpi", "300"}), {"has 2480 x 3508"});
  expect_refusal(2, print_image({"--paper", "A99"}), {"paper 'A99'"});
  expect_refusal(3, print_image({"--paper", "30x30"}), {"paper: too small for the film"});
  expect_refusal(3, print_image({"--printer-margin-mm", "200"}), {"printer margin"});
  expect_refusal(3, print_image({"--ink-limit", "3"}), {"ink limit: does not apply to RGB"});
  expect_refusal(3, print_image({"--colours", "cmyk", "--ink-limit", "7"}),
                 {"--ink-limit: 7 is out of range"});
  expect_refusal(3, print_image({"--colours", "cmyk", "--formats", "png"}),
                 {"PNG does not support CMYK"});
  expect_refusal(2, print_image({"--formats", "gif"}), {"'gif' is unknown"});
  expect_refusal(2, print_image({"--colours", "hsv"}), {"--colours"});
  expect_refusal(3, print_image({"--icc-profile", path("none.icc")}), {"none.icc: "});
  folder.write("film.png", "not an image");
  expect_refusal(3, print_image({}), {"film.png: "});
}

TEST_F(BadPrint, TemplateErrorsAreOneLine) {
  expect_refusal(3, placement({"--pose", path("far.json")}), {"misses the film A4"});
  expect_refusal(3, placement({"--film", "A3"}), {"paper: smaller than the film A3"});
}

}  // namespace
}  // namespace hydroprint::worker
