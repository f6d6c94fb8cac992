#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace hydroprint::daemon {

/// Writes metrics in the Prometheus text format 0.0.4.
class PrometheusText {
 public:
  using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// Begins a metric; its samples must follow.
  /// @param type  "gauge", "counter" or "summary"
  void begin(const std::string& name, std::string_view type, std::string_view help);
  /// @param suffix  appended to the name: "_sum"
  void sample(double value, Labels labels = {}, std::string_view suffix = "");
  /// Writes a metric with one sample.
  void single(const std::string& name, std::string_view type, std::string_view help, double value);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string name_, text_;
};

}  // namespace hydroprint::daemon
