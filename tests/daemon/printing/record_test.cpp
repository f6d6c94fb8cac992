#include "daemon/printing/record.h"

#include <gtest/gtest.h>

namespace hydroprint::daemon {
namespace {

printer::Attributes office_printer() {
  printer::Attributes out;
  out.accepts_jobs = true;
  out.formats = {"image/urf", "application/pdf"};
  out.papers = {{"iso_a4_210x297mm", {210, 297}}, {"na_letter_8.5x11in", {215.9, 279.4}}};
  out.margins_mm = {4.2, 4.2, 3, 5};
  return out;
}

std::vector<WarningCode> codes(const Warnings& warnings) {
  std::vector<WarningCode> out;
  for (const Warning& warning : warnings) out.push_back(warning.code);
  return out;
}

using Codes = std::vector<WarningCode>;

TEST(PrintRecord, SupportedPaperAndMarginsCauseNoWarning) {
  PrintPlan plan;
  plan.margin_mm = 5;
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{});
}

TEST(PrintRecord, UnlistedPaperAndMarginsCauseWarnings) {
  PrintPlan plan;
  plan.margin_mm = 5;
  plan.paper_mm = {200, 280};
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{WarningCode::PAPER_NOT_LISTED});
  plan.paper_mm = {215.9, 279.4};
  plan.margin_mm = 4;
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{WarningCode::PRINTER_MARGIN});
}

TEST(PrintRecord, IgnoredScaleCausesAWarning) {
  const Warnings warnings = warnings_of(std::vector<std::string>{"print-scaling", "media"});
  EXPECT_EQ(codes(warnings), (Codes{WarningCode::SCALE_NOT_HEEDED, WarningCode::NOT_HEEDED}));
  EXPECT_NE(warnings[0].message.find("may not print at exact scale"), std::string::npos);
}

TEST(PrintRecord, UnusablePrinterIsRefusedBeforeSending) {
  printer::Attributes there = office_printer();
  EXPECT_TRUE(check_takes_pdf(there, "ipp://there"));
  there.accepts_jobs = false;
  there.state_reasons = {"media-empty"};
  Status refused = check_takes_pdf(there, "ipp://there");
  EXPECT_EQ(refused.error().reason, ErrorReason::PRINTER_REFUSED);
  EXPECT_NE(refused.error().message.find("media-empty"), std::string::npos);
  there.formats = {"image/urf"};
  refused = check_takes_pdf(there, "ipp://there");
  EXPECT_EQ(refused.error().reason, ErrorReason::FORMAT_NOT_SUPPORTED);
}

TEST(PrintPlan, PagesComeFromTheReportAndImpossibleOnesAreRefused) {
  PrintPlan plan;
  v1::PrintImageReport report;
  report.mutable_page()->set_printer_margin_mm(3);
  EXPECT_FALSE(read_printed_pages(report, plan)) << "no sheets";
  for (int i = 0; i < 2; ++i) {
    v1::PrintImageReport::Sheet& sheet = *report.add_sheets();
    sheet.add_size_mm(297);
    sheet.add_size_mm(210);
  }
  ASSERT_TRUE(read_printed_pages(report, plan));
  EXPECT_EQ(plan.pages, 2);
  EXPECT_EQ(plan.margin_mm, 3);
  EXPECT_TRUE(plan.paper_mm == Eigen::Vector2d(210, 297)) << "the paper lies upright in the tray";
  report.mutable_sheets(0)->set_size_mm(0, 0);
  EXPECT_EQ(read_printed_pages(report, plan).error().reason, ErrorReason::STATE_FORBIDS);
  report.mutable_sheets(0)->clear_size_mm();
  EXPECT_FALSE(read_printed_pages(report, plan));
}

}  // namespace
}  // namespace hydroprint::daemon
