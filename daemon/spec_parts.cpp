#include "daemon/spec_parts.h"

#include <algorithm>
#include <cmath>

#include "daemon/names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostNames = 32;

using Numbers = std::vector<double>;

std::string list_of(const Numbers& numbers) {
  std::string out;
  for (const double number : numbers) out += (out.empty() ? "" : ",") + text_of(number);
  return "[" + out + "]";
}

}  // namespace

void add_pose(WorkBuilder& builder, const v1::Pose& pose) {
  const Numbers rotation{pose.rotation_wxyz().begin(), pose.rotation_wxyz().end()};
  const Numbers translation_mm{pose.translation_mm().begin(), pose.translation_mm().end()};
  builder.check_numbers("pose.rotation_wxyz", rotation, 4);
  builder.check_numbers("pose.translation_mm", translation_mm, 3);
  double square = 0;
  for (const double x : rotation) square += x * x;
  if (!(std::abs(std::sqrt(square) - 1) <= 1e-3)) {
    builder.refuse("pose.rotation_wxyz", "must have length 1");
  }
  builder.pose("{\"rotation_wxyz\":" + list_of(rotation) +
               ",\"translation_mm\":" + list_of(translation_mm) + "}");
}

void add_film(WorkBuilder& builder, const std::string& film) {
  builder.require(check_text(builder.path("film"), film, 300));
  if (film.empty()) builder.refuse("film", "is empty; leave it out");
  if (film.starts_with("polygon:")) {
    const auto& inputs = builder.inputs();
    if (std::none_of(inputs.begin(), inputs.end(),
                     [&](const InputFile& file) { return file.name == film.substr(8); })) {
      builder.refuse("film", "names a polygon that is not in extra_files");
    }
  }
  builder.flag("film", film);
}

void add_threads(WorkBuilder& builder, std::int32_t threads, NewJob& made) {
  builder.check_whole("threads", threads, 1, 256);
  made.threads = threads;
}

void add_dpi(WorkBuilder& builder, double dpi) { builder.number("dpi", "dpi", dpi, 2400, 20); }

void add_names(WorkBuilder& builder, const std::string& field,
               const std::vector<std::string>& given, char joint) {
  if (given.size() > kMostNames) {
    builder.refuse(field, "has more than 32 names");
    return;
  }
  std::string names;
  for (const std::string& name : given) {
    const bool is_name = !name.empty() && name.size() <= 64 &&
                         std::all_of(name.begin(), name.end(), [joint](char c) {
                           return (c >= 'a' && c <= 'z') || c == joint;
                         });
    if (!is_name) {
      builder.refuse(field, std::string("must be names made of a to z and ") + joint);
    }
    names += (names.empty() ? "" : ",") + name;
  }
  if (!names.empty()) builder.flag(field, names);
}

}  // namespace hydroprint::daemon
