#include "client/files/references.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace hydroprint::client {
namespace {

using Names = std::vector<std::string>;

class FindReferences : public ::testing::Test {
 protected:
  FindReferences() { std::filesystem::create_directory(folder_.path() / "sub"); }

  // Returns the names found, sorted; stores notes in notes_.
  Names names(const std::string& model) {
    const auto found = find_references(folder_.path() / model);
    if (!found) return {"error: " + found.error().message};
    notes_ = found->notes;
    Names result;
    for (const Reference& file : found->files) {
      EXPECT_TRUE(std::filesystem::exists(file.path)) << file.path;
      result.push_back(file.name);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  testing::TemporaryFolder folder_;
  Names notes_;
};

TEST_F(FindReferences, FollowsTheLibrariesAndTexturesOfAnObj) {
  folder_.write("a.obj", "mtllib one.mtl two.mtl\nv 0 0 0\n");
  folder_.write("one.mtl", "newmtl m\nmap_Kd skin.png\n");
  folder_.write("two.mtl",
                "newmtl n\n  map_Kd -clamp on -s 1 1 1 sub/fur.png\r\nmap_Ka unused.png\n");
  folder_.write("skin.png", "");
  folder_.write("sub/fur.png", "");
  folder_.write("unused.png", "");
  EXPECT_EQ(names("a.obj"), (Names{"one.mtl", "skin.png", "sub/fur.png", "two.mtl"}));
  EXPECT_TRUE(notes_.empty());
}

TEST_F(FindReferences, AcceptsNamesWithSpaces) {
  folder_.write("a.obj", "mtllib my materials.mtl\n");
  folder_.write("my materials.mtl", "map_Kd the skin.png\n");
  folder_.write("the skin.png", "");
  EXPECT_EQ(names("a.obj"), (Names{"my materials.mtl", "the skin.png"}));
}

TEST_F(FindReferences, AcceptsBackslashes) {
  folder_.write("a.obj", "mtllib .\\a.mtl");
  folder_.write("a.mtl", "map_Kd sub\\skin.png");
  folder_.write("sub/skin.png", "");
  EXPECT_EQ(names("a.obj"), (Names{"a.mtl", "sub/skin.png"}));
}

TEST_F(FindReferences, ResolvesNamesRelativeToTheLibrary) {
  folder_.write("a.obj", "mtllib sub/a.mtl\n");
  folder_.write("sub/a.mtl", "map_Kd skin.png\n");
  folder_.write("sub/skin.png", "");
  EXPECT_EQ(names("a.obj"), (Names{"sub/a.mtl", "sub/skin.png"}));
}

TEST_F(FindReferences, FindsFilesBesideTheModelForPathsOfAnotherMachine) {
  folder_.write("a.obj", "mtllib a.mtl\n");
  folder_.write("a.mtl", "map_Kd \"C:\\Users\\x\\my skin.png\"\n");
  folder_.write("my skin.png", "");
  EXPECT_EQ(names("a.obj"), (Names{"a.mtl", "my skin.png"}));
}

TEST_F(FindReferences, NotesPathsOutsideTheFolderWithoutSendingThem) {
  folder_.write("secret.mtl", "");
  folder_.write("sub/a.obj", "mtllib ../secret.mtl\nmtllib /etc/passwd\nmtllib C:\\x.mtl\n");
  EXPECT_EQ(names("sub/a.obj"), Names());
  EXPECT_EQ(notes_.size(), 3U);
}

TEST_F(FindReferences, NotesMissingFiles) {
  folder_.write("a.obj", "mtllib a.mtl\n");
  EXPECT_EQ(names("a.obj"), Names());
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("a.mtl"), std::string::npos);
}

TEST_F(FindReferences, FollowsTheBuffersAndImagesOfAGltfButNotInlineData) {
  folder_.write("a.gltf", R"({"buffers":[{"uri":"a.bin"},{"uri":"data:;base64,AA=="}],
                              "images":[{"uri":"my%20skin.png"},{"bufferView":0}]})");
  folder_.write("a.bin", "");
  folder_.write("my skin.png", "");
  EXPECT_EQ(names("a.gltf"), (Names{"a.bin", "my skin.png"}));
  EXPECT_TRUE(notes_.empty());
}

std::string glb(const std::string& json, unsigned char announced) {
  std::string text("glTF\2\0\0\0\0\0\0\0", 12);
  text += static_cast<char>(announced);
  return text + std::string(3, '\0') + "JSON" + json;
}

TEST_F(FindReferences, ReadsTheJsonChunkOfAGlb) {
  const std::string json = R"({"images":[{"uri":"skin.png"}]})";
  folder_.write("a.glb", glb(json, static_cast<unsigned char>(json.size())) + "BINARY");
  folder_.write("skin.png", "");
  EXPECT_EQ(names("a.glb"), Names{"skin.png"});
}

TEST_F(FindReferences, ReturnsNothingForABrokenModel) {
  folder_.write("short.glb", glb("{", 200));
  folder_.write("tiny.glb", "glTF");
  folder_.write("broken.gltf", R"({"buffers":[{"uri":)");
  folder_.write("odd.gltf", R"({"buffers":[7,{"uri":8}],"images":"x"})");
  for (const char* model : {"short.glb", "tiny.glb", "broken.gltf", "odd.gltf"})
    EXPECT_EQ(names(model), Names()) << model;
}

TEST_F(FindReferences, FollowsTheTextureCommentsOfAPly) {
  folder_.write("a.ply",
                "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nend_header\n"
                "comment TextureFile other.png\n");
  folder_.write("skin.png", "");
  folder_.write("other.png", "");
  EXPECT_EQ(names("a.ply"), Names{"skin.png"});
}

TEST_F(FindReferences, NamesAMissingModel) {
  const auto found = find_references(folder_.path() / "no.obj");
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("no.obj"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::client
