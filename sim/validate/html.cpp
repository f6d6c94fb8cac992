#include "sim/validate/html.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/validate/measure.h"

namespace hydroprint::validate {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 sans-serif; color: #22262b; background: #fafaf9; max-width: 64rem;
  margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
h2 { margin-top: 3rem; border-top: 1px solid #cfd2d6; padding-top: 1.5rem; }
table { border-collapse: collapse; margin: 1rem 0; }
caption { text-align: left; font-weight: bold; padding-bottom: .3rem; }
th, td { text-align: left; vertical-align: top; padding: .25rem .9rem .25rem 0;
  border-bottom: 1px solid #dcdfe2; }
td.number { white-space: nowrap; }
.pictures { display: flex; flex-wrap: wrap; gap: 1.5rem; align-items: flex-start; }
figure { margin: 0; max-width: 100%; }
figure img { display: block; max-width: 100%; height: auto; border: 1px solid #dcdfe2; }
figure.tall img { max-height: 34rem; width: auto; }
figcaption, .source, footer { color: #5a6068; font-size: 90%; }
.passed { color: #14663a; font-weight: bold; }
.failed { color: #a3161b; font-weight: bold; }
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string element(const std::string& name, const std::string& text,
                    const std::string& attributes = {}) {
  return "<" + name + (attributes.empty() ? "" : " " + attributes) + ">" + escaped(text) + "</" +
         name + ">";
}

std::string number(double value) {
  const double size = std::abs(value);
  return text_of(value, size < 0.1 ? 4 : size < 10 ? 3 : 1);
}

/// Returns a limit without trailing zeros.
std::string bound(double value) {
  std::string text = text_of(value, 4);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

std::string verdict(const Figure& figure) {
  if (!figure.limit) return "<td></td>";
  return figure.passes() ? element("td", "passed", "class=\"passed\"")
                         : element("td", "failed", "class=\"failed\"");
}

std::string figures_html(const Experiment& experiment) {
  if (experiment.figures.empty()) return {};
  std::string out = "<table>\n<caption>Figures</caption>\n<thead><tr>";
  for (const char* head : {"figure", "value", "limit", "verdict"}) out += element("th", head);
  out += "</tr></thead>\n<tbody>\n";
  for (const Figure& f : experiment.figures) {
    out += "<tr>" + element("td", f.text) +
           element("td", with_unit(number(f.value), f.unit), "class=\"number\"") + "<td>";
    if (f.limit) {
      out += escaped(limit_text(f)) + "<br/>" + element("span", f.limit->why, "class=\"source\"");
    }
    out += "</td>" + verdict(f) + "</tr>\n";
  }
  return out + "</tbody>\n</table>\n";
}

std::string table_html(const Table& table) {
  std::string out = "<table>\n" + element("caption", table.caption) + "\n<thead><tr>";
  for (const std::string& cell : table.header) out += element("th", cell);
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += element("td", cell);
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table>\n";
}

std::string pictures_html(const Experiment& experiment) {
  if (experiment.pictures.empty()) return {};
  std::string out = "<div class=\"pictures\">\n";
  for (const Picture& p : experiment.pictures) {
    out += p.height > p.width ? "<figure class=\"tall\">" : "<figure>";
    out += fmt::format(
        "<a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" width=\"{2}\" "
        "height=\"{3}\"/></a>{4}</figure>\n",
        escaped(p.file), escaped(p.caption), p.width, p.height, element("figcaption", p.caption));
  }
  return out + "</div>\n";
}

std::string experiment_html(const Experiment& experiment) {
  std::string out = "<section id=\"" + escaped(experiment.name) + "\">\n" +
                    element("h2", experiment.title) + "\n" +
                    element("p", "Paper: " + experiment.paper, "class=\"source\"") + "\n";
  for (const std::string& paragraph : experiment.text) out += element("p", paragraph) + "\n";
  out += figures_html(experiment);
  for (const Table& table : experiment.tables) out += table_html(table);
  return out + pictures_html(experiment) + "</section>\n";
}

std::string head_html(const Report& report) {
  std::string out = element("h1", "Hydroprint: the paper's experiments in silico") + "\n";
  out +=
      element("p",
              "The experiments of section 7 of Computational Hydrographic Printing (Zhang, Yin, "
              "Zheng, Zhou 2015), without film, water or an object. A finer computation stands for "
              "the physical experiment. A film image is computed at the usual settings. Its "
              "landing is then computed with a finer film mesh and finer steps, with random "
              "errors, with another model or with other ink.") +
      "\n";
  out +=
      element("p",
              "This shows the error of the computation within its own model, and the effect of the "
              "varied quantities in that model. It cannot show whether the model is right. The "
              "model does not cover how real film softens, swells, stretches, wrinkles and tears; "
              "the amount and time of the activator; trapped air, currents, waves and drag of the "
              "water; bleeding and fading of ink; or errors of the printer, the scanner, the "
              "gripper and the person who lays the film. Only dipping real objects shows these.") +
      "\n";
  if (report.options.quick) {
    out += element("p",
                   "This was a quick run. All lengths of the film meshes and of the steps in depth "
                   "were 2.5 times the usual ones. So it checks that everything works, but not how "
                   "accurate it is.") +
           "\n";
  }
  out += element("p",
                 fmt::format("{} of the {} figures that have a limit are within it.", report.passed,
                             report.passed + report.failed),
                 report.failed == 0 ? "class=\"passed\"" : "class=\"failed\"") +
         "\n<ul>\n";
  for (const Experiment& e : report.experiments) {
    out += "<li>" + element("a", e.title, "href=\"#" + escaped(e.name) + "\"") + "</li>\n";
  }
  return out + "</ul>\n";
}

}  // namespace

std::string limit_text(const Figure& figure) {
  if (!figure.limit) return {};
  const auto [least, most, why] = *figure.limit;
  const bool has_least = least > -1e299 && (least != 0 || figure.unit.empty());
  const bool has_most = most < 1e299;
  if (least == most) return with_unit(bound(least), figure.unit);
  if (has_least && has_most && least != 0) {
    return with_unit(bound(least) + " to " + bound(most), figure.unit);
  }
  if (has_most) return "at most " + with_unit(bound(most), figure.unit);
  return "at least " + with_unit(bound(least), figure.unit);
}

std::string report_html(const Report& report, const std::string& version) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>Hydroprint: the paper's experiments in silico</title>\n<style>";
  out += kStyle;
  out += "</style>\n</head>\n<body>\n" + head_html(report);
  for (const Experiment& experiment : report.experiments) out += experiment_html(experiment);
  return out +
         element("footer",
                 "hydroprint-worker " + version + " validate. All figures are in report.json.") +
         "\n</body>\n</html>\n";
}

}  // namespace hydroprint::validate
