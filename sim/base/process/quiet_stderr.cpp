#include "sim/base/process/quiet_stderr.h"

#include <fcntl.h>
#include <unistd.h>

namespace hydroprint::worker {

QuietStderr::QuietStderr() : own_(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (own_ < 0 || nowhere < 0) return;
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
#endif
}

QuietStderr::~QuietStderr() {
  restore();
  if (own_ >= 0) ::close(own_);
}

void QuietStderr::restore() const {
  if (own_ >= 0) ::dup2(own_, STDERR_FILENO);
}

}  // namespace hydroprint::worker
