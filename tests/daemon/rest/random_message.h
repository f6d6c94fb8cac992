#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <random>
#include <string>

namespace hydroprint::rest {

/// Creates an empty message of that type.
std::unique_ptr<google::protobuf::Message> new_message(const google::protobuf::Descriptor& type);

/// A message of that type with random fields, including those of nested messages down to `levels`.
/// Numbers are finite, enum values exist, and texts contain anything except NUL.
std::unique_ptr<google::protobuf::Message> random_message(const google::protobuf::Descriptor& type,
                                                          std::mt19937& random, int levels);

/// Sets one field to a random value, or appends to it if it is repeated.
void draw_field(google::protobuf::Message& message, const google::protobuf::FieldDescriptor& field,
                std::mt19937& random, int levels);

/// A text of characters that are special in URLs and JSON; may be empty.
std::string random_text(std::mt19937& random);

}  // namespace hydroprint::rest
