#include "sim/worker/validate.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "sim/image/artifact_file.h"
#include "sim/image/image_file.h"
#include "sim/validate/html.h"

namespace hydroprint::worker {

std::vector<Stage> validation_stages(const Options& options) {
  std::vector<Stage> out;
  const auto& only = options.validate.only;
  for (const validate::ExperimentKind& kind : validate::kinds()) {
    if (only.empty() || std::find(only.begin(), only.end(), kind.name) != only.end()) {
      out.push_back({kind.name, kind.weight});
    }
  }
  out.push_back({"writing", 0.1});
  return out;
}

Status run_validate(const Options& options, OutFolder& folder, Report& report,
                    const Context& context) {
  HP_RETURN_IF_ERROR(folder.create());
  const auto write_picture = [&](const std::string& file, const image::RgbImage& picture) {
    report.artifacts.push_back(file);
    return image::write_png(folder.partial() / file, picture, image::kScreenDpi);
  };
  HP_ASSIGN_OR_RETURN(report.validation,
                      validate::validate(options.validate, write_picture, context));
  context.progress("writing", 0);
  const std::string page = validate::report_html(*report.validation, HYDROPRINT_VERSION);
  report.artifacts.emplace_back("report.html");
  return image::write_artifact(
      folder.partial() / "report.html",
      std::span(reinterpret_cast<const unsigned char*>(page.data()), page.size()));
}

}  // namespace hydroprint::worker
