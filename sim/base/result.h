#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "sim/base/error_reason.h"
#include "sim/base/warning_code.h"

namespace hydroprint {

/// Error codes, with the names and meanings of gRPC's status codes.
enum class Code {
  kCancelled,
  kInvalidArgument,
  kNotFound,
  kAlreadyExists,
  kPermissionDenied,
  kResourceExhausted,
  kFailedPrecondition,
  kAborted,
  kOutOfRange,
  kUnimplemented,
  kInternal,
  kUnavailable,
  kDataLoss,
  kUnauthenticated,  // stored as numbers: add new codes at the end
};

/// Returns gRPC's name of a code: "INVALID_ARGUMENT".
[[nodiscard]] std::string_view code_name(Code code);

/// A failure: a code for programs, and one sentence for people that names the fault, its place and
/// the remedy. A field is named apart, because each surface has its own word for it (`--dpi`,
/// `simulate.dpi`, "Resolution"); see hydroprint/v1/failure.proto.
struct Error {
  Code code = Code::kInternal;
  std::string message;
  /// For programs; see hydroprint/v1/error_reason.proto. 0 if the code says enough.
  ErrorReason reason = ErrorReason::ERROR_REASON_UNSPECIFIED;
  /// Values from the message for programs, under stable names ("max_bytes").
  std::map<std::string, std::string> metadata = {};
  /// Path of the field at fault ("simulate.dpi"), which the message does not repeat; empty: none.
  std::string field = {};
};

/// Returns the message after the field's path, for readers who know fields by their paths.
[[nodiscard]] std::string full_message(const Error& error);

/// A value or an Error. Functions report all errors this way.
template <class T>
using Result = tl::expected<T, Error>;

/// Outcome of an operation that returns no value.
using Status = Result<void>;

/// Returns an Error that converts to any Result.
[[nodiscard]] inline tl::unexpected<Error> fail(Code code, std::string message,
                                                ErrorReason reason = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), reason, {}, {}});
}

/// Returns an Error about a field. The problem does not name it.
[[nodiscard]] inline tl::unexpected<Error> fail_field(Code code, std::string field,
                                                      std::string problem,
                                                      ErrorReason reason = {}) {
  return tl::unexpected<Error>(Error{code, std::move(problem), reason, {}, std::move(field)});
}

/// Places that a warning can be about; see hydroprint/v1/warning.proto.
struct FilmPoint {
  double x_mm = 0, y_mm = 0;  ///< film frame, at first contact
  double immersion_mm = 0;    ///< at which the waterline is there
};
struct OnSurface {};  ///< the object's surface
struct AtImmersion {
  double immersion_mm = 0;
};
struct InFile {
  std::string name;
  int line = 0;  ///< from 1; 0: the whole file
};
struct InLayer {
  std::string name;  ///< layer of the paint
};
struct OnSheet {
  int number = 0;  ///< printed sheet, from 1
};
struct AtMarker {
  std::string name;
};
struct OfResource {
  std::string name;  ///< "jobs/7"
};
struct OfItem {
  std::string name;  ///< anything else: a material, "printer"
};

struct Place {
  std::variant<std::monostate, FilmPoint, OnSurface, AtImmersion, InFile, InLayer, OnSheet,
               AtMarker, OfResource, OfItem>
      place = {};
  int dip = 0;  ///< dip of a plan, from 1; 0: not about one dip
};

/// Describes a place for people: "dip 2, 12.30 mm immersion, at (-4.00, 17.50) mm"; empty for a
/// warning about the whole result.
[[nodiscard]] std::string words_of(const Place& place);

/// An assumption that was made, or something for the user to check; see
/// hydroprint/v1/warning.proto.
struct Warning {
  WarningCode code = WarningCode::CODE_UNSPECIFIED;
  std::string message;  ///< one sentence: what was found and what was assumed
  Place where = {};
};
using Warnings = std::vector<Warning>;

/// Exit statuses of all programs: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130
/// cancelled.
enum class ExitStatus { kDone = 0, kUsage = 2, kBadInput = 3, kFailed = 4, kCancelled = 130 };

/// Returns the exit status for an error.
[[nodiscard]] ExitStatus exit_status(const Error& error);

}  // namespace hydroprint

// The macros' `declaration` cannot be put in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)

/// Evaluates a Result. On error, returns it from the enclosing function; otherwise binds the value.
#define HP_CONCAT_INNER(a, b) a##b
#define HP_CONCAT(a, b) HP_CONCAT_INNER(a, b)
#define HP_ASSIGN_OR_RETURN(declaration, expression)                        \
  auto HP_CONCAT(result_, __LINE__) = (expression);                         \
  if (!HP_CONCAT(result_, __LINE__))                                        \
    return tl::unexpected(std::move(HP_CONCAT(result_, __LINE__)).error()); \
  declaration = std::move(*HP_CONCAT(result_, __LINE__))

/// Evaluates a Status (or Result whose value is not needed); on error returns it.
#define HP_RETURN_IF_ERROR(expression) \
  if (auto status_ = (expression); !status_) return tl::unexpected(std::move(status_).error())

// NOLINTEND(bugprone-macro-parentheses)
