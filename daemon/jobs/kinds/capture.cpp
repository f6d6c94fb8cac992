// Captures depth frames with the camera above the vat.
#include "daemon/jobs/kind.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

class CaptureKind final : public KindOf<v1::CaptureSpec> {
 public:
  [[nodiscard]] auth::Role least_role() const override { return auth::Role::kOperator; }
  [[nodiscard]] ExecutorId executor() const override { return ExecutorId::kCaptures; }
  [[nodiscard]] bool is_cacheable() const override { return false; }
  [[nodiscard]] JobTraits traits() const override {
    JobTraits out;
    out.computed = false;
    return out;
  }
  [[nodiscard]] std::string why_no_retry() const override {
    return "a capture, which cannot be repeated; create a new capture";
  }
};

}  // namespace

const JobKind& capture_kind() {
  static const CaptureKind kind;
  return kind;
}

}  // namespace hydroprint::daemon
