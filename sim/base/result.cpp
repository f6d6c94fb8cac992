#include "sim/base/result.h"

#include <fmt/format.h>

namespace hydroprint {
namespace {

/// Describes each kind of place.
struct Words {
  std::string operator()(std::monostate /*none*/) const { return {}; }
  std::string operator()(const FilmPoint& point) const {
    return fmt::format("{:.2f} mm immersion, at ({:.2f}, {:.2f}) mm", point.immersion_mm,
                       point.x_mm, point.y_mm);
  }
  std::string operator()(OnSurface /*all*/) const { return "surface"; }
  std::string operator()(const AtImmersion& at) const {
    return fmt::format("{:.2f} mm immersion", at.immersion_mm);
  }
  std::string operator()(const InFile& file) const {
    return file.line > 0 ? fmt::format("{}, line {}", file.name, file.line) : file.name;
  }
  std::string operator()(const InLayer& layer) const { return "layer " + layer.name; }
  std::string operator()(const OnSheet& sheet) const {
    return fmt::format("sheet {}", sheet.number);
  }
  std::string operator()(const AtMarker& marker) const { return "marker " + marker.name; }
  std::string operator()(const OfResource& resource) const { return resource.name; }
  std::string operator()(const OfItem& item) const { return item.name; }
};

}  // namespace

std::string_view code_name(Code code) {
  switch (code) {
    case Code::kCancelled:
      return "CANCELLED";
    case Code::kInvalidArgument:
      return "INVALID_ARGUMENT";
    case Code::kNotFound:
      return "NOT_FOUND";
    case Code::kAlreadyExists:
      return "ALREADY_EXISTS";
    case Code::kPermissionDenied:
      return "PERMISSION_DENIED";
    case Code::kResourceExhausted:
      return "RESOURCE_EXHAUSTED";
    case Code::kFailedPrecondition:
      return "FAILED_PRECONDITION";
    case Code::kAborted:
      return "ABORTED";
    case Code::kOutOfRange:
      return "OUT_OF_RANGE";
    case Code::kUnimplemented:
      return "UNIMPLEMENTED";
    case Code::kInternal:
      return "INTERNAL";
    case Code::kUnavailable:
      return "UNAVAILABLE";
    case Code::kDataLoss:
      return "DATA_LOSS";
    case Code::kUnauthenticated:
      return "UNAUTHENTICATED";
  }
  return "INTERNAL";
}

std::string words_of(const Place& place) {
  const std::string words = std::visit(Words{}, place.place);
  if (place.dip == 0) return words;
  return fmt::format("dip {}{}{}", place.dip, words.empty() ? "" : ", ", words);
}

std::string full_message(const Error& error) {
  return error.field.empty() ? error.message : error.field + ": " + error.message;
}

ExitStatus exit_status(const Error& error) {
  // Other lack of resources, such as a full disk, counts as bad input.
  if (error.reason == ErrorReason::MEMORY_LIMIT) return ExitStatus::kFailed;
  switch (error.code) {
    case Code::kCancelled:
      return ExitStatus::kCancelled;
    case Code::kUnimplemented:
      return ExitStatus::kUsage;
    case Code::kInternal:
    case Code::kUnavailable:
    case Code::kAborted:
      return ExitStatus::kFailed;
    default:
      return ExitStatus::kBadInput;
  }
}

}  // namespace hydroprint
