#include "sim/worker/print_json.h"

#include <array>
#include <cstdio>

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

Json pixels_json(const print::Pixels& p) { return {p.x0, p.y0, p.x1, p.y1}; }

Json sheet_json(const print::Sheet& sheet) {
  return {{"column", sheet.column},
          {"row", sheet.row},
          {"size_mm", pair_of(sheet.size_mm)},
          {"low_mm", pair_of(sheet.low_mm)},
          {"window_px", pixels_json(sheet.window)},
          {"printable_px", pixels_json(sheet.printable)},
          {"marks", sheet.drawn},
          {"marks_dropped", sheet.dropped}};
}

}  // namespace

Json pair_of(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

Json page_parameters_json(const Options& options, const Json& film) {
  const print::PageSettings& page = options.print.page;
  return {{"film", film},
          {"paper_mm", pair_of(page.paper_mm)},
          {"printer_margin_mm", page.printer_margin_mm},
          {"job_name", page.job_name},
          {"date", page.date},
          {"threads", options.threads}};
}

Json print_parameters_json(const Options& options, const Json& film) {
  const print::PageSettings& page = options.print.page;
  const print::ColourSettings& colours = options.print.colours;
  Json out = page_parameters_json(options, film);
  out.update({{"bar_mm", page.bar_mm},
              {"overlap_mm", page.overlap_mm},
              {"mirror", page.mirror},
              {"marks", page.marks},
              {"icc_profile", colours.icc_profile.string()},
              {"ink_limit", colours.ink_limit}});
  return out;
}

Json placement_json(const print::Placement& placement) {
  return {{"contact_mm", pair_of(placement.contact_mm)},
          {"contact_size_mm", pair_of(placement.contact_size_mm)},
          {"contact_depth_mm", print::kFirstContact_mm}};
}

std::string placement_text(const print::Placement& placement, const std::filesystem::path& dir) {
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(),
                "first contact around x %.2f, y %.2f mm; print at 100 %%, not fitted to the page\n",
                placement.contact_mm.x(), placement.contact_mm.y());
  return dir.string() + ": placement.pdf report.json\n" + line.data();
}

Json print_json(const print::Print& print) {
  Json sheets = Json::array();
  for (const print::Sheet& sheet : print.layout.sheets) sheets.push_back(sheet_json(sheet));
  Json out = {{"dpi", print.dpi},
              {"pitch_mm", print.layout.pitch_mm},
              {"colours", print.document.cmyk ? "cmyk" : "rgb"},
              {"cut_off_mm2", print.cut_off_mm2},
              {"columns", print.layout.columns},
              {"rows", print.layout.rows},
              {"sheets", sheets}};
  if (print.document.cmyk) {
    out.update({{"most_ink", print.most_ink}, {"ink_limited_share", print.limited_share}});
  }
  return out;
}

std::string print_text(const print::Print& print, const std::vector<std::string>& artifacts,
                       const std::filesystem::path& dir) {
  std::string files;
  for (const std::string& name : artifacts) files += name + " ";
  const std::size_t sheets = print.layout.sheets.size();
  const Eigen::Vector2d& size = print.layout.sheets.front().size_mm;
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(),
                "%zu sheet%s of %g x %g mm at %g dpi; print at 100 %%, not fitted to the page\n",
                sheets, sheets > 1 ? "s" : "", size.x(), size.y(), print.dpi);
  return dir.string() + ": " + files + "report.json\n" + line.data();
}

}  // namespace hydroprint::worker
