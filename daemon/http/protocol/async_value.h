#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "daemon/http/protocol/socket.h"

namespace hydroprint::http {

/// A value that another thread provides and a coroutine on a connection's strand awaits.
template <class T>
class AsyncValue {
 public:
  explicit AsyncValue(std::shared_ptr<Socket> socket) : state_(std::make_shared<State>()) {
    state_->socket = std::move(socket);
  }

  /// Returns a callback that receives the value; any thread may call it.
  [[nodiscard]] std::function<void(T)> receiver() const {
    return [state = state_](T value) {
      auto kept = std::make_shared<T>(std::move(value));
      state->socket->post([state, kept] {
        state->value.emplace(std::move(*kept));
        state->socket->ring();
      });
    };
  }
  [[nodiscard]] bool is_here() const { return state_->value.has_value(); }
  /// Returns the value and clears it, so that the next value can arrive.
  [[nodiscard]] T take() {
    T value = std::move(*state_->value);
    state_->value.reset();
    return value;
  }
  /// Waits for the value; false on timeout.
  [[nodiscard]] Task<bool> wait(milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!is_here()) {
      const auto left =
          std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0) co_return false;
      co_await state_->socket->rung(left);
    }
    co_return true;
  }

 private:
  struct State {
    std::shared_ptr<Socket> socket;
    std::optional<T> value;
  };
  std::shared_ptr<State> state_;
};

}  // namespace hydroprint::http
