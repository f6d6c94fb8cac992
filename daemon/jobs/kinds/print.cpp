// Sends the PDF of a print-image job to the printer.
#include "daemon/jobs/kind.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

class PrintKind final : public KindOf<v1::PrintSpec> {
 public:
  [[nodiscard]] ExecutorId executor() const override { return ExecutorId::kPrints; }
  [[nodiscard]] bool is_cacheable() const override { return false; }
  [[nodiscard]] JobTraits traits() const override {
    JobTraits out;
    out.computed = false;
    out.reads_artifacts = true;
    out.interrupted_advice =
        "the printer may already have printed this; check the tray before you print again";
    return out;
  }
  [[nodiscard]] std::string why_no_retry() const override {
    return "a print, which may already be in the printer's tray; check the tray, then create a new "
           "print job";
  }

 private:
  [[nodiscard]] Status check_spec(const v1::PrintSpec& spec) const override {
    HP_RETURN_IF_ERROR(parse_job_name(spec.print_image_job()));
    return {};
  }
};

}  // namespace

const JobKind& print_kind() {
  static const PrintKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
