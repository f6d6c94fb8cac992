#include "sim/worker/print_image.h"

#include <algorithm>
#include <string>
#include <utility>

#include "sim/image/artifact_file.h"
#include "sim/image/printer_image.h"
#include "sim/print/pdf.h"

namespace hydroprint::worker {
namespace {

/// print.png of a single sheet, print-1.png and so on of several.
std::string sheet_name(std::size_t index, std::size_t sheets, const char* extension) {
  return "print" + (sheets > 1 ? "-" + std::to_string(index + 1) : std::string()) + extension;
}

std::vector<PrintFormat> formats_of(const Options& options, bool cmyk) {
  if (!options.formats.empty()) return options.formats;
  return {PrintFormat::kPdf, cmyk ? PrintFormat::kTiff : PrintFormat::kPng};
}

Status write_sheets(const print::Print& print, PrintFormat format,
                    const std::filesystem::path& folder, std::vector<std::string>& names,
                    const Context& context) {
  const auto& pages = print.document.pages;
  const std::string& icc = print.document.icc_profile;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    const image::PrinterImage& image = pages[i].images.front().image;
    const bool is_tiff = format == PrintFormat::kTiff;
    names.push_back(sheet_name(i, pages.size(), is_tiff ? ".tif" : ".png"));
    const std::filesystem::path path = folder / names.back();
    if (is_tiff) {
      HP_RETURN_IF_ERROR(image::write_tiff(path, image, print.dpi, icc));
      continue;
    }
    HP_ASSIGN_OR_RETURN(const auto file, image::encode_png(image, print.dpi, icc, context));
    HP_RETURN_IF_ERROR(image::write_artifact(path, file));
  }
  return {};
}

Status write_files(const print::Print& print, const std::vector<PrintFormat>& formats,
                   const std::filesystem::path& folder, std::vector<std::string>& names,
                   const Context& context) {
  for (std::size_t i = 0; i < formats.size(); ++i) {
    context.progress("writing", static_cast<double>(i) / static_cast<double>(formats.size() + 1));
    HP_RETURN_IF_ERROR(check_cancelled(context));
    if (formats[i] != PrintFormat::kPdf) {
      HP_RETURN_IF_ERROR(write_sheets(print, formats[i], folder, names, context));
      continue;
    }
    HP_ASSIGN_OR_RETURN(const auto file, print::encode_pdf(print.document, context));
    names.emplace_back("print.pdf");
    HP_RETURN_IF_ERROR(image::write_artifact(folder / names.back(), file));
  }
  return {};
}

}  // namespace

std::vector<Stage> print_image_stages() {
  return {{"inputs", 2}, {"reading", 20}, {"colours", 18}, {"writing", 60}};
}

Status run_print_image(const Options& options, OutFolder& folder, Report& report,
                       const Context& context) {
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const image::RgbImage film_image,
                      print::read_film_image(options.film_image, context));
  HP_ASSIGN_OR_RETURN(print::Print print,
                      print::print_image(film_image, options.film_image.string(), report.outline,
                                         options.print, context));
  const std::vector<PrintFormat> formats = formats_of(options, print.document.cmyk);
  const bool has_png =
      std::find(formats.begin(), formats.end(), PrintFormat::kPng) != formats.end();
  if (print.document.cmyk && has_png) {
    return fail(Code::kInvalidArgument,
                "--formats: PNG has no CMYK. Leave png out, or print in RGB");
  }
  report.warnings = print.warnings;
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_files(print, formats, folder.partial(), report.artifacts, context));
  print.document.pages.clear();
  report.print = std::move(print);
  return {};
}

}  // namespace hydroprint::worker
