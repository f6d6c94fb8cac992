#include "sim/worker/validate_json.h"

#include "sim/validate/html.h"
#include "sim/validate/measure.h"

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

Json limit_json(const validate::Limit& limit) {
  constexpr double kNone = 1e299;
  Json out = Json::object();
  if (limit.least > -kNone) out["least"] = limit.least;
  if (limit.most < kNone) out["most"] = limit.most;
  out["why"] = limit.why;
  return out;
}

Json figure_json(const validate::Figure& f) {
  Json out = {{"name", f.name}, {"text", f.text}, {"unit", f.unit}, {"value", f.value}};
  if (f.limit) {
    out["limit"] = limit_json(*f.limit);
    out["passed"] = f.passes();
  }
  return out;
}

Json experiment_json(const validate::Experiment& e) {
  Json figures = Json::array(), tables = Json::array(), pictures = Json::array();
  for (const auto& f : e.figures) figures.push_back(figure_json(f));
  for (const auto& t : e.tables) {
    tables.push_back({{"caption", t.caption}, {"header", t.header}, {"rows", t.rows}});
  }
  for (const auto& p : e.pictures) pictures.push_back({{"file", p.file}, {"caption", p.caption}});
  return {{"name", e.name},     {"title", e.title}, {"paper", e.paper},
          {"figures", figures}, {"tables", tables}, {"pictures", pictures}};
}

}  // namespace

Json validation_parameters_json(const Options& options) {
  return {{"only", options.validate.only},
          {"quick", options.validate.quick},
          {"threads", options.threads}};
}

Json experiments_json(const validate::Report& report) {
  Json out = Json::array();
  for (const validate::Experiment& e : report.experiments) out.push_back(experiment_json(e));
  return out;
}

std::string validation_text(const validate::Report& report, const std::filesystem::path& dir) {
  std::string out = dir.string() + "/report.html: " + std::to_string(report.passed) + " of " +
                    std::to_string(report.passed + report.failed) +
                    " figures lie within their limits\n";
  for (const validate::Experiment& e : report.experiments) {
    for (const validate::Figure& f : e.figures) {
      if (f.passes()) continue;
      out += e.name + ": " + f.text + ": " + validate::text_of(f.value, 3) +
             (f.unit.empty() ? "" : " " + f.unit) + ", not " + validate::limit_text(f) + "\n";
    }
  }
  return out;
}

}  // namespace hydroprint::worker
