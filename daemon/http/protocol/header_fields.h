#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydroprint::http {

/// A header field.
struct HeaderField {
  std::string name, value;
};

/// Header fields in the order received or set; names are case-insensitive.
class HeaderFields {
 public:
  /// Sets a field of a response, replacing fields with that name. Returns false and changes nothing
  /// if the name is not a token, or if name or value contains CR, LF or NUL.
  bool set(std::string_view name, std::string_view value);
  /// Adds a received field; names may repeat.
  void add(std::string name, std::string value);

  /// Returns the first field with this name.
  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const;
  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// Returns the elements of all comma-separated fields with this name. The views are valid as long
  /// as this object is unchanged.
  [[nodiscard]] std::vector<std::string_view> words(std::string_view name) const;
  /// Returns whether a comma-separated field contains the element `word`, ignoring case.
  [[nodiscard]] bool lists(std::string_view name, std::string_view word) const;
  [[nodiscard]] const std::vector<HeaderField>& all() const { return fields_; }

 private:
  std::vector<HeaderField> fields_;
};

/// Returns whether two names are equal, ignoring the case of ASCII letters.
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

/// Splits `text` at separators into trimmed parts; empty parts are dropped.
[[nodiscard]] std::vector<std::string_view> parts_of(std::string_view text, char separator);

/// Returns `text` without spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace hydroprint::http
