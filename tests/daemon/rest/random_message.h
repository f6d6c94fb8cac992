#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <random>
#include <string>

namespace hydroprint::rest {

/// An empty message of that type.
std::unique_ptr<google::protobuf::Message> new_message(const google::protobuf::Descriptor& type);

/// A message of that type whose fields were drawn, and those of the messages in it down to
/// `levels`; finite numbers, enum values that exist, texts with anything in them but NUL.
std::unique_ptr<google::protobuf::Message> random_message(const google::protobuf::Descriptor& type,
                                                          std::mt19937& random, int levels);

/// Sets one field so, or adds to it if it is repeated.
void draw_field(google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field,
                std::mt19937& random, int levels);

/// A text of what URLs and JSON have their own mind about; may be empty.
std::string random_text(std::mt19937& random);

}  // namespace hydroprint::rest
