#include "sim/worker/verbs/print_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/base/artifact_file.h"
#include "sim/film/outline.h"
#include "sim/image/io/printer_image.h"
#include "sim/print/pdf.h"
#include "sim/print/print_image.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/object.h"
#include "sim/worker/common/page.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(print.pdf: pages of the paper's size, with registration marks, rulers, an arrow and a line of text outside the film.
print.png and print.tif: only the film image, one file per sheet if there are several sheets. Print them at 100 %,
without fitting to the page. The same options give the same files, bit for bit.

Examples:
  hydroprint-worker print-image --film-image film.png --out paper
  hydroprint-worker print-image --film-image film.png --film circle:105 --job-name "mug 7" --date 2025-03-14 --out paper
  hydroprint-worker print-image --film-image film.png --icc-profile printer.icc --ink-limit 3 --formats pdf,tiff --out paper
  hydroprint-worker print-image --film-image film.png --film A3 --paper A4 --overlap-mm 15 --out paper

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

/// File formats that print-image can write.
enum class Format { kPdf, kPng, kTiff };

struct PrintImageOptions {
  std::filesystem::path film_image;
  std::string film;
  std::filesystem::path pose_file;
  Warnings pose_warnings;
  print::PrintSettings print;
  std::vector<Format> formats;  ///< empty: chosen by the colours
};

/// Reads the field `formats`; repeated names count once.
Result<std::vector<Format>> read_formats(const v1::PrintImageSpec& spec) {
  constexpr std::array kNames = {"pdf", "png", "tiff"};
  std::vector<Format> out;
  for (const std::string& name : spec.formats()) {
    const auto* const found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) {
      return fail_field(Code::kInvalidArgument, "formats",
                        "'" + name + "' is unknown. Use pdf, png or tiff");
    }
    const auto format = static_cast<Format>(found - kNames.begin());
    if (std::find(out.begin(), out.end(), format) == out.end()) out.push_back(format);
  }
  return out;
}

Result<print::PrintSettings> read_settings(const v1::PrintImageSpec& spec,
                                           const InputFolder& inputs) {
  print::PrintSettings out;
  HP_ASSIGN_OR_RETURN(out.page, page_settings(spec));
  if (spec.has_bar_mm()) out.page.bar_mm = spec.bar_mm();
  if (spec.has_overlap_mm()) out.page.overlap_mm = spec.overlap_mm();
  out.page.mirror = spec.mirror();
  out.page.marks = !spec.no_marks();
  HP_RETURN_IF_ERROR(print::check(out.page));
  out.colours.cmyk = spec.colours() == v1::COLOURS_CMYK;
  out.colours.icc_profile = inputs.path(spec.icc_profile());
  if (spec.has_ink_limit()) out.colours.ink_limit = spec.ink_limit();
  if (spec.has_dpi()) out.dpi = spec.dpi();
  return out;
}

Result<PrintImageOptions> read_options(const v1::PrintImageSpec& spec, const InputFolder& inputs) {
  PrintImageOptions out;
  HP_ASSIGN_OR_RETURN(out.film_image, inputs.required("film_image", spec.film_image()));
  HP_ASSIGN_OR_RETURN(out.film, film_of(spec, inputs));
  if (spec.has_pose()) {
    out.pose_file = inputs.pose_file();
    out.pose_warnings = pose_warnings_of(spec.pose());
  }
  HP_ASSIGN_OR_RETURN(out.print, read_settings(spec, inputs));
  HP_ASSIGN_OR_RETURN(out.formats, read_formats(spec));
  return out;
}

std::vector<Format> formats_of(const PrintImageOptions& options, bool cmyk) {
  if (!options.formats.empty()) return options.formats;
  return {Format::kPdf, cmyk ? Format::kTiff : Format::kPng};
}

/// "print.png" for a single sheet; "print-1.png" and so on for several.
std::string sheet_name(std::size_t index, std::size_t sheets, const char* extension) {
  return sheets > 1 ? fmt::format("print-{}{}", index + 1, extension)
                    : fmt::format("print{}", extension);
}

Status write_sheets(const print::Print& print, Format format, const std::filesystem::path& folder,
                    v1::RunFacts& run, const Context& context) {
  const auto& pages = print.document.pages;
  const std::string& icc = print.document.icc_profile;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    const image::PrinterImage& image = pages[i].images.front().image;
    const bool is_tiff = format == Format::kTiff;
    const std::string name = sheet_name(i, pages.size(), is_tiff ? ".tif" : ".png");
    run.add_artifacts(name);
    const std::filesystem::path path = folder / name;
    if (is_tiff) {
      HP_RETURN_IF_ERROR(image::write_tiff(path, image, print.dpi, icc));
      continue;
    }
    HP_ASSIGN_OR_RETURN(const auto file, image::encode_png(image, print.dpi, icc, context));
    HP_RETURN_IF_ERROR(image::write_artifact(path, file));
  }
  return {};
}

Status write_files(const print::Print& print, const std::vector<Format>& formats,
                   const std::filesystem::path& folder, v1::RunFacts& run, const Context& context) {
  for (std::size_t i = 0; i < formats.size(); ++i) {
    context.progress("writing", static_cast<double>(i) / static_cast<double>(formats.size() + 1));
    HP_RETURN_IF_ERROR(check_cancelled(context));
    if (formats[i] != Format::kPdf) {
      HP_RETURN_IF_ERROR(write_sheets(print, formats[i], folder, run, context));
      continue;
    }
    HP_ASSIGN_OR_RETURN(const auto file, print::encode_pdf(print.document, context));
    run.add_artifacts("print.pdf");
    HP_RETURN_IF_ERROR(image::write_artifact(folder / "print.pdf", file));
  }
  return {};
}

void add_pixels(const print::Pixels& pixels, google::protobuf::RepeatedField<std::int32_t>* field) {
  for (const int px : {pixels.x0, pixels.y0, pixels.x1, pixels.y1}) field->Add(px);
}

void set_sheet(const print::Sheet& sheet, v1::PrintImageReport::Sheet& out) {
  out.set_column(sheet.column);
  out.set_row(sheet.row);
  add_all(sheet.size_mm, out.mutable_size_mm());
  add_all(sheet.low_mm, out.mutable_low_mm());
  add_pixels(sheet.window, out.mutable_window_px());
  add_pixels(sheet.printable, out.mutable_printable_px());
  add_all(sheet.drawn, out.mutable_marks());
  add_all(sheet.dropped, out.mutable_marks_dropped());
}

void set_settings(const print::PrintSettings& settings, v1::PrintImageReport& out) {
  out.set_bar_mm(settings.page.bar_mm);
  out.set_overlap_mm(settings.page.overlap_mm);
  out.set_mirror(settings.page.mirror);
  out.set_marks(settings.page.marks);
  out.set_icc_profile(settings.colours.icc_profile.string());
  out.set_ink_limit(settings.colours.ink_limit);
}

void set_print(const print::Print& print, v1::PrintImageReport& out) {
  out.set_dpi(print.dpi);
  out.set_pitch_mm(print.layout.pitch_mm);
  out.set_colours(print.document.cmyk ? v1::COLOURS_CMYK : v1::COLOURS_RGB);
  out.set_cut_off_mm2(print.cut_off_mm2);
  out.set_columns(print.layout.columns);
  out.set_rows(print.layout.rows);
  for (const print::Sheet& sheet : print.layout.sheets) set_sheet(sheet, *out.add_sheets());
  if (!print.document.cmyk) return;
  out.set_most_ink(print.most_ink);
  out.set_ink_limited_share(print.limited_share);
}

class PrintImage final : public ReportTask<v1::PrintImageReport> {
 public:
  explicit PrintImage(PrintImageOptions options)
      : ReportTask("print-image"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.film_image.string(); }
  [[nodiscard]] std::string memory_tip() const override { return "a smaller film image"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 2}, {"reading", 20}, {"colours", 18}, {"writing", 60}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    return {{"film_image", options_.film_image},
            {"pose", options_.pose_file},
            film_file(options_.film),
            {"icc_profile", options_.print.colours.icc_profile}};
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  PrintImageOptions options_;
};

Status PrintImage::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_ASSIGN_OR_RETURN(const film::Outline outline, film::parse_outline(options_.film));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const image::RgbImage film_image,
                      print::read_film_image(options_.film_image, context));
  HP_ASSIGN_OR_RETURN(const print::Print print,
                      print::print_image(film_image, options_.film_image.string(), outline,
                                         options_.print, context));
  const std::vector<Format> formats = formats_of(options_, print.document.cmyk);
  const bool has_png = std::find(formats.begin(), formats.end(), Format::kPng) != formats.end();
  if (print.document.cmyk && has_png) {
    return fail_field(Code::kInvalidArgument, "formats",
                      "PNG does not support CMYK. Leave png out, or print in RGB");
  }
  set_page(options_.print.page, outline, *report_.mutable_page());
  set_settings(options_.print, report_);
  set_print(print, report_);
  add_warnings(options_.pose_warnings, *run.mutable_warnings());
  add_warnings(print.warnings, *run.mutable_warnings());
  HP_RETURN_IF_ERROR(folder.create());
  return write_files(print, formats, folder.partial(), run, context);
}

std::string PrintImage::summary(const std::filesystem::path& dir) const {
  const int sheets = report_.sheets_size();
  const v1::PrintImageReport::Sheet& first = report_.sheets(0);
  return fmt::format(
      "{}{} sheet{} of {:g} x {:g} mm at {:g} dpi; print at 100 %, without fitting to the page\n",
      artifacts_line(dir, report_.run()), sheets, sheets > 1 ? "s" : "", first.size_mm(0),
      first.size_mm(1), report_.dpi());
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(PrintImageOptions options,
                      read_options(static_cast<const v1::PrintImageSpec&>(spec), inputs));
  return std::make_unique<PrintImage>(std::move(options));
}

}  // namespace

Verb print_image_verb() {
  return {"print-image",   "Make printable pages of a film image, at exact scale",
          kExamples,       &v1::PrintImageSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
