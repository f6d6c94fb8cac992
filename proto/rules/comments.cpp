#include "proto/rules/comments.h"

#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "proto/described.h"

namespace hydroprint::rules {
namespace {

namespace pb = google::protobuf;
using Comments = std::map<std::string, std::string>;

// Removes the space after each "//", and the line end after the last line.
std::string text_of(const std::string& leading) {
  std::string text;
  for (std::size_t begin = 0; begin < leading.size();) {
    const std::size_t end = std::min(leading.find('\n', begin), leading.size());
    const std::size_t first = begin + (leading[begin] == ' ' ? 1 : 0);
    text += (text.empty() ? "" : "\n") + leading.substr(first, end - first);
    begin = end + 1;
  }
  return text;
}

// Returns the full name of the element at a path in a FileDescriptorProto. The path alternates
// field numbers and list indices (google.protobuf.SourceCodeInfo.Location.path). Empty if the
// element has no name.
std::string name_at(const pb::FileDescriptorProto& file,
                    const pb::RepeatedField<std::int32_t>& path) {
  std::string name = file.package();
  const pb::Message* at = &file;
  for (int i = 0; i + 1 < path.size(); i += 2) {
    const auto* list = at->GetDescriptor()->FindFieldByNumber(path[i]);
    const bool is_list = list != nullptr && list->is_repeated() && list->message_type() != nullptr;
    if (!is_list) return {};
    at = &at->GetReflection()->GetRepeatedMessage(*at, list, path[i + 1]);
    const auto* named = at->GetDescriptor()->FindFieldByName("name");
    if (named == nullptr) return {};
    name += "." + at->GetReflection()->GetString(*at, named);
  }
  return path.size() % 2 == 0 ? name : std::string{};
}

Comments read_comments() {
  Comments comments;
  pb::FileDescriptorSet files;
  const std::string_view bytes = described_protos();
  if (!files.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return comments;
  for (const pb::FileDescriptorProto& file : files.file()) {
    for (const auto& location : file.source_code_info().location()) {
      if (!location.has_leading_comments()) continue;
      const std::string name = name_at(file, location.path());
      if (!name.empty()) comments[name] = text_of(location.leading_comments());
    }
  }
  return comments;
}

}  // namespace

std::string comment_on(const std::string& full_name) {
  static const Comments comments = read_comments();
  const auto found = comments.find(full_name);
  return found == comments.end() ? std::string{} : found->second;
}

std::string first_sentence(const std::string& comment) {
  std::string sentence;
  for (std::size_t i = 0; i < comment.size(); ++i) {
    const bool ends = i + 1 == comment.size() || comment[i + 1] == ' ' || comment[i + 1] == '\n';
    if ((comment[i] == '.' || comment[i] == ';') && ends) return sentence;
    sentence += comment[i] == '\n' ? ' ' : comment[i];
  }
  return sentence;
}

std::string stated_default(const std::string& comment) {
  constexpr std::string_view kStart = "Default: ";
  const std::size_t start = comment.find(kStart);
  if (start == std::string::npos) return {};
  std::string text = first_sentence(comment.substr(start + kStart.size()));
  text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
  return text;
}

}  // namespace hydroprint::rules
