#include "client/loop/report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hydroprint::loop {
namespace {

using Json = nlohmann::ordered_json;

struct Stage {
  CrossErrors Round::*errors;
  CrossErrors Round::*before;
  const char* name;
  const char* text;
};

constexpr std::array<Stage, 4> kStages{{
    {&Round::numerics, nullptr, "numerics", "dipped as calibrated, printed as planned"},
    {&Round::calibration, &Round::numerics, "calibration", "also at the true pose"},
    {&Round::motion, &Round::calibration, "motion", "also with the axis's actual motion"},
    {&Round::placement, &Round::motion, "placement",
     "also with film placement and printer scale: the total"},
}};

constexpr const char* kLimits =
    "Not covered: moving water; film that wrinkles, tears or slips; uneven activator; ink that "
    "bleeds; a film that swells differently from its profile; bars and markers that are not where "
    "the rig's layout has them; a camera with other errors than a first-generation Kinect. The dip "
    "is computed by the same program that made the film image, so \"numerics\" shows only how far "
    "that program agrees with itself.";

Json figures(const CrossErrors& errors) {
  const std::vector<double> mm = lengths_mm(errors);
  double sum = 0;
  for (const double x : mm) sum += x;
  return {{"cross_points", mm.size()},
          {"mean_mm", mm.empty() ? 0 : sum / static_cast<double>(mm.size())},
          {"p95_mm", quantile(mm, 0.95)},
          {"max_mm", quantile(mm, 1)}};
}

CrossErrors all_of(const Report& report) { return pooled(report.rounds, &Round::placement); }

double reached_mm(const Report& report) { return quantile(lengths_mm(all_of(report)), 0.95); }

Json truth_json(const Truth& truth) {
  return {{"held", Json::parse(pose_json(truth.X_GO))},
          {"axis_slope", {truth.slope.x(), truth.slope.y()}},
          {"film_off_mm", {truth.film_mm.x(), truth.film_mm.y()}},
          {"printer_scale", truth.printer_scale}};
}

Json round_json(const Round& round) {
  Json out{{"truth", truth_json(round.truth)},
           {"turn_off_deg", round.turn_off_deg},
           {"shift_off_mm", round.shift_off_mm},
           {"contact_off_mm", round.contact_off_mm},
           {"stated_p95_mm", round.stated_p95_mm},
           {"jobs", round.jobs},
           {"pictures", round.pictures}};
  for (const Stage& stage : kStages) out["errors"][stage.name] = figures(round.*stage.errors);
  return out;
}

/// Returns the share of the squared error in whole percent.
std::string share_text(const std::vector<Round>& rounds, const Stage& stage) {
  const double percent = 100 * share(rounds, stage.before, stage.errors);
  return fmt::format("{:.0f} %", std::round(percent) + 0.0);  // no -0
}

std::string head_row(std::initializer_list<const char*> cells) {
  return fmt::format("<tr><th>{}</th></tr>\n", fmt::join(cells, "</th><th>"));
}

std::string stage_table(const std::vector<Round>& rounds) {
  std::string out = "<table>\n" + head_row({"", "", "95th percentile, mm", "largest, mm",
                                            "share of the squared error"});
  for (const Stage& stage : kStages) {
    const auto mm = lengths_mm(pooled(rounds, stage.errors));
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{}</td></tr>\n",
                       stage.name, stage.text, quantile(mm, 0.95), quantile(mm, 1),
                       share_text(rounds, stage));
  }
  return out + "</table>\n";
}

std::string round_table(const std::vector<Round>& rounds) {
  std::string out = "<table>\n" + head_row({"pose", "orientation error, deg", "position error, mm",
                                            "first-contact error, mm", "stated (95 %), mm",
                                            "numerics", "calibration", "motion", "placement"});
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const Round& round = rounds[i];
    out += fmt::format(
        "<tr><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td>", i + 1,
        round.turn_off_deg, round.shift_off_mm, round.contact_off_mm, round.stated_p95_mm);
    for (const Stage& stage : kStages)
      out += fmt::format("<td>{:.2f}</td>", quantile(lengths_mm(round.*stage.errors), 0.95));
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string pictures(const std::vector<Round>& rounds) {
  std::string out;
  for (const Round& round : rounds) {
    for (const std::string& picture : round.pictures)
      out += fmt::format(
          "<figure><img src=\"{0}\" alt=\"{0}\"/><figcaption>{0}</figcaption></figure>\n", picture);
  }
  return out;
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>The whole loop, in "
    "silico</title><style>body{font-family:sans-serif;max-width:64em;margin:2em auto}td,th{"
    "padding:.2em .8em;text-align:left}figure{display:inline-block;margin:.5em}img{max-width:30em}"
    "</style></head><body>\n";

std::string poses_of(const Report& report) {
  return fmt::format("{} {}", report.rounds.size(), report.rounds.size() == 1 ? "pose" : "poses");
}

}  // namespace

Status verdict(const Report& report) {
  const double error_mm = reached_mm(report);
  const int lost_points = lost(all_of(report));
  if (error_mm <= report.bound_mm && lost_points == 0) return {};
  return fail(
      Code::kAborted,
      fmt::format("the print misses its limit: 95 % of the cross-points land within {:.2f} mm "
                  "(limit: {:.2f} mm), and {} miss the object. report.html shows the sources "
                  "of the error",
                  error_mm, report.bound_mm, lost_points));
}

std::string report_json(const Report& report) {
  const int lost_points = lost(all_of(report));
  Json out{{"program", "hydroprint"},         {"verb", "loop"},
           {"object", report.object},         {"seed", report.seed},
           {"camera", report.camera},         {"poses", report.rounds.size()},
           {"bound_p95_mm", report.bound_mm}, {"passed", verdict(report).has_value()},
           {"lost_cross_points", lost_points}};
  for (const Stage& stage : kStages) {
    Json& errors = out["errors"][stage.name] = figures(pooled(report.rounds, stage.errors));
    errors["share"] = share(report.rounds, stage.before, stage.errors);
  }
  for (const Round& round : report.rounds) out["rounds"].push_back(round_json(round));
  out["cannot_show"] = kLimits;
  return out.dump(1) + "\n";
}

std::string report_html(const Report& report) {
  const CrossErrors all = all_of(report);
  return fmt::format(
      "{}<h1>The whole loop, in silico: {}</h1>\n"
      "<p>{}, seed {}, camera {}: calibrated with the camera, simulated, laid out for printing and "
      "dipped on the virtual rig. A computation then dips that film image at the true pose with "
      "the actual motion. 95 % of the {} cross-points land within <b>{:.2f} mm</b> of their "
      "intended places (limit: {:.2f} mm); {} miss the object.</p>\n"
      "<p>{}</p>\n"
      "<h2>Sources of error</h2>\n{}"
      "<h2>Errors by pose</h2>\n<p>95th percentiles, mm.</p>\n{}"
      "<h2>Pictures</h2>\n{}</body></html>\n",
      kHead, report.object, poses_of(report), report.seed, report.camera, all.size(),
      reached_mm(report), report.bound_mm, lost(all), kLimits, stage_table(report.rounds),
      round_table(report.rounds), pictures(report.rounds));
}

std::string report_text(const Report& report) {
  const CrossErrors all = all_of(report);
  std::vector<std::string> shares;
  for (const Stage& stage : kStages)
    shares.push_back(fmt::format("{} {}", stage.name, share_text(report.rounds, stage)));
  return fmt::format(
      "{} of the {}: 95 % of {} cross-points land within {:.2f} mm (limit: {:.2f} mm), {} miss "
      "the object; shares of the squared error: {}\n",
      poses_of(report), report.object, all.size(), reached_mm(report), report.bound_mm, lost(all),
      fmt::join(shares, ", "));
}

}  // namespace hydroprint::loop
