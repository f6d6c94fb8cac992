#pragma once

#include <google/protobuf/message.h>

#include <optional>
#include <string>

#include "daemon/auth/account.h"
#include "daemon/config/camera_config.h"
#include "daemon/jobs/executor.h"
#include "daemon/store/assets/asset_store.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::v1 {
class JobReport;
}

namespace hydroprint::daemon {

/// The sources from which a spec's references are resolved: earlier jobs, calibrations, the
/// configuration.
struct JobSources {
  JobStore& jobs;
  AssetStore& assets;
  CalibrationStore& calibrations;
  const CameraConfig& camera;
  Layout layout;
  RigPlace place;  ///< current state of the rig
};

/// Base class of all job kinds: the properties that distinguish one kind from the others. Each kind
/// has a file in daemon/jobs/kinds and derives from KindOf below. Objects are constant and live as
/// long as the program.
class JobKind {
 public:
  virtual ~JobKind() = default;
  JobKind(const JobKind&) = delete;
  JobKind& operator=(const JobKind&) = delete;

  /// Returns the kind's field in the oneof of hydroprint.v1.Job. Its name appears in errors
  /// ("print_image").
  [[nodiscard]] const google::protobuf::FieldDescriptor& field() const { return field_; }
  /// Returns the worker's verb, which is also the kind in logs and metrics: "print-image".
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Returns the role required to create a job of this kind.
  [[nodiscard]] virtual auth::Role least_role() const { return auth::Role::kMaker; }
  [[nodiscard]] virtual ExecutorId executor() const { return ExecutorId::kWorkers; }
  [[nodiscard]] virtual JobTraits traits() const { return {}; }
  /// Returns whether a job may reuse the artifacts of an earlier one with the same inputs.
  [[nodiscard]] virtual bool is_cacheable() const { return true; }
  /// Returns why a finished job cannot be retried, as the end of a sentence that begins with
  /// "jobs/7 is "; empty if the job can be retried.
  [[nodiscard]] virtual std::string why_no_retry() const { return {}; }

  /// Resolves the references of a spec. Both messages are initially copies of the spec as it was
  /// sent.
  /// @param shown     becomes the spec that the job shows, with default references named
  /// @param resolved  becomes the spec that is executed, without references
  [[nodiscard]] virtual Status resolve(google::protobuf::Message& shown,
                                       google::protobuf::Message& resolved,
                                       const JobSources& sources) const = 0;
  /// Makes checks that the rules of single fields cannot express: fields that depend on each other,
  /// and fields that a resolved spec must have. Errors: SPEC_INVALID, ID_INVALID.
  [[nodiscard]] virtual Status check(const google::protobuf::Message& resolved) const = 0;
  /// Returns the part of a default display name that follows the kind ("jobs/3", "mug.obj"): the
  /// earlier job that the spec refers to, otherwise its first file.
  [[nodiscard]] virtual std::string subject(const google::protobuf::Message& shown) const;
  /// Returns the calibration that a successful job produces, from its (untrusted) report.
  /// @return nullopt if the kind produces none; kInternal, WORKER_UNUSABLE
  [[nodiscard]] virtual Result<std::optional<NewCalibration>> calibration(
      const Job& job, const v1::JobReport& report) const;

 protected:
  /// @param spec  the message type of the kind's spec
  explicit JobKind(const google::protobuf::Descriptor& spec);

 private:
  const google::protobuf::FieldDescriptor& field_;
  std::string name_;
};

/// A kind with a spec of type `Spec`.
template <class Spec>
class KindOf : public JobKind {
 protected:
  KindOf() : JobKind(*Spec::descriptor()) {}
  [[nodiscard]] virtual Status resolve_spec(Spec& /*shown*/, Spec& /*resolved*/,
                                            const JobSources& /*sources*/) const {
    return {};
  }
  [[nodiscard]] virtual Status check_spec(const Spec& /*resolved*/) const { return {}; }

 private:
  [[nodiscard]] Status resolve(google::protobuf::Message& shown,
                               google::protobuf::Message& resolved,
                               const JobSources& sources) const final {
    return resolve_spec(static_cast<Spec&>(shown), static_cast<Spec&>(resolved), sources);
  }
  [[nodiscard]] Status check(const google::protobuf::Message& resolved) const final {
    return check_spec(static_cast<const Spec&>(resolved));
  }
};

}  // namespace hydroprint::daemon
