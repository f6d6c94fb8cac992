#include "sim/film/profile.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

#include "sim/base/number_text.h"
#include "sim/base/toml_reader.h"

namespace hydroprint::film {
namespace {

struct Range {
  double least;
  double most;
};

struct Key {
  std::string_view name;
  double Profile::*member;
  Range range;
};

// The keys with a single number as value.
constexpr std::array<Key, 11> kKeys = {{
    {"thickness_mm", &Profile::thickness_mm, {1e-3, 10}},
    {"ink_ratio_mm", &Profile::ink_ratio_mm, {0, 10}},
    {"drag_length_mm", &Profile::drag_length_mm, {0, 1e4}},
    {"tear_stretch", &Profile::tear_stretch, {1, 100}},
    {"wrinkle_stretch", &Profile::wrinkle_stretch, {0, 1}},
    {"young_modulus_mpa", &Profile::young_modulus_mpa, {1e-6, 1e6}},
    {"density_kg_per_m3", &Profile::density_kg_per_m3, {1, 1e5}},
    {"poisson_ratio", &Profile::poisson_ratio, {0, 0.5}},
    {"activator_ml_per_m2", &Profile::activator_ml_per_m2, {0, 1000}},
    {"soak_s", &Profile::soak_s, {0, 3600}},
    {"activator_wait_s", &Profile::activator_wait_s, {0, 3600}},
}};
constexpr std::string_view kSwelling = "swelling";
constexpr Range kSwellingRange = {1, 2};
constexpr std::string_view kInkIccProfile = "ink_icc_profile";

std::string known_keys() {
  std::string out(kSwelling);
  out.append(", ").append(kInkIccProfile);
  for (const Key& key : kKeys) out.append(", ").append(key.name);
  return out;
}

/// Returns the place of an error: file, line and key.
std::string place(const std::filesystem::path& path, const toml::source_region& region,
                  std::string_view key) {
  return fmt::format("{}: line {}: {}", path.string(), region.begin.line, key);
}

Result<double> read_number(const std::string& where, const toml::node& node, const Range& range) {
  const std::string remedy = fmt::format("Give a number from {} to {}", range.least, range.most);
  if (!node.is_number()) return fail(Code::kInvalidArgument, where + " is not a number. " + remedy);
  const double value = node.value<double>().value_or(NAN);
  if (!(value >= range.least && value <= range.most)) {
    return fail(Code::kOutOfRange, where + " is out of range. " + remedy);
  }
  return value;
}

Result<Eigen::Vector2d> read_swelling(const std::string& where, const toml::node& node) {
  const toml::array* pair = node.as_array();
  if (pair == nullptr || pair->size() != 2) {
    return fail(Code::kInvalidArgument, where + " is not a pair. Write swelling = [1.0, 1.0]");
  }
  Eigen::Vector2d out;
  for (int i = 0; i < 2; ++i) {
    HP_ASSIGN_OR_RETURN(
        out[i], read_number(where, *pair->get(static_cast<std::size_t>(i)), kSwellingRange));
  }
  return out;
}

Result<std::filesystem::path> read_path(const std::string& where, const toml::node& node,
                                        const std::filesystem::path& folder) {
  const auto text = node.value_exact<std::string>();
  if (!text || text->find('\0') != std::string::npos) {
    return fail(
        Code::kInvalidArgument,
        where + " is not a path. Write ink_icc_profile = \"printer.icc\", or \"\" for none");
  }
  if (text->empty()) return std::filesystem::path();
  return folder / *text;
}

Status read_key(const std::filesystem::path& path, const toml::key& name, const toml::node& node,
                Profile& profile) {
  const std::string where = place(path, name.source(), name.str());
  if (name.str() == kSwelling) {
    HP_ASSIGN_OR_RETURN(profile.swelling, read_swelling(where, node));
    return {};
  }
  if (name.str() == kInkIccProfile) {
    HP_ASSIGN_OR_RETURN(profile.ink_icc_profile, read_path(where, node, path.parent_path()));
    return {};
  }
  for (const Key& key : kKeys) {
    if (name.str() != key.name) continue;
    HP_ASSIGN_OR_RETURN(profile.*key.member, read_number(where, node, key.range));
    return {};
  }
  return fail(Code::kInvalidArgument, where + " is not a known key. Use " + known_keys());
}

}  // namespace

Result<Profile> read_profile(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const toml::table table, read_toml_file(path));
  Profile profile;
  for (const auto& [name, node] : table) {
    HP_RETURN_IF_ERROR(read_key(path, name, node, profile));
  }
  return profile;
}

std::string profile_toml(const Profile& profile) {
  std::string out;
  for (const Key& key : kKeys) {
    out += fmt::format("{} = {}\n", key.name, shortest_text(profile.*key.member));
  }
  out += fmt::format("{} = [{}, {}]\n", kSwelling, shortest_text(profile.swelling.x()),
                     shortest_text(profile.swelling.y()));
  if (!profile.ink_icc_profile.empty()) {
    std::ostringstream quoted;
    quoted << toml::value<std::string>(std::filesystem::absolute(profile.ink_icc_profile).string());
    out += fmt::format("{} = {}\n", kInkIccProfile, quoted.str());
  }
  return out;
}

double rest_thickness_mm(const Profile& profile, double t) {
  return profile.thickness_mm + profile.ink_ratio_mm * t;
}

}  // namespace hydroprint::film
