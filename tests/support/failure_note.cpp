#include "tests/support/failure_note.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <mutex>
#include <utility>
#include <vector>

namespace hydroprint::testing {
namespace {

void print(const std::function<std::string()>& text) {
  try {
    std::cerr << text() << std::flush;
  } catch (const std::exception& error) {
    std::cerr << "no state: " << error.what() << std::endl;
  }
}

/// Prints the notes that exist at the first failure of each test.
class Notes : public ::testing::EmptyTestEventListener {
 public:
  /// The only object. GoogleTest deletes it at its end.
  static Notes& instance() {
    static Notes* const notes = [] {
      auto* const made = new Notes;
      ::testing::UnitTest::GetInstance()->listeners().Append(made);
      return made;
    }();
    return *notes;
  }

  void add(const std::function<std::string()>* text) {
    const std::lock_guard lock(mutex_);
    texts_.push_back(text);
  }
  void remove(const std::function<std::string()>* text) {
    const std::lock_guard lock(mutex_);
    std::erase(texts_, text);
  }
  [[nodiscard]] bool are_printed() {
    const std::lock_guard lock(mutex_);
    return are_printed_;
  }

  void OnTestStart(const ::testing::TestInfo& /*test*/) override {
    const std::lock_guard lock(mutex_);
    are_printed_ = false;
  }
  void OnTestPartResult(const ::testing::TestPartResult& result) override {
    const std::lock_guard lock(mutex_);
    if (!result.failed() || texts_.empty() || std::exchange(are_printed_, true)) return;
    for (const auto* text : texts_) print(*text);
  }

 private:
  std::mutex mutex_;
  std::vector<const std::function<std::string()>*> texts_;
  bool are_printed_ = false;
};

}  // namespace

FailureNote::FailureNote(std::function<std::string()> text)
    : text_(std::move(text)), exceptions_(std::uncaught_exceptions()) {
  Notes::instance().add(&text_);
}

FailureNote::~FailureNote() {
  Notes::instance().remove(&text_);
  if (std::uncaught_exceptions() > exceptions_ && !Notes::instance().are_printed()) print(text_);
}

std::string last_lines(const std::string& text, int count) {
  std::size_t begin = text.size();
  for (; begin > 0; --begin) {
    if (text[begin - 1] == '\n' && begin != text.size() && --count == 0) break;
  }
  return text.substr(begin);
}

}  // namespace hydroprint::testing
