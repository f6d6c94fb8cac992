#include "daemon/work_builder.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "daemon/names.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

// The verb as the API has it.
std::string kind_of(std::string verb) {
  std::replace(verb.begin(), verb.end(), '-', '_');
  return verb;
}

// A name that is there twice, or is another one's folder; "" if there is none.
std::string ambiguous_name(const std::vector<InputFile>& inputs) {
  std::set<std::string> names;
  for (const InputFile& file : inputs) {
    if (!names.insert(file.name).second) return file.name;
  }
  for (const std::string& name : names) {
    for (std::size_t end = name.find('/'); end != std::string::npos;
         end = name.find('/', end + 1)) {
      if (names.contains(name.substr(0, end))) return name.substr(0, end);
    }
  }
  return "";
}

std::string range_text(const std::string& least, const std::string& most) {
  return "must be from " + least + " to " + most;
}

}  // namespace

std::string text_of(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

WorkBuilder::WorkBuilder(std::string verb) { work_.verb = std::move(verb); }

void WorkBuilder::require(const Status& status) {
  if (status_ && !status) status_ = status;
}

void WorkBuilder::refuse(const std::string& field, const std::string& why) {
  require(invalid_field(path(field), why));
}

void WorkBuilder::flag(const std::string& name, const std::string& value) {
  work_.flags.push_back("--" + name + "=" + value);
}

void WorkBuilder::bare_flag(const std::string& name) { work_.flags.push_back("--" + name); }

void WorkBuilder::pose(std::string json) { work_.pose_json = std::move(json); }

void WorkBuilder::number(const std::string& field, const std::string& name, double value,
                         double most, double least) {
  if (!std::isfinite(value) || value <= 0 || value < least || value > most) {
    const std::string from = least > 0 ? "must be at least " : "must be above ";
    refuse(field, from + text_of(least) + " and at most " + text_of(most));
  }
  flag(name, text_of(value));
}

void WorkBuilder::length(const std::string& field, const std::string& name, double length_mm,
                         double most_mm) {
  if (!(length_mm >= 0 && length_mm <= most_mm)) refuse(field, range_text("0", text_of(most_mm)));
  flag(name, text_of(length_mm));
}

void WorkBuilder::whole(const std::string& field, const std::string& name, std::int32_t value,
                        std::int32_t least, std::int32_t most) {
  check_whole(field, value, least, most);
  flag(name, std::to_string(value));
}

void WorkBuilder::check_whole(const std::string& field, std::int32_t value, std::int32_t least,
                              std::int32_t most) {
  if (value >= least && value <= most) return;
  refuse(field, range_text(std::to_string(least), std::to_string(most)));
}

void WorkBuilder::check_numbers(const std::string& field, const std::vector<double>& numbers,
                                std::size_t count) {
  if (numbers.size() == count &&
      std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    return;
  }
  refuse(field, "must be " + std::to_string(count) + " finite numbers");
}

void WorkBuilder::text(const std::string& field, const std::string& name, const std::string& text) {
  require(check_text(path(field), text, 200));
  if (!text.empty()) flag(name, text);
}

void WorkBuilder::file(const std::string& field, const std::string& name,
                       const v1::InputFile& input) {
  require(check_file_name(path(field) + ".name", input.name()));
  const auto asset = parse_asset_name(input.asset());
  if (!asset) {
    Error error = asset.error();
    error.message = path(field) + ".asset: " + error.message;
    require(tl::unexpected(error));
    return;
  }
  work_.inputs.push_back({input.name(), *asset});
  if (!name.empty()) flag(name, input.name());
}

std::string WorkBuilder::path(const std::string& field) const {
  return kind_of(work_.verb) + "." + field;
}

Result<Work> WorkBuilder::build() {
  if (const std::string name = ambiguous_name(work_.inputs); !name.empty()) {
    require(fail(Code::kInvalidArgument,
                 kind_of(work_.verb) + ": the name \"" + name +
                     "\" stands for two files; give each file its own",
                 "NAME_INVALID"));
  }
  if (!status_) return tl::unexpected(status_.error());
  return std::move(work_);
}

}  // namespace hydroprint::daemon
