// Material files as other programs write them.

#include "sim/mesh/read/mtl.h"

#include <array>

#include "tests/sim/mesh/files.h"

namespace hydroprint::mesh {
namespace {

MtlFile parse(std::string_view text) {
  auto file = parse_mtl(text, "paint.mtl");
  if (!file) {
    ADD_FAILURE() << file.error().message;
    return {};
  }
  return *file;
}

MtlMaterial only(std::string_view text) {
  const MtlFile file = parse(text);
  EXPECT_EQ(file.materials.size(), 1U);
  return file.materials.empty() ? MtlMaterial{} : file.materials.front();
}

void expect_refused_mtl(std::string_view text, const std::string& words) {
  const auto file = parse_mtl(text, "paint.mtl");
  ASSERT_FALSE(file) << text;
  EXPECT_NE(file.error().message.find(words), std::string::npos) << file.error().message;
}

TEST(ParseMtl, LineEndsCaseAndBlanksDoNotMatter) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const MtlMaterial m = only("NewMtl \t shiny  green \t" + end + "\tKD 0.25 0.5 0.75 " + end +
                               "MAP_kd pictures/a b.png \t" + end);
    EXPECT_EQ(m.name, "shiny  green");
    EXPECT_EQ(m.colour, Eigen::Vector3f(0.25, 0.5, 0.75));
    EXPECT_EQ(m.texture, "pictures/a b.png");
  }
}

TEST(ParseMtl, OneNumberOfKdIsGrey) {
  EXPECT_EQ(only("newmtl a\nKd 0.5\n").colour, Eigen::Vector3f(0.5, 0.5, 0.5));
}

TEST(ParseMtl, DecimalCommasAreRead) {
  const MtlFile file = parse("newmtl a\nKd 0,25 0,5 1,0\n");
  EXPECT_EQ(file.materials.at(0).colour, Eigen::Vector3f(0.25, 0.5, 1));
  EXPECT_TRUE(has_warning(file.warnings, WarningCode::DECIMAL_COMMAS));
}

TEST(ParseMtl, ColoursFrom0To255AreScaledTogether) {
  const MtlFile file = parse("newmtl a\nKd 255 51 0\nnewmtl b\nKd 1 0 0\n");
  EXPECT_EQ(file.materials.at(0).colour, Eigen::Vector3f(1, 0.2F, 0));
  EXPECT_EQ(file.materials.at(1).colour, Eigen::Vector3f(1 / 255.0F, 0, 0));
  EXPECT_TRUE(has_warning(file.warnings, WarningCode::COLOURS_SCALED));
}

TEST(ParseMtl, OptionsHaveOneToThreeNumbersAndStandOnEitherSide) {
  const auto material = [](const std::string& map) {
    return only("newmtl a\nmap_Kd " + map + "\n");
  };
  for (const std::string map :
       {"-s 2 -o 0.5 t.png", "-s 2 1 -o 0.5 0 t.png", "-s 2 1 1 -o 0.5 0 0 t.png",
        "t.png -s 2 -o 0.5", "-S 2 -O 0.5 t.png",
        "-blendu on -s 2 -bm 0.3 -o 0.5 -texres 512 t.png",
        "-colorspace sRGB -s 2 -mm 0 1 t.png -o 0.5"}) {
    const MtlMaterial m = material(map);
    EXPECT_EQ(m.texture, "t.png") << map;
    EXPECT_EQ(m.scale, Eigen::Vector2f(2, 1)) << map;
    EXPECT_EQ(m.offset, Eigen::Vector2f(0.5, 0)) << map;
  }
  EXPECT_EQ(material("-clamp on a b.png").wrap, Wrap::kClamp);
  EXPECT_EQ(material("a b.png -clamp on").wrap, Wrap::kClamp);
  EXPECT_EQ(material("\"a b.png\" -clamp off").texture, "a b.png");
}

TEST(ParseMtl, NamesMayLookLikeOptionsOrNumbers) {
  const auto texture = [](const std::string& map) {
    return only("newmtl a\nmap_Kd " + map + "\n").texture;
  };
  EXPECT_EQ(texture("-s 1 1 2.png"), "2.png");
  EXPECT_EQ(texture("-o 0.5 3 d.png"), "d.png");
  EXPECT_EQ(texture("skin -old.png"), "skin -old.png");
  EXPECT_EQ(texture("skin -s.png"), "skin -s.png");
  EXPECT_EQ(texture("-skin.png"), "-skin.png");
}

TEST(ParseMtl, OptionsThatChangeThePictureAreNamedIfTheyAreNotSupported) {
  EXPECT_TRUE(has_warning(parse("newmtl a\nmap_Kd -mm 0.1 2 t.png\n").warnings,
                          WarningCode::TEXTURE_OPTIONS_IGNORED));
  EXPECT_TRUE(has_warning(parse("newmtl a\nmap_Kd -imfchan r t.png\n").warnings,
                          WarningCode::TEXTURE_OPTIONS_IGNORED));
  EXPECT_TRUE(parse("newmtl a\nmap_Kd -t 0 0 0 -mm 0 1 t.png\n").warnings.empty());
}

TEST(ParseMtl, TheAmbientTextureStandsInForAMissingOne) {
  const MtlFile file = parse("newmtl a\nmap_Ka grey.png\nnewmtl b\nmap_Ka x.png\nmap_Kd y.png\n");
  EXPECT_EQ(file.materials.at(0).texture, "grey.png");
  EXPECT_EQ(file.materials.at(1).texture, "y.png");
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_EQ(file.warnings[0].code, WarningCode::AMBIENT_TEXTURE_USED);
}

TEST(ParseMtl, WhatIsNotUnderstoodIsSaid) {
  EXPECT_EQ(only("newmtl a\nKd spectral steel.rfl 1\n").not_understood,
            std::vector<std::string>{"Kd spectral"});
  EXPECT_FALSE(only("newmtl a\nKd xyz 0.3 0.4 0.5\n").colour);
  EXPECT_EQ(only("newmtl a\nKe 1 0 0\nmap_Ks s.png\n").not_understood,
            (std::vector<std::string>{"ke", "map_ks"}));
  EXPECT_TRUE(only("newmtl a\nKd 1 0 0\nKe 1 0 0\n").not_understood.empty());
}

TEST(ParseMtl, BadLinesAreNamedByNumber) {
  expect_refused_mtl("newmtl a\nKd red\n", "paint.mtl: line 2: Kd needs numbers");
  expect_refused_mtl("newmtl a\n\nKd\n", "line 3: Kd has no numbers");
  expect_refused_mtl("newmtl a\nKd 1 nan 0\n", "\"nan\"");
  expect_refused_mtl("newmtl a\nmap_Kd -glow 3 t.png\n", "line 2: the option \"-glow\"");
  expect_refused_mtl("newmtl a\nmap_Kd -s t.png\n", "line 2: the option \"-s\"");
  expect_refused_mtl(std::string_view("newmtl a\nKd 1 \0 0\n", 19), "line 2: contains binary data");
}

TEST(ParseMtl, TenThousandMaterialsAreReadAtOnce) {
  std::string text;
  for (int i = 0; i < 10'000; ++i)
    text += "newmtl m" + std::to_string(i) + "\nKd 0.5 0.25 0\nmap_Kd t.png\n";
  EXPECT_EQ(parse(text).materials.size(), 10'000U);
}

}  // namespace
}  // namespace hydroprint::mesh
