#include "sim/mesh/read/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "sim/base/utf8.h"
#include "sim/mesh/read/colours.h"
#include "sim/mesh/read/file.h"
#include "sim/mesh/read/mtl_map.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

/// Keywords of a material that show some colour, which print as nothing.
bool is_other_colour(const std::string& keyword) {
  static const std::set<std::string> kKeywords = {"ka",     "ks",     "ke",   "tf",      "map_ks",
                                                  "map_ke", "map_ka", "refl", "map_refl"};
  return kKeywords.contains(keyword);
}

class MtlParser {
 public:
  MtlParser(std::string_view text, const std::filesystem::path& path) : rest_(text), path_(path) {}

  Result<MtlFile> run() {
    while (!rest_.empty()) {
      ++line_;
      HP_RETURN_IF_ERROR(parse(next_line(rest_)));
    }
    finish_material();
    scale_colours();
    if (commas_ > 0)
      warn(WarningCode::DECIMAL_COMMAS, fmt::format("{} numbers have a decimal comma", commas_));
    return std::move(file_);
  }

 private:
  void warn(WarningCode code, std::string message) {
    file_.warnings.push_back({code, std::move(message), {InFile{path_.string()}}});
  }

  [[nodiscard]] tl::unexpected<Error> bad(std::string_view what) const {
    return bad_input(path_, fmt::format("line {}", line_), what);
  }

  Status parse(std::string_view line) {
    if (line.find('\0') != line.npos)
      return bad("contains binary data; save the material file as text in UTF-8");
    const std::string keyword = lower_case(next_word(line));
    if (keyword == "newmtl") {
      finish_material();
      file_.materials.push_back({});
      file_.materials.back().name = trimmed(line);
      return {};
    }
    if (file_.materials.empty()) return {};
    if (keyword == "kd") return parse_colour(line);
    if (keyword == "map_kd") return parse_map(line, diffuse_);
    if (keyword == "map_ka") return parse_map(line, ambient_);
    if (is_other_colour(keyword)) others_.insert(keyword);
    return {};
  }

  /// Parses `Kd r [g b]`. `Kd spectral` and `Kd xyz` are not understood.
  Status parse_colour(std::string_view line) {
    MtlMaterial& material = file_.materials.back();
    const std::string_view whole = line;
    const std::string form = lower_case(next_word(line));
    if (form == "spectral" || form == "xyz") {
      material.not_understood.push_back("Kd " + form);
      return {};
    }
    line = whole;
    Eigen::Vector3f colour;
    int count = 0;
    for (auto word = next_word(line); !word.empty() && word[0] != '#' && count < 3;
         word = next_word(line)) {
      const auto value = number(word);
      if (!value)
        return bad(fmt::format("Kd needs numbers, but has \"{}\"; export the materials again",
                               one_line(std::string(word.substr(0, 40)))));
      colour[count++] = static_cast<float>(*value);
    }
    if (count == 0) return bad("Kd has no numbers; export the materials again");
    for (; count < 3; ++count) colour[count] = colour[count - 1];
    material.colour = colour;
    return {};
  }

  /// Parses a number with a decimal point or comma.
  std::optional<double> number(std::string_view word) {
    std::string text(word);
    if (const auto comma = text.find(','); comma != text.npos) {
      text[comma] = '.';
      ++commas_;
    }
    return parse_number(text);
  }

  Status parse_map(std::string_view line, std::optional<MtlMap>& map) {
    auto parsed = parse_mtl_map(line);
    if (!parsed) return bad(parsed.error());
    map = std::move(*parsed);
    return {};
  }

  /// Takes the texture of the material that ends here.
  void finish_material() {
    if (file_.materials.empty()) return;
    MtlMaterial& material = file_.materials.back();
    if (!diffuse_ && ambient_)
      warn(WarningCode::AMBIENT_TEXTURE_USED,
           fmt::format("material \"{}\" has no map_Kd: its map_Ka is used", material.name));
    if (const auto& map = diffuse_ ? diffuse_ : ambient_) {
      material.texture = map->file;
      material.wrap = map->clamp ? Wrap::kClamp : Wrap::kRepeat;
      material.scale = map->scale.head<2>();
      material.offset = map->offset.head<2>();
      if (!map->ignored.empty())
        warn(WarningCode::TEXTURE_OPTIONS_IGNORED,
             fmt::format("material \"{}\": the option {} of its texture is not supported and was "
                         "left out",
                         material.name, map->ignored));
    } else if (!material.colour) {
      for (const std::string& keyword : others_) material.not_understood.push_back(keyword);
    }
    diffuse_.reset();
    ambient_.reset();
    others_.clear();
  }

  void scale_colours() {
    std::vector<Eigen::Vector3f> colours;
    for (const auto& material : file_.materials)
      if (material.colour) colours.push_back(*material.colour);
    bring_to_unit(colours, "materials", path_, file_.warnings);
    auto next = colours.begin();
    for (auto& material : file_.materials)
      if (material.colour) material.colour = *next++;
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
  std::size_t line_ = 0;
  std::size_t commas_ = 0;
  MtlFile file_;
  std::optional<MtlMap> diffuse_;
  std::optional<MtlMap> ambient_;
  std::set<std::string> others_;
};

}  // namespace

Result<MtlFile> parse_mtl(std::string_view text, const std::filesystem::path& path) {
  return MtlParser(text, path).run();
}

}  // namespace hydroprint::mesh
