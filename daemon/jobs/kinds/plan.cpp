// Divides one picture among several dips of an object.
#include "daemon/jobs/kind.h"
#include "daemon/jobs/spec_fields.h"

namespace hydroprint::daemon {
namespace {

class PlanKind final : public KindOf<v1::PlanSpec> {
 private:
  [[nodiscard]] Status check_spec(const v1::PlanSpec& spec) const override {
    const std::string film = field().name() + ".film";
    HP_RETURN_IF_ERROR(check_polygon(film, spec.film(), spec.object().extra_files()));
    HP_RETURN_IF_ERROR(check_paint(field().name() + ".object", spec.object()));
    return check_inertia(film, spec.film());
  }
};

}  // namespace

const JobKind& plan_kind() {
  static const PlanKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
