// Predicts the colours on the object from a printed film image.
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"

namespace hydroprint::daemon {
namespace {

class PredictKind final : public KindOf<v1::PredictSpec> {
 private:
  [[nodiscard]] Status check_spec(const v1::PredictSpec& spec) const override {
    HP_RETURN_IF_ERROR(check_polygon(field().name(), spec));
    return check_inertia(field().name(), spec);
  }
};

}  // namespace

const JobKind& predict_kind() {
  static const PredictKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
