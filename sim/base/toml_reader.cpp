#include "sim/base/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "sim/base/input_file.h"
#include "sim/base/utf8.h"

namespace hydroprint {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

std::string place(const std::filesystem::path& path, const toml::source_region& region) {
  return fmt::format("{}: line {}: ", path.string(), region.begin.line);
}

std::string quoted_list(const std::vector<std::string_view>& words) {
  return fmt::format("\"{}\"", fmt::join(words, "\", \""));
}

template <class T>
std::string range_text(std::string_view kind, T least, T most) {
  return fmt::format("Give {} from {} to {}", kind, least, most);
}

}  // namespace

Result<toml::table> read_toml_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const std::string text, read_text_file(path, kMaxBytes));
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    return fail(Code::kInvalidArgument,
                one_line(place(path, error.source()) + std::string(error.description()) +
                         ". Correct the TOML there"));
  }
}

struct TomlReader::Shared {
  std::filesystem::path path;
  toml::table root;
  toml::table none;  // represents a missing table
  std::optional<Error> error;
  std::map<const toml::table*, std::set<std::string, std::less<>>> used_keys;
};

TomlReader::TomlReader(std::shared_ptr<Shared> shared, const toml::table* table, std::string name)
    : shared_(std::move(shared)), table_(table), name_(std::move(name)) {
  shared_->used_keys[table_];
}

Result<TomlReader> TomlReader::open(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(toml::table root, read_toml_file(path));
  auto shared = std::make_shared<Shared>();
  shared->path = path;
  shared->root = std::move(root);
  const toml::table* table = &shared->root;
  return TomlReader(std::move(shared), table, "");
}

bool TomlReader::has(std::string_view key) const { return table_->contains(key); }

std::string TomlReader::full(std::string_view key) const {
  if (key.empty()) return name_;
  return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
}

void TomlReader::refuse(std::string_view key, const std::string& what) {
  if (shared_->error) return;
  const auto entry = table_->find(key);
  const toml::source_region& region =
      entry == table_->end() ? table_->source() : entry->first.source();
  shared_->error = Error{Code::kInvalidArgument,
                         one_line(place(shared_->path, region) + full(key) + " " + what),
                         ErrorReason::CONFIG_INVALID,
                         {}};
}

const toml::node* TomlReader::find(std::string_view key, bool required) {
  shared_->used_keys[table_].emplace(key);
  const toml::node* node = table_->get(key);
  if (node == nullptr && required) refuse(key, "is missing. Add it");
  return node;
}

double TomlReader::number(std::string_view key, double least, double most,
                          std::optional<double> fallback) {
  const toml::node* node = find(key, !fallback);
  if (node == nullptr) return fallback.value_or(0);
  const double value = node->is_number() ? node->value<double>().value_or(NAN) : NAN;
  if (!(value >= least && value <= most)) {
    refuse(key, "is not a number in range. " + range_text("a number", least, most));
  }
  return value;
}

std::int64_t TomlReader::integer(std::string_view key, std::int64_t least, std::int64_t most,
                                 std::optional<std::int64_t> fallback) {
  const toml::node* node = find(key, !fallback);
  if (node == nullptr) return fallback.value_or(least);
  const auto* value = node->as_integer();
  if (value == nullptr || value->get() < least || value->get() > most) {
    refuse(key, "is not a whole number in range. " + range_text("a whole number", least, most));
    return least;
  }
  return value->get();
}

bool TomlReader::flag(std::string_view key, std::optional<bool> fallback) {
  const toml::node* node = find(key, !fallback);
  if (node == nullptr) return fallback.value_or(false);
  const auto* value = node->as_boolean();
  if (value == nullptr) refuse(key, "is not a boolean. Write true or false");
  return value != nullptr && value->get();
}

std::string TomlReader::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = find(key, !fallback);
  if (node == nullptr) return std::move(fallback).value_or("");
  const auto* value = node->as_string();
  if (value == nullptr || value->get().find('\0') != std::string::npos) {
    refuse(key, "is not valid text. Write text in quotes, without NUL characters");
    return {};
  }
  return value->get();
}

std::size_t TomlReader::choice(std::string_view key, const std::vector<std::string_view>& words,
                               std::optional<std::size_t> fallback) {
  const toml::node* node = find(key, !fallback);
  if (node == nullptr) return fallback.value_or(0);
  const auto* value = node->as_string();
  const auto found =
      value == nullptr ? words.end() : std::find(words.begin(), words.end(), value->get());
  if (found == words.end()) {
    refuse(key, "has an unknown value. Write one of " + quoted_list(words));
    return 0;
  }
  return static_cast<std::size_t>(found - words.begin());
}

TomlReader TomlReader::table(std::string_view key) {
  const toml::node* node = find(key, true);
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  if (node != nullptr && table == nullptr) {
    refuse(key, fmt::format("is not a table. Write [{}] or {} = {{...}}", full(key), key));
  }
  return {shared_, table == nullptr ? &shared_->none : table, full(key)};
}

std::vector<const toml::node*> TomlReader::array(std::string_view key) {
  std::vector<const toml::node*> out;
  const toml::node* node = find(key, true);
  if (node == nullptr) return out;
  if (const toml::array* array = node->as_array()) {
    for (const toml::node& entry : *array) out.push_back(&entry);
  } else {
    refuse(key, fmt::format("is not an array. Write {} = [...]", key));
  }
  return out;
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
  std::vector<TomlReader> out;
  for (const toml::node* entry : array(key)) {
    const toml::table* table = entry->as_table();
    if (table == nullptr) {
      refuse(key, "contains entries that are not tables. Write [[" + full(key) + "]]");
      return {};
    }
    out.push_back({shared_, table, full(key)});
  }
  return out;
}

void TomlReader::vector(std::string_view key, double least, double most,
                        Eigen::Ref<Eigen::VectorXd> out) {
  if (const toml::node* node = find(key, false)) vector(key, *node, least, most, out);
}

void TomlReader::vector(std::string_view key, const toml::node& list, double least, double most,
                        Eigen::Ref<Eigen::VectorXd> out) {
  const toml::array* array = list.as_array();
  bool is_right = array != nullptr && array->size() == static_cast<std::size_t>(out.size());
  for (Eigen::Index i = 0; is_right && i < out.size(); ++i) {
    const toml::node& number = (*array)[static_cast<std::size_t>(i)];
    out[i] = number.is_number() ? number.value<double>().value_or(NAN) : NAN;
    is_right = out[i] >= least && out[i] <= most;
  }
  if (is_right) return;
  const std::string wanted = fmt::format("a list of {} numbers", out.size());
  refuse(key,
         fmt::format("is not {} in range. {}", wanted, range_text(wanted + ", each", least, most)));
}

Status TomlReader::finish() const {
  if (shared_->error) return tl::unexpected(*shared_->error);
  const toml::key* unknown = nullptr;
  std::string known;
  for (const auto& [table, used_keys] : shared_->used_keys) {
    for (const auto& entry : *table) {
      const toml::key& key = entry.first;
      if (used_keys.contains(key.str())) continue;
      if (unknown != nullptr && unknown->source().begin < key.source().begin) continue;
      unknown = &key;
      known = fmt::format("{}", fmt::join(used_keys, ", "));
    }
  }
  if (unknown == nullptr) return {};
  return fail(Code::kInvalidArgument,
              one_line(place(shared_->path, unknown->source()) + std::string(unknown->str()) +
                       " is not a known key here. Use " + known),
              ErrorReason::CONFIG_INVALID);
}

}  // namespace hydroprint
