#include "client/cli/format/report_text.h"

#include <iostream>

#include "client/cli/format/json.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {
namespace {

constexpr std::size_t kMostItems = 12;  // of a list that is shown

const google::protobuf::Message* content_of(const v1::JobReport& report) {
  const auto& reflection = *report.GetReflection();
  const auto* const kind = reflection.GetOneofFieldDescriptor(
      report, v1::JobReport::descriptor()->FindOneofByName("report"));
  return kind == nullptr ? nullptr : &reflection.GetMessage(report, kind);
}

bool is_flat(const Json& item) {
  if (!item.is_structured()) return true;
  for (const Json& value : item)
    if (value.is_structured()) return false;
  return true;
}

/// Returns whether a list is too long or too deep for a few lines.
bool is_bulky(const Json& value) {
  if (!value.is_array()) return false;
  return value.size() > kMostItems || (!value.empty() && !is_flat(value.front()));
}

void leave_out_bulk(Json& tree) {
  for (auto it = tree.begin(); it != tree.end();) {
    if (it->is_object()) leave_out_bulk(*it);
    it = is_bulky(*it) ? tree.erase(it) : std::next(it);
  }
}

}  // namespace

const v1::RunFacts& run_of(const v1::JobReport& report) {
  const auto* const content = content_of(report);
  if (content == nullptr) return v1::RunFacts::default_instance();
  const auto* const run = content->GetDescriptor()->FindFieldByName("run");
  return static_cast<const v1::RunFacts&>(content->GetReflection()->GetMessage(*content, run));
}

void print_report(const v1::JobReport& report) {
  for (const v1::Warning& warning : run_of(report).warnings())
    std::cout << "warning: " << hydroprint::text_of(warning) << "\n";
  const auto* const content = content_of(report);
  if (content == nullptr) return;
  Json tree = tree_of(*content);
  for (const char* key : {"run", "parameters", "mesh", "page"}) tree.erase(key);
  leave_out_bulk(tree);
  print_tree(tree);
}

}  // namespace hydroprint::cli
