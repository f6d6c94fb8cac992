// Fits a film profile to measured landing points.
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"

namespace hydroprint::daemon {
namespace {

class FitKind final : public KindOf<v1::FitSpec> {
 private:
  [[nodiscard]] Status check_spec(const v1::FitSpec& spec) const override {
    return check_polygon(field().name(), spec);
  }
};

}  // namespace

const JobKind& fit_kind() {
  static const FitKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
