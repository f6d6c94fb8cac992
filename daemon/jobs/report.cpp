#include "daemon/jobs/report.h"

#include <algorithm>

#include "daemon/rest/json_text.h"
#include "sim/base/input_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestReport = 4 << 20;

tl::unexpected<Error> damaged(const std::string& why) {
  return fail(Code::kDataLoss, why, ErrorReason::ARTIFACT_DAMAGED);
}

}  // namespace

Result<v1::JobReport> read_report(const std::filesystem::path& artifacts, const std::string& kind) {
  v1::JobReport out;
  std::string name = kind;
  std::replace(name.begin(), name.end(), '-', '_');
  const auto* const field = v1::JobReport::descriptor()->FindFieldByName(name);
  if (field == nullptr) return out;
  const std::string file = kReport;
  const auto text = read_text_file(artifacts / file, kLargestReport);
  if (!text) {
    const bool is_large = text.error().code == Code::kOutOfRange;
    return damaged(file + (is_large ? ": larger than 4 MiB" : ": missing, or cannot be read"));
  }
  const Status read =
      rest::read_json(*text, *out.GetReflection()->MutableMessage(&out, field), file);
  if (read) return out;
  const bool is_field = !read.error().field.empty();
  return damaged((is_field ? file + ": " : "") + full_message(read.error()));
}

}  // namespace hydroprint::daemon
