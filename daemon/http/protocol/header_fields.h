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

/// Header fields in their order; names are compared without regard to case.
class HeaderFields {
 public:
  /// The one way in for what is sent: replaces what there is by that name. False, and nothing is
  /// done, if name or value could end the line (CR, LF, NUL) or the name is no token.
  bool set(std::string_view name, std::string_view value);
  /// For what was received, which may have the same name twice.
  void add(std::string name, std::string value);

  /// The first of that name.
  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const;
  [[nodiscard]] std::size_t count(std::string_view name) const;
  /// The words of a comma-separated field, which may be there several times; valid like the fields.
  [[nodiscard]] std::vector<std::string_view> words(std::string_view name) const;
  /// Whether a comma-separated field has this word.
  [[nodiscard]] bool lists(std::string_view name, std::string_view word) const;
  [[nodiscard]] const std::vector<HeaderField>& all() const { return fields_; }

 private:
  std::vector<HeaderField> fields_;
};

/// Whether two names are the same but for the case of ASCII letters.
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

/// Parts of `text` between separators, without blanks around them; empty ones are left out.
[[nodiscard]] std::vector<std::string_view> parts_of(std::string_view text, char separator);

/// Without blanks and tabs at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace hydroprint::http
