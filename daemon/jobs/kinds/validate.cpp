// Repeats the paper's experiments in simulation.
#include "daemon/jobs/kind.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

class ValidateKind final : public KindOf<v1::ValidateSpec> {};

}  // namespace

const JobKind& validate_kind() {
  static const ValidateKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
