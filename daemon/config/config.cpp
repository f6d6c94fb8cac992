#include "daemon/config/config.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <variant>

#include "daemon/config/camera_config.h"
#include "daemon/config/printer_config.h"
#include "daemon/config/slurm_config.h"
#include "hardware/drive/transaction.h"

namespace hydroprint::daemon {
namespace {

struct Text {
  std::string Config::*member;
  std::vector<std::string_view> allowed = {};  // empty: anything without control characters
};
struct Flag {
  bool Config::*member;
};
struct Real {
  double rig::RigConfig::*member;
  double min, max;
};
struct Length {
  double Config::*member;
  double min, max;
};
struct Number {
  std::int64_t Config::*member;
  std::int64_t min, max;
  const char* unit;
};

struct Key {
  std::string_view section, name;
  std::variant<Text, Flag, Number, Real, Length> kind;

  [[nodiscard]] std::string full() const { return fmt::format("{}.{}", section, name); }
};

std::vector<Key> make_keys() {
  std::vector<Key> all{
      {"server", "grpc", Text{&Config::server_grpc}},
      {"server", "reflection", Flag{&Config::server_reflection}},
      {"server", "http", Text{&Config::server_http}},
      {"server", "host_names", Text{&Config::server_host_names}},
      {"server", "tls_certificate", Text{&Config::server_tls_certificate}},
      {"server", "tls_key", Text{&Config::server_tls_key}},
      {"server", "web_dir", Text{&Config::server_web_dir}},
      {"store", "state_dir", Text{&Config::store_state_dir}},
      {"store", "keep_finished_days", Number{&Config::store_keep_finished_days, 0, 36500, "days"}},
      {"store", "keep_dips_days", Number{&Config::store_keep_dips_days, 0, 36500, "days"}},
      {"store", "max_mib_per_owner", Number{&Config::store_max_mib_per_owner, 0, 1 << 30, "MiB"}},
      {"store", "min_free_mib", Number{&Config::store_min_free_mib, 1, 1 << 30, "MiB"}},
      {"assets", "max_mib", Number{&Config::assets_max_mib, 1, 1 << 20, "MiB"}},
      {"assets", "max_open_uploads", Number{&Config::assets_max_open_uploads, 1, 10000, "uploads"}},
      {"assets", "upload_expires_h", Number{&Config::assets_upload_expires_h, 1, 8760, "hours"}},
      {"assets", "keep_unused_days", Number{&Config::assets_keep_unused_days, 0, 36500, "days"}},
      {"queue", "max_jobs", Number{&Config::queue_max_jobs, 1, 100000, "jobs"}},
      {"queue", "max_jobs_per_owner", Number{&Config::queue_max_jobs_per_owner, 0, 100000, "jobs"}},
      {"workers", "program", Text{&Config::workers_program}},
      {"workers", "count", Number{&Config::workers_count, 0, 256, "workers"}},
      {"workers", "threads", Number{&Config::workers_threads, 0, 256, "threads"}},
      {"workers", "memory_mib", Number{&Config::workers_memory_mib, 0, 1 << 24, "MiB"}},
      {"workers", "time_limit_s", Number{&Config::workers_time_limit_s, 1, 2592000, "seconds"}},
      {"workers", "file_mib", Number{&Config::workers_file_mib, 1, 1 << 24, "MiB"}},
      {"workers", "allow_without_landlock", Flag{&Config::workers_allow_without_landlock}},
      {"workers", "executor", Text{&Config::workers_executor, {"local", "slurm"}}},
      {"workers.slurm", "folder", Text{&Config::slurm_folder}},
      {"workers.slurm", "installation", Text{&Config::slurm_installation}},
      {"workers.slurm", "partition", Text{&Config::slurm_partition}},
      {"workers.slurm", "account", Text{&Config::slurm_account}},
      {"workers.slurm", "options", Text{&Config::slurm_options}},
      {"workers.slurm", "jobs", Number{&Config::slurm_jobs, 1, 10000, "jobs"}},
      {"rig", "drive", Text{&Config::rig_drive}},
      {"rig", "profile", Text{&Config::rig_profile}},
  };
  for (const rig::RigConfigKey& key : rig::rig_config_keys()) {
    all.push_back({"rig", key.name, Real{key.member, key.least, key.most}});
  }
  all.push_back({"printer", "address", Text{&Config::printer_address}});
  all.push_back({"printer", "patience_s", Number{&Config::printer_patience_s, 1, 3600, "seconds"}});
  all.push_back(
      {"printer", "time_limit_s", Number{&Config::printer_time_limit_s, 1, 86400, "seconds"}});
  all.push_back({"camera", "device", Text{&Config::camera_device}});
  all.push_back({"camera", "program", Text{&Config::camera_program}});
  all.push_back({"camera", "patience_s", Number{&Config::camera_patience_s, 1, 600, "seconds"}});
  all.push_back({"camera", "layout", Text{&Config::camera_layout}});
  all.push_back({"camera", "gripper_water_mm", Length{&Config::camera_gripper_water_mm, 0, 1e4}});
  all.push_back(
      {"people", "accounts", Text{&Config::people_accounts, {"loopback-open", "required"}}});
  all.push_back({"people", "password_memory_mib",
                 Number{&Config::people_password_memory_mib, 1, 4096, "MiB"}});
  all.push_back(
      {"people", "password_passes", Number{&Config::people_password_passes, 1, 100, "passes"}});
  all.push_back(
      {"people", "session_idle_h", Number{&Config::people_session_idle_h, 1, 8760, "hours"}});
  all.push_back({"people", "session_days", Number{&Config::people_session_days, 1, 365, "days"}});
  all.push_back({"log", "level", Text{&Config::log_level, {"debug", "info", "warning", "error"}}});
  all.push_back({"log", "file", Text{&Config::log_file}});
  return all;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = make_keys();
  return all;
}

std::string remedy(const Number& number) {
  return fmt::format("a whole number of {} from {} to {}, without quotes or unit", number.unit,
                     number.min, number.max);
}
std::string number_remedy(double min, double max) {
  return fmt::format("a number from {:g} to {:g}, without quotes or unit", min, max);
}
std::string remedy(const Real& real) { return number_remedy(real.min, real.max); }
std::string remedy(const Length& length) { return number_remedy(length.min, length.max); }
std::string remedy(const Flag&) { return "true or false"; }
std::string remedy(const Text& text) {
  if (text.allowed.empty()) return "text in quotes";
  return fmt::format("one of \"{}\"", fmt::join(text.allowed, "\", \""));
}
std::string remedy(const Key& key) {
  return std::visit([](const auto& kind) { return remedy(kind); }, key.kind);
}

bool accept(const Number& kind, const toml::node& node, Config& config) {
  const auto* number = node.as_integer();
  if (number == nullptr || number->get() < kind.min || number->get() > kind.max) return false;
  config.*kind.member = number->get();
  return true;
}
bool accept(const Real& kind, const toml::node& node, Config& config) {
  const auto number = node.value<double>();  // whole numbers as well
  if (!node.is_number() || !(*number >= kind.min && *number <= kind.max)) return false;
  config.rig.*kind.member = *number;
  return true;
}
bool accept(const Length& kind, const toml::node& node, Config& config) {
  const auto number = node.value<double>();
  if (!node.is_number() || !(*number >= kind.min && *number <= kind.max)) return false;
  config.*kind.member = *number;
  return true;
}
bool accept(const Flag& kind, const toml::node& node, Config& config) {
  const auto* flag = node.as_boolean();
  if (flag == nullptr) return false;
  config.*kind.member = flag->get();
  return true;
}
bool accept(const Text& kind, const toml::node& node, Config& config) {
  const auto* text = node.as_string();
  if (text == nullptr) return false;
  const std::string& value = text->get();
  const auto& allowed = kind.allowed;
  if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    return false;
  }
  if (std::any_of(value.begin(), value.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
    return false;
  config.*kind.member = value;
  return true;
}

// Returns an error with its position in the file: "name:line: ...".
tl::unexpected<Error> refuse(const std::string& name, const toml::source_region& where,
                             const std::string& what) {
  return fail(Code::kInvalidArgument, fmt::format("{}:{}: {}", name, where.begin.line, what),
              ErrorReason::CONFIG_INVALID);
}

std::size_t common_prefix(std::string_view a, std::string_view b) {
  const auto ends = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(ends.first - a.begin());
}

// Suggests the key with the longest common prefix in the same section.
std::string suggestion(std::string_view section, std::string_view name) {
  const Key* best = nullptr;
  std::size_t length = 2;
  for (const Key& key : keys()) {
    if (key.section != section || common_prefix(key.name, name) <= length) continue;
    best = &key;
    length = common_prefix(key.name, name);
  }
  if (best != nullptr) {
    return fmt::format("did you mean \"{}\", {}?", best->full(), remedy(*best));
  }
  return "see deploy/hydroprintd.toml.example for all keys";
}

bool is_section(std::string_view name) {
  return std::any_of(keys().begin(), keys().end(),
                     [name](const Key& key) { return key.section == name; });
}

Status read_section(const std::string& name, std::string_view section, const toml::table& table,
                    Config& config) {
  for (const auto& entry : table) {
    const toml::key& toml_key = entry.first;
    const toml::node& node = entry.second;
    const std::string_view key_name = toml_key.str();
    const std::string inner = fmt::format("{}.{}", section, key_name);
    if (node.is_table() && is_section(inner)) {
      HP_RETURN_IF_ERROR(read_section(name, inner, *node.as_table(), config));
      continue;
    }
    const auto key = std::find_if(keys().begin(), keys().end(), [&](const Key& k) {
      return k.section == section && k.name == key_name;
    });
    if (key == keys().end()) {
      return refuse(name, toml_key.source(),
                    fmt::format("unknown key \"{}.{}\"; {}", section, key_name,
                                suggestion(section, key_name)));
    }
    const bool good =
        std::visit([&](const auto& kind) { return accept(kind, node, config); }, key->kind);
    if (!good) {
      return refuse(name, toml_key.source(),
                    fmt::format("{} must be {}", key->full(), remedy(*key)));
    }
  }
  return {};
}

Status check_values(const Config& config, const std::string& name, const toml::table& root) {
  for (const auto& [key, address] :
       {std::pair("grpc", config.server_grpc), std::pair("http", config.server_http)}) {
    if (const auto endpoint = parse_endpoint(address); !endpoint) {
      return refuse(name, root["server"][key].node()->source(),
                    fmt::format("server.{}: {}", key, endpoint.error().message));
    }
  }
  if (const auto printer = read_printer_setup(config); !printer) {
    return refuse(name, root["printer"]["address"].node()->source(), printer.error().message);
  }
  if (const auto camera = read_camera_setup(config); !camera) {
    return refuse(name, root["camera"]["layout"].node()->source(), camera.error().message);
  }
  if (const auto slurm = check_slurm(config); !slurm) {
    return refuse(name, root["workers"].node()->source(), slurm.error().message);
  }
  if (config.rig_drive.empty()) return {};
  if (const auto endpoint = drive::parse_endpoint(config.rig_drive); !endpoint) {
    return refuse(name, root["rig"]["drive"].node()->source(),
                  "rig.drive: " + endpoint.error().message);
  }
  return {};
}

}  // namespace

std::vector<std::string> config_keys() {
  std::vector<std::string> names;
  names.reserve(keys().size());
  for (const Key& key : keys()) names.push_back(key.full());
  return names;
}

Result<Config> parse_config(std::string_view text, const std::string& name) {
  try {
    const toml::table root = toml::parse(text, name);
    Config config;
    for (const auto& entry : root) {
      const toml::key& section = entry.first;
      const toml::table* table = entry.second.as_table();
      if (!is_section(section.str()) || table == nullptr) {
        return refuse(
            name, section.source(),
            fmt::format("unknown section \"{}\"; the sections are [server], [store], "
                        "[assets], [queue], [workers], [rig], [printer], [camera], [people], [log]",
                        section.str()));
      }
      HP_RETURN_IF_ERROR(read_section(name, section.str(), *table, config));
    }
    HP_RETURN_IF_ERROR(check_values(config, name, root));
    return config;
  } catch (const toml::parse_error& error) {
    return refuse(name, error.source(), fmt::format("not valid TOML: {}", error.description()));
  }
}

Result<Config> read_config(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || std::filesystem::is_directory(path)) {
    return fail(Code::kNotFound,
                path.string() +
                    ": cannot be read; pass an existing TOML file to --config, or omit --config");
  }
  return parse_config(text.str(), path.string());
}

std::string Endpoint::text() const {
  const bool v6 = host.find(':') != std::string::npos;
  return v6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

bool Endpoint::is_loopback() const {
  in_addr v4{};
  const bool is_v4 = inet_pton(AF_INET, host.c_str(), &v4) == 1;
  return is_v4 ? (ntohl(v4.s_addr) >> 24) == 127 : host == "::1";
}

Result<Endpoint> parse_endpoint(std::string_view text) {
  const auto refused = [&](const std::string& why) {
    return fail(Code::kInvalidArgument, fmt::format("\"{}\" {}", text, why),
                ErrorReason::CONFIG_INVALID);
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) {
    return refused("has no port; write an address like 127.0.0.1:50051");
  }
  Endpoint endpoint;
  const std::string_view port = text.substr(colon + 1);
  const auto parsed = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (parsed.ec != std::errc() || parsed.ptr != port.data() + port.size() || endpoint.port < 0 ||
      endpoint.port > 65535) {
    return refused("must have a port from 0 to 65535; write an address like 127.0.0.1:50051");
  }
  std::string host(text.substr(0, colon));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  if (host == "localhost") host = "127.0.0.1";
  in_addr v4{};
  in6_addr v6{};
  if (inet_pton(AF_INET, host.c_str(), &v4) != 1 && inet_pton(AF_INET6, host.c_str(), &v6) != 1) {
    return refused(
        "does not begin with an IP address; write 127.0.0.1 or [::1] for loopback, 0.0.0.0 or [::] "
        "for all addresses of this machine, or a single address of this machine");
  }
  endpoint.host = host;
  return endpoint;
}

Result<std::filesystem::path> default_state_dir() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/') {
    return std::filesystem::path(state) / "hydroprint";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return std::filesystem::path(home) / ".local" / "state" / "hydroprint";
  }
  return fail(
      Code::kFailedPrecondition,
      "store.state_dir: neither XDG_STATE_HOME nor HOME is set; set the folder for jobs with "
      "--state-dir DIR");
}

}  // namespace hydroprint::daemon
