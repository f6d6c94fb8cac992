#include "daemon/auth/password.h"

#include <sodium.h>

#include <array>
#include <chrono>
#include <mutex>
#include <semaphore>

namespace hydroprint::auth {
namespace {

constexpr std::size_t kShortestPassword = 10;
constexpr std::size_t kLongestPassword = 1000;
constexpr std::chrono::seconds kPatienceWithOthers{5};

using Permits = std::counting_semaphore<2>;

tl::unexpected<Error> no_memory_for_passwords() {
  return fail(Code::kResourceExhausted,
              "not enough memory to check the password; try again later, or lower "
              "people.password_memory_mib",
              ErrorReason::MEMORY_LIMIT);
}

}  // namespace

struct Passwords::Impl {
  PasswordCost cost;
  Permits permits{2};
  std::once_flag once;
  // Hash to compare with if a user has no password, so that the check takes the same time.
  std::string nobodys;
};

namespace {

class Permit {
 public:
  explicit Permit(Permits& permits)
      : permits_(permits), granted_(permits.try_acquire_for(kPatienceWithOthers)) {}
  ~Permit() {
    if (granted_) permits_.release();
  }
  Permit(const Permit&) = delete;
  Permit& operator=(const Permit&) = delete;

  [[nodiscard]] Status status() const {
    if (granted_) return {};
    auto refused =
        fail(Code::kResourceExhausted, "too many others are signing in; try again in a few seconds",
             ErrorReason::TOO_MANY_ATTEMPTS);
    refused.value().metadata["retry_s"] = "5";
    return refused;
  }

 private:
  Permits& permits_;
  bool granted_;
};

Result<std::string> argon2id(const std::string& password, const PasswordCost& cost) {
  std::array<char, crypto_pwhash_STRBYTES> out{};
  if (crypto_pwhash_str_alg(out.data(), password.data(), password.size(),
                            static_cast<unsigned long long>(cost.passes),
                            static_cast<std::size_t>(cost.memory_kib) * 1024,
                            crypto_pwhash_ALG_ARGON2ID13) != 0) {
    return no_memory_for_passwords();
  }
  return std::string(out.data());
}

}  // namespace

Status check_password_length(const std::string& password) {
  if (password.size() >= kShortestPassword && password.size() <= kLongestPassword) return {};
  return fail_field(Code::kInvalidArgument, "password",
                    "must be 10 to 1000 bytes long; use a few words", ErrorReason::SPEC_INVALID);
}

Passwords::Passwords(const PasswordCost& cost) : impl_(std::make_unique<Impl>()) {
  impl_->cost = cost;
}
Passwords::~Passwords() = default;

Result<std::string> Passwords::hash(const std::string& password) {
  const Permit permit(impl_->permits);
  HP_RETURN_IF_ERROR(permit.status());
  return argon2id(password, impl_->cost);
}

Result<bool> Passwords::check(const std::string& password, const std::string& hashed) {
  if (password.size() > kLongestPassword) return false;
  const Permit permit(impl_->permits);
  HP_RETURN_IF_ERROR(permit.status());
  std::call_once(impl_->once, [this] {
    impl_->nobodys = argon2id("nobody has this one", impl_->cost).value_or("");
  });
  const std::string& against = hashed.empty() ? impl_->nobodys : hashed;
  // The function does not distinguish a wrong password from insufficient memory, which is rare.
  const bool equal =
      crypto_pwhash_str_verify(against.c_str(), password.data(), password.size()) == 0;
  return equal && !hashed.empty();
}

}  // namespace hydroprint::auth
