#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::daemon {

/// Paths in the folder of one attempt to run a job.
struct RunFolder {
  std::filesystem::path root;

  [[nodiscard]] std::filesystem::path inputs() const { return root / "in"; }
  /// Returns the only folder that the worker may write to.
  [[nodiscard]] std::filesystem::path work() const { return root / "work"; }
  [[nodiscard]] std::filesystem::path out() const { return work() / "out"; }
  /// Returns the path of the job's spec. It is not in the folder of the inputs, because an input
  /// may have the same name.
  [[nodiscard]] std::filesystem::path spec() const { return work() / "spec.json"; }
};

/// Returns the name of the folder of one attempt to run a job.
[[nodiscard]] inline std::string run_name(std::int64_t job, std::int64_t attempt) {
  return std::to_string(job) + "-" + std::to_string(attempt);
}

/// Paths in the state folder.
struct Layout {
  std::filesystem::path root;

  [[nodiscard]] std::filesystem::path lock() const { return root / "lock"; }
  [[nodiscard]] std::filesystem::path database() const { return root / "hydroprint.db"; }
  [[nodiscard]] std::filesystem::path assets() const { return root / "assets"; }
  [[nodiscard]] std::filesystem::path asset(const std::string& sha256) const {
    return assets() / sha256.substr(0, 2) / sha256.substr(2);
  }
  [[nodiscard]] std::filesystem::path uploads() const { return root / "uploads"; }
  [[nodiscard]] std::filesystem::path upload(const std::string& id) const { return uploads() / id; }
  /// Folders of running jobs: their inputs, and the worker's output until it is published.
  [[nodiscard]] std::filesystem::path runs() const { return root / "runs"; }
  /// Each attempt has its own folder, so that a forgotten worker cannot disturb the next attempt.
  /// Jobs that are not computed have only one attempt.
  [[nodiscard]] RunFolder run(std::int64_t job, std::int64_t attempt = 1) const {
    return {runs() / run_name(job, attempt)};
  }
  /// Returns the folder of a resident preview worker.
  [[nodiscard]] std::filesystem::path preview(std::int64_t number) const {
    return runs() / ("preview-" + std::to_string(number));
  }
  /// Return the folder into which a restore unpacks files, and the file that marks an unfinished
  /// restore.
  [[nodiscard]] std::filesystem::path restoring() const { return root / "restoring"; }
  [[nodiscard]] std::filesystem::path unrestored() const { return root / "unrestored"; }
  /// Returns the folder of the live camera process.
  [[nodiscard]] std::filesystem::path live_camera() const { return runs() / "live-camera"; }
  /// Returns the folder for files that the database does not know; see SetAside.
  [[nodiscard]] std::filesystem::path set_aside() const { return root / "set-aside"; }
  /// Records of unfinished dips.
  [[nodiscard]] std::filesystem::path dips() const { return root / "dips"; }
  [[nodiscard]] std::filesystem::path dip(std::int64_t job) const {
    return dips() / std::to_string(job);
  }
  [[nodiscard]] std::filesystem::path artifacts() const { return root / "artifacts"; }
  [[nodiscard]] std::filesystem::path artifacts(std::int64_t job) const {
    return artifacts() / std::to_string(job);
  }
};

}  // namespace hydroprint::daemon
