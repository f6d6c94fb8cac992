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

std::vector<std::string> codes(const Warnings& warnings) {
  std::vector<std::string> out;
  for (const Warning& warning : warnings) out.push_back(warning.code);
  return out;
}

using Codes = std::vector<std::string>;

TEST(PrintRecord, SupportedPaperAndMarginsCauseNoWarning) {
  PrintPlan plan;
  plan.margin_mm = 5;
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{});
}

TEST(PrintRecord, UnlistedPaperAndMarginsCauseWarnings) {
  PrintPlan plan;
  plan.margin_mm = 5;
  plan.paper_mm = {200, 280};
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{"paper_not_listed"});
  plan.paper_mm = {215.9, 279.4};
  plan.margin_mm = 4;
  EXPECT_EQ(codes(warnings_of(plan, office_printer())), Codes{"printer_margin"});
}

TEST(PrintRecord, IgnoredScaleCausesAWarning) {
  const Warnings warnings = warnings_of(std::vector<std::string>{"print-scaling", "media"});
  EXPECT_EQ(codes(warnings), (Codes{"scale_not_heeded", "not_heeded"}));
  EXPECT_NE(warnings[0].message.find("may not print at exact scale"), std::string::npos);
}

TEST(PrintRecord, UnusablePrinterIsRefusedBeforeSending) {
  printer::Attributes there = office_printer();
  EXPECT_TRUE(check_takes_pdf(there, "ipp://there"));
  there.accepts_jobs = false;
  there.state_reasons = {"media-empty"};
  Status refused = check_takes_pdf(there, "ipp://there");
  EXPECT_EQ(refused.error().reason, "PRINTER_REFUSED");
  EXPECT_NE(refused.error().message.find("media-empty"), std::string::npos);
  there.formats = {"image/urf"};
  refused = check_takes_pdf(there, "ipp://there");
  EXPECT_EQ(refused.error().reason, "FORMAT_NOT_SUPPORTED");
}

TEST(PrintPlan, ReportsAreParsedAndInvalidOnesRefused) {
  PrintPlan plan;
  ASSERT_TRUE(read_printed_pages(R"({"parameters": {"printer_margin_mm": 3}, "print": {"sheets": [
                                     {"size_mm": [297, 210]}, {"size_mm": [297, 210]}]}})",
                                 plan));
  EXPECT_EQ(plan.pages, 2);
  EXPECT_EQ(plan.margin_mm, 3);
  EXPECT_TRUE(plan.paper_mm == Eigen::Vector2d(210, 297)) << "the paper lies upright in the tray";
  for (const char* report :
       {"", "[]", "{}", R"({"print": {"sheets": []}})",
        R"({"parameters": {"printer_margin_mm": 0}, "print": {"sheets": [{"size_mm": [0, 5]}]}})",
        R"({"parameters": {"printer_margin_mm": 0}, "print": {"sheets": [{"size_mm": ["a"]}]}})",
        R"({"print": {"sheets": [{"size_mm": [297, 210]}]}})"}) {
    const Status refused = read_printed_pages(report, plan);
    ASSERT_FALSE(refused) << report;
    EXPECT_EQ(refused.error().reason, "STATE_FORBIDS");
  }
}

}  // namespace
}  // namespace hydroprint::daemon
