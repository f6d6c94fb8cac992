#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "proto/write_json.h"

namespace hydroprint::testing {

/// Reads a JSON file as a message. Fails the test if it has a field that the message does not
/// declare, or if the message is written differently.
template <class Message>
Message read_message(const std::filesystem::path& path) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Message out;
  const auto read = google::protobuf::util::JsonStringToMessage(text, &out);
  EXPECT_TRUE(read.ok()) << path << ": " << read.ToString();
  // The order of maps differs.
  if (read.ok()) {
    EXPECT_EQ(nlohmann::json::parse(json_file_of(out).value()), nlohmann::json::parse(text));
  }
  return out;
}

}  // namespace hydroprint::testing
