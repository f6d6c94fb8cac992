#include "daemon/tls/certificate_reloader.h"

#include <sys/stat.h>

#include <ctime>
#include <utility>

#include "daemon/platform/log.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::seconds kLookEvery{2};
constexpr std::int64_t kDay_ms = 24LL * 3600 * 1000;
constexpr std::int64_t kWarnBefore_ms = 14 * kDay_ms;

std::string expiry_text(std::int64_t unix_s) {
  const auto time = static_cast<std::time_t>(unix_s);
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::string names_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace

CertificateReloader::CertificateReloader(std::filesystem::path certificate_file,
                                         std::filesystem::path key_file, Clock clock)
    : certificate_file_(std::move(certificate_file)),
      key_file_(std::move(key_file)),
      clock_(std::move(clock)) {}

Result<std::unique_ptr<CertificateReloader>> CertificateReloader::open(
    const std::filesystem::path& certificate_file, const std::filesystem::path& key_file,
    Clock clock) {
  std::unique_ptr<CertificateReloader> reloader(
      new CertificateReloader(certificate_file, key_file, std::move(clock)));
  HP_RETURN_IF_ERROR(reloader->load());
  reloader->warn_of_expiry();
  reloader->thread_.emplace(kLookEvery, [&reloader = *reloader] {
    reloader.look_again();
    reloader.warn_of_expiry();
  });
  return reloader;
}

std::shared_ptr<const tls::Identity> CertificateReloader::current() const {
  const std::lock_guard lock(mutex_);
  return current_;
}

CertificateReloader::Stamps CertificateReloader::stamps() const {
  const auto stamp = [](const std::filesystem::path& file) -> Stamp {
    struct stat info {};
    if (::stat(file.c_str(), &info) != 0) return {};
    return std::array<std::int64_t, 5>{static_cast<std::int64_t>(info.st_dev),
                                       static_cast<std::int64_t>(info.st_ino), info.st_size,
                                       info.st_mtim.tv_sec, info.st_mtim.tv_nsec};
  };
  return {stamp(certificate_file_), stamp(key_file_)};
}

Status CertificateReloader::load() {
  const Stamps now = stamps();
  HP_ASSIGN_OR_RETURN(auto identity, tls::Identity::read(certificate_file_, key_file_));
  loaded_ = now;
  refused_.clear();
  warn_next_ms_ = 0;
  log(LogLevel::kInfo, "certificate_loaded",
      {{"file", certificate_file_.string()},
       {"names", names_text(identity->names())},
       {"expires", expiry_text(identity->expire_s())}});
  const std::lock_guard lock(mutex_);
  current_ = std::move(identity);
  return {};
}

// One file of the pair may be written before the other. An invalid pair is therefore read again
// until it is valid; each error is logged once.
void CertificateReloader::look_again() {
  if (stamps() == loaded_ && refused_.empty()) return;
  const Status done = load();
  if (done || done.error().message == refused_) return;
  refused_ = done.error().message;
  log(LogLevel::kError, "certificate_not_loaded",
      {{"message", refused_ + ". The previous certificate stays in use"}});
}

void CertificateReloader::warn_of_expiry() {
  const std::int64_t now_ms = clock_();
  const std::int64_t expire_s = current()->expire_s();
  if (now_ms < warn_next_ms_ || now_ms + kWarnBefore_ms < expire_s * 1000) return;
  warn_next_ms_ = now_ms + kDay_ms;
  const bool is_over = now_ms >= expire_s * 1000;
  log(is_over ? LogLevel::kError : LogLevel::kWarning,
      is_over ? "certificate_expired" : "certificate_expires_soon",
      {{"file", certificate_file_.string()},
       {"expires", expiry_text(expire_s)},
       {"message", is_over ? "clients reject this certificate; replace it in the same files"
                           : "replace the certificate in the same files before it expires"}});
}

}  // namespace hydroprint::daemon
