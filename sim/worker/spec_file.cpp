#include "sim/worker/spec_file.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/input_file.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

Result<std::string> read_stdin() {
  std::string text;
  std::array<char, 1 << 16> chunk{};
  for (;;) {
    const ssize_t got = ::read(STDIN_FILENO, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(Code::kDataLoss, std::string("stdin: ") + std::strerror(errno));
    if (got == 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(got));
    if (text.size() > kMaxBytes)
      return fail(Code::kOutOfRange, "stdin: larger than 16 MiB. Use a smaller spec");
  }
}

Status parse(const std::string& json, const std::filesystem::path& file, Message& spec) {
  // Keeps protobuf from logging the parse error, which is returned below.
  const google::protobuf::LogSilencer silencer;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &spec);
  if (status.ok()) return {};
  return fail(Code::kInvalidArgument, file.string() + ": not a valid " +
                                          spec.GetDescriptor()->name() + ": " +
                                          std::string(status.message()));
}

Status check_file(const std::string& field, const v1::InputFile& file,
                  const std::filesystem::path& inputs) {
  if (file.name().empty())
    return fail_field(Code::kInvalidArgument, field + ".name", "missing. Name a file");
  const auto opened = open_input_file(inputs / file.name());
  if (!opened) return fail_field(opened.error().code, field, opened.error().message);
  return {};
}

Status check(const Message& spec, const std::filesystem::path& inputs, const std::string& path);

Status check_value(const Message& value, const std::string& place,
                   const std::filesystem::path& inputs) {
  if (value.GetDescriptor() == v1::InputFile::descriptor())
    return check_file(place, static_cast<const v1::InputFile&>(value), inputs);
  return check(value, inputs, place + ".");
}

Status check_values(const Message& spec, const FieldDescriptor& field, const std::string& place,
                    const std::filesystem::path& inputs) {
  const auto& reflection = *spec.GetReflection();
  if (!field.is_repeated()) return check_value(reflection.GetMessage(spec, &field), place, inputs);
  for (int i = 0; i < reflection.FieldSize(spec, &field); ++i) {
    HP_RETURN_IF_ERROR(check_value(reflection.GetRepeatedMessage(spec, &field, i),
                                   fmt::format("{}[{}]", place, i), inputs));
  }
  return {};
}

/// Checks the files of a message, and that it has no references.
/// @param path  of the message in the spec, with a dot at its end; empty for the spec
Status check(const Message& spec, const std::filesystem::path& inputs, const std::string& path) {
  std::vector<const FieldDescriptor*> fields;
  spec.GetReflection()->ListFields(spec, &fields);
  for (const FieldDescriptor* field : fields) {
    const std::string place = path + field->name();
    if (is_reference(*field)) {
      return fail_field(Code::kInvalidArgument, place,
                        "only a daemon can resolve this reference. Use files and values instead");
    }
    if (field->message_type() != nullptr)
      HP_RETURN_IF_ERROR(check_values(spec, *field, place, inputs));
  }
  return {};
}

}  // namespace

Status read_spec(const std::filesystem::path& file, const std::filesystem::path& inputs,
                 Message& spec) {
  HP_ASSIGN_OR_RETURN(const std::string text,
                      file == "-" ? read_stdin() : read_text_file(file, kMaxBytes));
  HP_RETURN_IF_ERROR(parse(text, file, spec));
  return check(spec, inputs, "");
}

}  // namespace hydroprint::worker
