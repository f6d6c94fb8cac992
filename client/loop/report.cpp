#include "client/loop/report.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

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

std::string text(double value, int digits = 2) {
  std::ostringstream out;
  out.precision(digits);
  out << std::fixed << value;
  return out.str();
}

std::string percent(double share) {
  return text(std::round(100 * share) + 0.0, 0) + " %";
}  // no -0

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string out = "<tr>";
  for (const std::string& cell : cells)
    out += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return out + "</tr>\n";
}

std::string stage_table(const std::vector<Round>& rounds) {
  std::string out =
      "<table>\n" +
      row({"", "", "95th percentile, mm", "largest, mm", "share of the squared error"}, "th");
  for (const Stage& stage : kStages) {
    const auto mm = lengths_mm(pooled(rounds, stage.errors));
    out += row({stage.name, stage.text, text(quantile(mm, 0.95)), text(quantile(mm, 1)),
                percent(share(rounds, stage.before, stage.errors))});
  }
  return out + "</table>\n";
}

std::string round_table(const std::vector<Round>& rounds) {
  std::string out = "<table>\n" + row({"pose", "orientation error, deg", "position error, mm",
                                       "first-contact error, mm", "stated (95 %), mm", "numerics",
                                       "calibration", "motion", "placement"},
                                      "th");
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const Round& round = rounds[i];
    std::vector<std::string> cells{std::to_string(i + 1), text(round.turn_off_deg),
                                   text(round.shift_off_mm), text(round.contact_off_mm),
                                   text(round.stated_p95_mm)};
    for (const Stage& stage : kStages)
      cells.push_back(text(quantile(lengths_mm(round.*stage.errors), 0.95)));
    out += row(cells);
  }
  return out + "</table>\n";
}

std::string pictures(const std::vector<Round>& rounds) {
  std::string out;
  for (const Round& round : rounds) {
    for (const std::string& picture : round.pictures)
      out += "<figure><img src=\"" + picture + "\" alt=\"" + picture + "\"/><figcaption>" +
             picture + "</figcaption></figure>\n";
  }
  return out;
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>The whole loop, in "
    "silico</title><style>body{font-family:sans-serif;max-width:64em;margin:2em auto}td,th{"
    "padding:.2em .8em;text-align:left}figure{display:inline-block;margin:.5em}img{max-width:30em}"
    "</style></head><body>\n";

std::string poses_of(const Report& report) {
  return std::to_string(report.rounds.size()) + (report.rounds.size() == 1 ? " pose" : " poses");
}

}  // namespace

std::string report_json(const Report& report) {
  const int lost_points = lost(all_of(report));
  Json out{{"program", "hydroprint"},
           {"verb", "loop"},
           {"object", report.object},
           {"seed", report.seed},
           {"camera", report.camera},
           {"poses", report.rounds.size()},
           {"bound_p95_mm", report.bound_mm},
           {"passed", reached_mm(report) <= report.bound_mm && lost_points == 0},
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
  return kHead + ("<h1>The whole loop, in silico: " + report.object) + "</h1>\n<p>" +
         poses_of(report) + ", seed " + std::to_string(report.seed) + ", camera " + report.camera +
         ": calibrated with the camera, simulated, laid out for printing and dipped on the virtual "
         "rig. A computation then dips that film image at the true pose with the actual motion. "
         "95 % of the " +
         std::to_string(all.size()) + " cross-points land within <b>" + text(reached_mm(report)) +
         " mm</b> of their intended places (limit: " + text(report.bound_mm) + " mm); " +
         std::to_string(lost(all)) + " land nowhere.</p>\n<p>" + kLimits +
         "</p>\n<h2>Sources of error</h2>\n" + stage_table(report.rounds) +
         "<h2>Errors by pose</h2>\n<p>95th percentiles, mm.</p>\n" + round_table(report.rounds) +
         "<h2>Pictures</h2>\n" + pictures(report.rounds) + "</body></html>\n";
}

std::string report_text(const Report& report) {
  const CrossErrors all = all_of(report);
  std::string out = poses_of(report) + " of the " + report.object + ": 95 % of " +
                    std::to_string(all.size()) + " cross-points land within " +
                    text(reached_mm(report)) + " mm (limit: " + text(report.bound_mm) + " mm), " +
                    std::to_string(lost(all)) + " land nowhere; shares of the squared error:";
  for (const Stage& stage : kStages)
    out += std::string(&stage == kStages.begin() ? " " : ", ") + stage.name + " " +
           percent(share(report.rounds, stage.before, stage.errors));
  return out + "\n";
}

}  // namespace hydroprint::loop
