#include "daemon/rest/json_check.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/rest/percent.h"
#include "daemon/rest/routes.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using nlohmann::json;

using Type = pb::FieldDescriptor::CppType;

constexpr double kExactBelow = 9007199254740992;  // 2^53; smaller whole numbers are exact

enum class ValueKind { kNull, kBool, kNumber, kString, kObject, kList };

// An object or list that is still open.
struct Level {
  // Type that the object represents; null for a map or a list.
  const pb::Descriptor* message = nullptr;
  // Field of the next value, once its key has been read.
  const pb::FieldDescriptor* field = nullptr;
  bool is_list = false;
  std::size_t count = 0;            // number of list values so far
  std::string name = {};            // name of the object's next value
  std::set<std::string> seen = {};  // names read so far
};

// SAX handler that checks each token in order.
class Checker : public nlohmann::json_sax<json> {
 public:
  Checker(std::string_view text, const pb::Descriptor& root, std::string_view subject)
      : text_(text), root_(root), subject_(subject) {}

  [[nodiscard]] const Error& error() const { return error_; }

  bool null() override { return is_fit(ValueKind::kNull) && end_value(); }
  bool boolean(bool /*value*/) override { return is_fit(ValueKind::kBool) && end_value(); }
  bool number_integer(std::int64_t /*value*/) override { return number(); }
  bool number_unsigned(std::uint64_t /*value*/) override { return number(); }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON has no binary values

  bool number_float(double value, const std::string& /*text*/) override {
    const pb::FieldDescriptor* leaf = leaf_here();
    const bool is_whole = leaf != nullptr && (leaf->cpp_type() == Type::CPPTYPE_INT64 ||
                                              leaf->cpp_type() == Type::CPPTYPE_UINT64);
    if (is_whole && std::abs(value) >= kExactBelow)
      return refuse("must be in quotes, because a JSON number may lose digits");
    return number();
  }

  bool string(std::string& text) override {
    if (text.find('\0') != std::string::npos) return refuse("NUL is not allowed");
    const pb::FieldDescriptor* leaf = leaf_here();
    const bool is_real = leaf != nullptr && (leaf->cpp_type() == Type::CPPTYPE_DOUBLE ||
                                             leaf->cpp_type() == Type::CPPTYPE_FLOAT);
    if (is_real && text.find_first_not_of("0123456789+-.eE") != std::string::npos) {
      return refuse("must be a finite number");
    }
    return is_fit(ValueKind::kString) && end_value();
  }

  bool start_object(std::size_t /*size*/) override {
    if (!is_fit(ValueKind::kObject)) return false;
    Level level;
    if (levels_.empty()) {
      level.message = &root_;
    } else if (levels_.back().field->is_map()) {
      level.field = levels_.back().field->message_type()->map_value();
    } else {
      level.message = levels_.back().field->message_type();
    }
    return begin(std::move(level));
  }

  bool key(std::string& name) override {
    Level& level = levels_.back();
    level.name = plain(name);
    if (name.find('\0') != std::string::npos) return refuse("NUL is not allowed");
    if (level.message != nullptr) {
      level.field = field_called(*level.message, name);
      if (level.field == nullptr) {
        return refuse(level.message->name() + " has no such field");
      }
      name = level.field->name();
    }
    return level.seen.insert(name).second ? true : refuse("occurs twice");
  }

  bool start_array(std::size_t /*size*/) override {
    if (!is_fit(ValueKind::kList)) return false;
    Level level;
    level.field = levels_.back().field;
    level.is_list = true;
    return begin(std::move(level));
  }

  bool end_object() override { return end(); }
  bool end_array() override { return end(); }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const json::exception& exception) override {
    std::string_view what = exception.what();
    const std::size_t words = what.find(": ");
    if (words != std::string_view::npos) what.remove_prefix(words + 2);
    error_ = no_json(position == 0 ? 0 : position - 1, what);
    return false;
  }

  // Returns the error for invalid JSON at this byte offset.
  [[nodiscard]] Error no_json(std::size_t at, std::string_view what) const {
    const std::string_view before = text_.substr(0, at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;
    return {Code::kInvalidArgument,
            fmt::format("{}, line {}, column {}: not valid JSON: {}", subject_, line, column,
                        plain(what)),
            ErrorReason::JSON_INVALID,
            {}};
  }

 private:
  // Path of the current value: "job.simulate.extraFiles[2].name".
  [[nodiscard]] std::string place() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.is_list) {
        text += fmt::format("[{}]", level.count);
      } else {
        text += (text.empty() ? "" : ".") + level.name;
      }
    }
    return text;
  }

  bool refuse(const std::string& what) {
    error_.field = place();
    error_.message = error_.field.empty() ? subject_ + ": " + what : what;
    return false;
  }

  bool begin(Level level) {
    if (levels_.size() == kMostLevels) {
      return refuse(fmt::format("is nested more than {} levels deep", kMostLevels));
    }
    levels_.push_back(std::move(level));
    return true;
  }

  bool end() {
    levels_.pop_back();
    return end_value();
  }

  bool end_value() {
    if (!levels_.empty() && levels_.back().is_list) ++levels_.back().count;
    return true;
  }

  bool number() { return is_fit(ValueKind::kNumber) && end_value(); }

  // Returns the field of the next value, or its inner field if it is a wrapper; null at the top
  // level.
  [[nodiscard]] const pb::FieldDescriptor* leaf_here() const {
    if (levels_.empty()) return nullptr;
    const pb::FieldDescriptor* field = levels_.back().field;
    return is_wrapper(*field) ? field->message_type()->field(0) : field;
  }

  // Returns whether a value of this kind may come next. Protobuf later checks the ranges of numbers
  // and texts.
  bool is_fit(ValueKind kind) {
    if (levels_.empty()) return kind == ValueKind::kObject || refuse("must be an object, { }");
    const Level& level = levels_.back();
    const pb::FieldDescriptor& field = *level.field;
    const bool is_one = level.is_list || level.message == nullptr;  // one value of a list or map
    if (kind == ValueKind::kNull) return !is_one || refuse("must not be null");
    if (field.is_repeated() && !field.is_map() && !level.is_list) {
      return kind == ValueKind::kList || refuse("must be a list, [ ]");
    }
    if (kind == ValueKind::kList) return refuse("must not be a list");
    const bool is_object = field.message_type() != nullptr && !is_written_as_value(field);
    if (is_object) return kind == ValueKind::kObject || refuse("must be an object, { }");
    if (kind == ValueKind::kObject) return refuse("must not be an object");
    const bool is_bool = leaf_here()->cpp_type() == Type::CPPTYPE_BOOL;
    return is_bool == (kind == ValueKind::kBool) ||
           refuse(is_bool ? "must be true or false" : "must not be true or false");
  }

  std::string_view text_;
  const pb::Descriptor& root_;
  std::string subject_;
  std::vector<Level> levels_;
  Error error_{Code::kInvalidArgument, {}, ErrorReason::JSON_INVALID, {}};
};

}  // namespace

Status check_json(std::string_view text, const pb::Descriptor& message, std::string_view what) {
  Checker checker(text, message, what);
  // The parser would skip a byte order mark, and treat NUL as the end of the text.
  if (text.substr(0, 3) == "\xef\xbb\xbf")
    return tl::unexpected(checker.no_json(0, "byte order mark"));
  const std::size_t nul = text.find('\0');
  if (nul != std::string_view::npos) return tl::unexpected(checker.no_json(nul, "NUL"));
  if (json::sax_parse(text.begin(), text.end(), &checker)) return {};
  return tl::unexpected(checker.error());
}

}  // namespace hydroprint::rest
