#include <algorithm>

#include "sim/worker/flags.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kPrintImageExamples =
    R"(Files: print.pdf, pages of the paper's size with registration marks, rulers, an arrow and a line of text wherever
no film is; print.png and print.tif, the film image (of each sheet, where it takes several) alone. Print them at 100 %,
without fitting to the page. The same options give the same files, bit for bit.

Examples:
  hydroprint-worker print-image --film-image film.png --out paper
  hydroprint-worker print-image --film-image film.png --film circle:105 --job-name "mug 7" --date 2025-03-14 --out paper
  hydroprint-worker print-image --film-image film.png --icc-profile printer.icc --ink-limit 3 --formats pdf,tiff --out paper
  hydroprint-worker print-image --film-image film.png --film A3 --paper A4 --overlap-mm 15 --out paper

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr const char* kTemplateExamples =
    R"(placement.pdf: the film's edge and axes, what of the object the water meets first and the silhouette of all of it,
seen from above at exact scale; and a page with pictures of the orientation. For a rig without a camera: print it at
100 %, lay it where the film will float, and bring the object over it.

Example:
  hydroprint-worker template --mesh mug.obj --scale 10 --pose pose.json --job-name "mug 7" --out placement

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

/// The paper, and what stands on it.
void add_page(CLI::App& app, Typed& typed) {
  print::PageSettings& page = typed.options.print.page;
  app.add_option("--paper", typed.paper, "A4, A3, letter or WxH (mm)")
      ->capture_default_str()
      ->type_name("PAPER");
  app.add_option("--printer-margin-mm", page.printer_margin_mm,
                 "What the printer cannot print along the edges of the paper")
      ->capture_default_str();
  app.add_option("--job-name", page.job_name, "Printed beside the film")->type_name("TEXT");
  app.add_option("--date", page.date, "Printed beside the film, as given")->type_name("TEXT");
}

void add_print_image(CLI::App& app, Typed& typed) {
  Options& o = typed.options;
  print::PageSettings& page = o.print.page;
  add_run(app, o);
  add_path(app, "--film-image", o.film_image, "The film image: film.png of simulate")->required();
  add_film(app, o);
  app.add_option("--dpi", o.print.dpi,
                 "Resolution of the film image; default: the whole number that its size means")
      ->type_name("FLOAT");
  add_page(app, typed);
  app.add_option("--bar-mm", page.bar_mm,
                 "Length of the sliding bars that hold the film, for marks at their ends; 0: at "
                 "their middles alone")
      ->capture_default_str();
  app.add_option("--overlap-mm", page.overlap_mm,
                 "What neighbouring sheets have in common where the film takes several")
      ->capture_default_str();
  app.add_flag("--mirror", page.mirror,
               "Print it mirrored; else it is seen from above, ink side up");
  app.add_flag("!--no-marks", page.marks, "Nothing but the film image");
  app.add_option("--colours", typed.colours, "rgb: sRGB; cmyk: plain CMYK")
      ->capture_default_str()
      ->check(CLI::IsMember({"rgb", "cmyk"}));
  add_path(app, "--icc-profile", o.print.colours.icc_profile,
           "The printer's ICC output profile, CMYK or RGB, in place of --colours", "FILE.icc");
  app.add_option("--ink-limit", o.print.colours.ink_limit,
                 "Most C + M + Y + K of a pixel; for CMYK alone")
      ->capture_default_str();
  app.add_option("--formats", typed.formats,
                 "pdf, png, tiff; default: pdf, and png for RGB or tiff for CMYK")
      ->delimiter(',')
      ->type_name("FORMAT[,FORMAT]");
}

void add_template(CLI::App& app, Typed& typed) {
  add_run(app, typed.options);
  add_object(app, typed.options);
  add_film(app, typed.options);
  add_page(app, typed);
}

}  // namespace

void add_print_verbs(CLI::App& program, Typed& typed) {
  add_print_image(add_verb(program, typed, Verb::kPrintImage, "print-image",
                           "From a film image to the files to print, at exact scale on paper",
                           kPrintImageExamples),
                  typed);
  add_template(add_verb(program, typed, Verb::kTemplate, "template",
                        "A page that shows where the object belongs, for a rig without a camera",
                        kTemplateExamples),
               typed);
}

Status settle_print(Typed& typed) {
  Options& o = typed.options;
  if (o.verb == Verb::kPrintImage && o.film_image.empty()) {
    return fail(Code::kInvalidArgument, "--film-image: empty. Name a file");
  }
  o.print.colours.cmyk = typed.colours == "cmyk";
  const std::vector<std::string> names = {"pdf", "png", "tiff"};
  for (const std::string& name : typed.formats) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      return fail(Code::kInvalidArgument,
                  "--formats: '" + name + "' is unknown. Use pdf, png or tiff");
    }
    const auto format = static_cast<PrintFormat>(found - names.begin());
    if (std::find(o.formats.begin(), o.formats.end(), format) == o.formats.end()) {
      o.formats.push_back(format);
    }
  }
  HP_ASSIGN_OR_RETURN(o.print.page.paper_mm, print::parse_paper(typed.paper));
  return print::check(o.print.page);
}

}  // namespace hydroprint::worker
