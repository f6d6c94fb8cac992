#include "hardware/simulator/drive/faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iomanip>
#include <optional>
#include <sstream>
#include <utility>

#include "hardware/simulator/scene/codec.h"

namespace hydroprint::simulated_drive {
namespace {

using std::chrono::milliseconds;
using Words = std::vector<std::string>;

constexpr std::array<std::pair<std::string_view, ReplyFaultKind>, 10> kFaults = {{
    {"late", ReplyFaultKind::kLate},
    {"drop", ReplyFaultKind::kDrop},
    {"double", ReplyFaultKind::kDouble},
    {"overtaken", ReplyFaultKind::kOvertaken},
    {"truncate", ReplyFaultKind::kTruncate},
    {"wrong-id", ReplyFaultKind::kWrongId},
    {"wrong-function", ReplyFaultKind::kWrongFunction},
    {"wrong-crc", ReplyFaultKind::kWrongCrc},
    {"wrong-length", ReplyFaultKind::kWrongLength},
    {"busy", ReplyFaultKind::kBusy},
}};
constexpr std::array<std::pair<std::string_view, Action::Input>, 8> kInputs = {{
    {"stop", Action::Input::kStopButton},
    {"positive-end", Action::Input::kPositiveEnd},
    {"negative-end", Action::Input::kNegativeEnd},
    {"stall", Action::Input::kStall},
    {"freeze", Action::Input::kFreeze},
    {"deaf", Action::Input::kDeaf},
    {"runaway", Action::Input::kRunaway},
    {"drift", Action::Input::kDrift},
}};
constexpr std::array<std::pair<std::string_view, Action::Kind>, 8> kPlain = {{
    {"clear", Action::Kind::kClear},
    {"unplug", Action::Kind::kUnplug},
    {"replug", Action::Kind::kReplug},
    {"reboot", Action::Kind::kReboot},
    {"state", Action::Kind::kState},
    {"help", Action::Kind::kHelp},
    {"scenery", Action::Kind::kScenery},
    {"sight", Action::Kind::kSight},
}};
constexpr milliseconds kBootTime{1000};
constexpr std::int64_t kLongest_ms = 3'600'000;

template <class T, std::size_t N>
std::optional<T> look_up(const std::array<std::pair<std::string_view, T>, N>& all,
                         std::string_view name) {
  for (const auto& [word, value] : all) {
    if (word == name) return value;
  }
  return std::nullopt;
}

Words split(std::string_view text, std::string_view separators) {
  Words out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0) out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// Splits at spaces; a word in double quotes may contain spaces.
Words quoted_words(std::string_view text) {
  Words out;
  std::istringstream in{std::string(text)};
  for (std::string word; in >> std::quoted(word);) out.push_back(word);
  return out;
}

std::optional<std::int64_t> read_number(std::string_view text) {
  std::int64_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return out;
}

/// Parses "700ms" or "2s".
std::optional<milliseconds> read_duration(std::string_view text) {
  const bool in_ms = text.ends_with("ms");
  if (!in_ms && !text.ends_with("s")) return std::nullopt;
  text.remove_suffix(in_ms ? 2 : 1);
  const auto number = read_number(text);
  const std::int64_t unit = in_ms ? 1 : 1000;
  if (!number || *number < 0 || *number > kLongest_ms / unit) return std::nullopt;
  return milliseconds(*number * unit);
}

tl::unexpected<Error> refuse(std::string_view line) {
  return fail(Code::kInvalidArgument,
              fmt::format("\"{:.80}\" is not a known action. Use: {}", line, action_help()));
}

/// Parses COUNT and "writes" at words[at], if present. Returns false if they are malformed, or not
/// the last words.
bool take_count(Words words, std::size_t at, ReplyFault& reply_fault) {
  reply_fault.writes_only = words.size() > at && words.back() == "writes";
  if (reply_fault.writes_only) words.pop_back();
  if (words.size() == at) return true;
  if (words.size() > at + 1) return false;
  const auto number = words[at] == "all" ? std::optional<std::int64_t>(-1) : read_number(words[at]);
  if (!number || *number == 0 || *number < -1 || *number > 1'000'000) return false;
  reply_fault.count = static_cast<int>(*number);
  return true;
}

std::optional<Action> parse_strike(const Words& words) {
  Action out;
  out.kind = Action::Kind::kReplyFault;
  if (words == Words{"silent"} || words == Words{"silent", "writes"}) {
    out.reply_fault = {ReplyFaultKind::kDropRequest, milliseconds(0), -1, words.size() == 2};
    return out;
  }
  const auto fault = look_up(kFaults, words[0]);
  if (!fault) return std::nullopt;
  out.reply_fault.fault = *fault;
  std::size_t at = 1;
  if (*fault == ReplyFaultKind::kLate) {
    const auto delay = words.size() > 1 ? read_duration(words[1]) : std::nullopt;
    if (!delay) return std::nullopt;
    out.reply_fault.delay = *delay;
    at = 2;
  }
  if (!take_count(words, at, out.reply_fault)) return std::nullopt;
  return out;
}

std::optional<Action> parse_input(const Words& words) {
  Action out;
  out.kind = words[0] == "release" ? Action::Kind::kRelease : Action::Kind::kPress;
  const bool has_verb = words[0] == "press" || words[0] == "release";
  if (words.size() != (has_verb ? 2U : 1U)) return std::nullopt;
  const auto input = look_up(kInputs, words.back());
  if (!input || (!has_verb && *input < Action::Input::kStall)) return std::nullopt;
  out.input = *input;
  return out;
}

std::optional<Action> parse_plain(const Words& words) {
  const auto kind = look_up(kPlain, words[0]);
  if (!kind) return std::nullopt;
  Action out;
  out.kind = *kind;
  out.pause = kBootTime;
  if (words.size() == 1) return out;
  const auto pause = read_duration(words[1]);
  if (words.size() > 2 || !pause || out.kind != Action::Kind::kReboot) return std::nullopt;
  out.pause = *pause;
  return out;
}

template <class State, std::size_t N>
std::optional<State> look_up_state(const std::string_view (&words)[N], std::string_view name) {
  const auto* const found = std::find(std::begin(words), std::end(words), name);
  if (found == std::end(words)) return std::nullopt;
  return static_cast<State>(found - std::begin(words));
}

/// Parses "hang held.json", "hang held.json mug.obj", "show held.json board.obj", "show nothing".
std::optional<Action> parse_held(const Words& words) {
  Action out;
  const bool is_nothing = words == Words{"show", "nothing"};
  out.kind = words[0] == "hang" ? Action::Kind::kSetObject : Action::Kind::kShow;
  if (is_nothing) return out;
  if (words[0] != "hang" && words[0] != "show") return std::nullopt;
  if (words.size() != 3 && (words[0] != "hang" || words.size() != 2)) return std::nullopt;
  out.name = words[1];
  if (words.size() == 3) out.mesh = words[2];
  return out;
}

/// Parses "marker left pushed 3.5 -2".
std::optional<Action> parse_push(const Words& words) {
  if (words.size() != 5 || words[0] != "marker" || words[2] != "pushed") return std::nullopt;
  constexpr double kFarthest_mm = 1000;
  Action out;
  out.kind = Action::Kind::kPush;
  out.name = words[1];
  std::istringstream numbers(words[3] + " " + words[4]);
  if (!(numbers >> out.push_mm.x() >> out.push_mm.y()) || !(numbers >> std::ws).eof() ||
      !(out.push_mm.norm() <= kFarthest_mm)) {
    return std::nullopt;
  }
  return out;
}

/// Parses "camera gone", "marker left hidden".
std::optional<Action> parse_sight(const Words& words) {
  Action out;
  if (words[0] == "camera" && words.size() == 2) {
    const auto state =
        look_up_state<simulated_scene::CameraState>(simulated_scene::kCameraStates, words[1]);
    if (!state) return std::nullopt;
    out.kind = Action::Kind::kCamera;
    out.camera = *state;
    return out;
  }
  if (auto held = parse_held(words)) return held;
  if (auto push = parse_push(words)) return push;
  if (words[0] != "marker" || words.size() != 3) return std::nullopt;
  const auto state =
      look_up_state<simulated_scene::MarkerState>(simulated_scene::kMarkerStates, words[2]);
  if (!state) return std::nullopt;
  out.kind = Action::Kind::kMarker;
  out.name = words[1];
  out.marker = *state;
  return out;
}

std::optional<Action> parse_words(Words words) {
  if (words.empty()) return std::nullopt;
  if (words[0] == "fault") {
    words.erase(words.begin());
    return words.empty() ? std::nullopt : parse_strike(words);
  }
  if (auto out = parse_plain(words)) return out;
  if (auto out = parse_input(words)) return out;
  if (auto out = parse_sight(words)) return out;
  return parse_strike(words);
}

}  // namespace

std::string_view action_help() {
  return "[fault] late DURATION [COUNT|all] [writes], [fault] "
         "drop|double|overtaken|truncate|wrong-id|wrong-function|wrong-crc|"
         "wrong-length|busy [COUNT|all] [writes], silent [writes], press|release "
         "stop|positive-end|negative-end|stall|"
         "freeze|deaf|runaway|drift, stall, freeze, deaf, runaway, drift, unplug, replug, reboot "
         "[DURATION], "
         "camera gone|frozen|black|hung|well, marker NAME hidden|knocked-over|well|pushed X_MM "
         "Y_MM, hang "
         "POSE.json [MESH], show POSE.json MESH|nothing, clear, state, help "
         "(a DURATION is 700ms or 2s)";
}

Result<Action> parse_action(std::string_view line) {
  if (const auto action = parse_words(quoted_words(line))) return *action;
  return refuse(line);
}

Result<std::vector<TimedAction>> parse_timed_actions(std::string_view text) {
  std::vector<TimedAction> out;
  for (const std::string& part : split(text, ",")) {
    TimedAction timed;
    const std::size_t sign = part.find('@');
    if (sign != std::string::npos) {
      const auto at = read_duration(std::string_view(part).substr(sign + 1));
      if (!at) return refuse(part);
      timed.at = *at;
    }
    const auto action = parse_words(split(part.substr(0, sign), " \t="));
    if (!action) return refuse(part);
    timed.action = *action;
    out.push_back(timed);
  }
  return out;
}

}  // namespace hydroprint::simulated_drive
