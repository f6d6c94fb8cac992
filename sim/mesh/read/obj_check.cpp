#include "sim/mesh/read/obj_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

std::string quoted(std::string_view word) { return fmt::format("\"{}\"", word.substr(0, 40)); }

class ObjChecker {
 public:
  ObjChecker(std::string_view text, const std::filesystem::path& path) : rest_(text), path_(path) {}

  Result<ObjFacts> run(const Context& context) {
    while (!rest_.empty()) {
      if (++line_ % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
      HP_RETURN_IF_ERROR(check(next_line(rest_)));
    }
    HP_RETURN_IF_ERROR(check_last(vertex_, facts_.vertices, "vertex"));
    HP_RETURN_IF_ERROR(check_last(texture_, facts_.texture_coordinates, "texture coordinate"));
    finish_colours();
    return std::move(facts_);
  }

 private:
  /// Largest index so far and its line. The element may be defined later in the file.
  struct Largest {
    std::int64_t index = 0;
    std::size_t line = 0;
  };

  [[nodiscard]] tl::unexpected<Error> bad(std::size_t line, std::string_view what) const {
    return bad_input(path_, place(line), what);
  }
  [[nodiscard]] tl::unexpected<Error> broken(std::size_t line, std::string_view what) const {
    return damaged(path_, place(line), what);
  }
  static std::string place(std::size_t line) { return fmt::format("line {}", line); }

  Status check(std::string_view line) {
    if (line.find('\0') != line.npos)
      return bad(line_, "contains binary data; use a Wavefront OBJ file in text format (UTF-8)");
    const auto keyword = next_word(line);
    if (keyword == "v") return check_vertex(line);
    if (keyword == "vt") return check_texture_coordinate(line);
    if (keyword == "f") return check_face(line);
    if (keyword == "mtllib") facts_.libraries.emplace_back(line);
    if (keyword == "usemtl" && line.empty()) facts_.has_bare_usemtl = true;
    if (keyword == "#MRGB") return read_polypaint(trimmed(line));
    return {};
  }

  Status check_vertex(std::string_view line) {
    std::array<double, 7> values{};
    std::size_t count = 0;
    for (auto word = next_word(line); !word.empty() && word[0] != '#'; word = next_word(line)) {
      auto number = parse_number(word);
      if (!number && count > 2 && is_not_finite(word)) number = std::nan("");
      if (!number) return broken(line_, quoted(word) + " is not a finite number");
      if (count < values.size()) values[count] = *number;
      ++count;
    }
    if (count < 3) return broken(line_, "a vertex needs three coordinates");
    ++facts_.vertices;
    if (count == 6 || count == 7) add_colour(values);
    if (count == 5 || count > 7) ++odd_vertices_;
    return {};
  }

  void add_colour(const std::array<double, 7>& values) {
    facts_.vertex_colours.resize(facts_.vertices - 1, Eigen::Vector3f::Ones());
    facts_.vertex_colours.push_back(Eigen::Vector3d(values[3], values[4], values[5]).cast<float>());
    ++facts_.coloured_vertices;
  }

  /// Reads a comment of ZBrush: eight hexadecimal digits MMRRGGBB for each vertex, in their order.
  Status read_polypaint(std::string_view digits) {
    for (; digits.size() >= 8; digits.remove_prefix(8)) {
      std::uint32_t value = 0;
      const auto* end = digits.data() + 8;
      if (std::from_chars(digits.data(), end, value, 16).ptr != end)
        return broken(line_, quoted(digits.substr(0, 8)) + " is not a colour");
      polypaint_.push_back(Eigen::Vector3f(static_cast<float>(value >> 16 & 255),
                                           static_cast<float>(value >> 8 & 255),
                                           static_cast<float>(value & 255)) /
                           255);
    }
    return {};
  }

  void finish_colours() {
    if (facts_.coloured_vertices == 0 && !polypaint_.empty()) {
      if (polypaint_.size() == facts_.vertices) {
        facts_.vertex_colours = std::move(polypaint_);
        facts_.coloured_vertices = facts_.vertices;
      } else {
        facts_.not_understood.push_back(fmt::format("{} colours in #MRGB comments for {} vertices",
                                                    polypaint_.size(), facts_.vertices));
      }
    }
    if (facts_.coloured_vertices > 0)
      facts_.vertex_colours.resize(facts_.vertices, Eigen::Vector3f::Ones());
    if (odd_vertices_ > 0)
      facts_.not_understood.push_back(
          fmt::format("{} vertices with neither 3, 4, 6 nor 7 numbers", odd_vertices_));
  }

  Status check_texture_coordinate(std::string_view line) {
    std::size_t count = 0;
    for (auto word = next_word(line); !word.empty() && word[0] != '#'; word = next_word(line)) {
      if (!parse_number(word)) return broken(line_, quoted(word) + " is not a finite number");
      ++count;
    }
    if (count < 1) return broken(line_, "a texture coordinate is empty");
    ++facts_.texture_coordinates;
    return {};
  }

  Status check_face(std::string_view line) {
    std::size_t corners = 0;
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      HP_RETURN_IF_ERROR(check_corner(word));
      ++corners;
    }
    if (corners < 3) return broken(line_, "a face has fewer than three corners");
    facts_.triangles += corners - 2;
    return {};
  }

  Status check_corner(std::string_view word) {
    const auto slash = std::min(word.find('/'), word.size());
    HP_RETURN_IF_ERROR(check_index(word.substr(0, slash), facts_.vertices, vertex_, "vertex"));
    word.remove_prefix(std::min(slash + 1, word.size()));
    const auto texture = word.substr(0, word.find('/'));
    if (texture.empty()) return {};
    return check_index(texture, facts_.texture_coordinates, texture_, "texture coordinate");
  }

  Status check_index(std::string_view word, std::size_t count, Largest& largest,
                     std::string_view what) {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (error != std::errc() || end != word.data() + word.size() || index == 0 ||
        -index > static_cast<std::int64_t>(count) || index > INT32_MAX)
      return out_of_range(line_, word, count, what);
    if (index > largest.index) largest = {index, line_};
    return {};
  }

  Status check_last(const Largest& largest, std::size_t count, std::string_view what) const {
    if (largest.index <= static_cast<std::int64_t>(count)) return {};
    return out_of_range(largest.line, std::to_string(largest.index), count, what);
  }

  [[nodiscard]] tl::unexpected<Error> out_of_range(std::size_t line, std::string_view word,
                                                   std::size_t count, std::string_view what) const {
    return broken(line,
                  fmt::format("a face uses {} {}, but only {} exist", what, quoted(word), count));
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
  std::size_t line_ = 0;
  Largest vertex_;
  Largest texture_;
  std::vector<Eigen::Vector3f> polypaint_;
  std::size_t odd_vertices_ = 0;
  ObjFacts facts_;
};

}  // namespace

Result<ObjFacts> check_obj(std::string_view text, const std::filesystem::path& path,
                           const Context& context) {
  return ObjChecker(text, path).run(context);
}

}  // namespace hydroprint::mesh
