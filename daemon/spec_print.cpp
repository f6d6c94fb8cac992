// What is printed: the film image, and the template that says where things go.
#include "daemon/names.h"
#include "daemon/spec_parts.h"
#include "daemon/spec_works.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

// The paper, and what stands on it.
template <class Spec>
void add_page(WorkBuilder& builder, const Spec& spec, NewJob& made) {
  if (spec.has_paper()) {
    builder.require(check_text(builder.path("paper"), spec.paper(), 300));
    builder.flag("paper", spec.paper());
  }
  if (spec.has_printer_margin_mm()) {
    builder.length("printer_margin_mm", "printer-margin-mm", spec.printer_margin_mm(), 1000);
  }
  builder.text("job_name", "job-name", spec.job_name());
  builder.text("date", "date", spec.date());
  if (spec.has_threads()) add_threads(builder, spec.threads(), made);
}

void add_colours(WorkBuilder& builder, const v1::PrintImageSpec& spec) {
  if (spec.colours() != v1::COLOURS_UNSPECIFIED) {
    if (!v1::Colours_IsValid(spec.colours())) {
      builder.refuse("colours", "is not one of rgb, cmyk");
    }
    builder.flag("colours", spec.colours() == v1::COLOURS_CMYK ? "cmyk" : "rgb");
  }
  if (spec.has_icc_profile()) builder.file("icc_profile", "icc-profile", spec.icc_profile());
  if (spec.has_ink_limit()) builder.number("ink_limit", "ink-limit", spec.ink_limit(), 4);
}

}  // namespace

Result<Work> work_of(const v1::PrintImageSpec& spec, NewJob& made) {
  WorkBuilder builder("print-image");
  add_film_image(builder, spec);
  add_extra_files(builder, spec);
  if (spec.has_film()) add_film(builder, spec.film());
  if (spec.has_dpi()) add_dpi(builder, spec.dpi());
  add_page(builder, spec, made);
  if (spec.has_bar_mm()) builder.length("bar_mm", "bar-mm", spec.bar_mm(), 2000);
  if (spec.has_overlap_mm()) {
    builder.length("overlap_mm", "overlap-mm", spec.overlap_mm(), 100);
  }
  if (spec.mirror()) builder.bare_flag("mirror");
  if (spec.no_marks()) builder.bare_flag("no-marks");
  add_colours(builder, spec);
  add_names(builder, "formats", {spec.formats().begin(), spec.formats().end()}, '-');
  return builder.build();
}

Result<Work> work_of(const v1::TemplateSpec& spec, NewJob& made) {
  WorkBuilder builder("template");
  add_object(builder, spec);
  add_page(builder, spec, made);
  return builder.build();
}

}  // namespace hydroprint::daemon
