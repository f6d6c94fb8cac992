#include "sim/worker/preview.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "sim/base/pose_file.h"
#include "sim/mesh/read_model.h"
#include "sim/pipeline/preview.h"
#include "sim/worker/calibrate_json.h"
#include "sim/worker/dip_json.h"
#include "sim/worker/preview_requests.h"

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

/// Writes all of it, or tells why not.
Status write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      return fail(Code::kInternal,
                  std::string("stdout: ") + std::strerror(errno) + ". Nobody reads the answers");
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Status answer(Json head, std::string_view bytes) {
  head["bytes"] = bytes.size();
  HP_RETURN_IF_ERROR(write_all(head.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"));
  return write_all(bytes);
}

Status answer_error(std::int64_t id, const Error& error) {
  return answer(
      {{"id", id},
       {"error",
        {{"code", code_name(error.code)}, {"reason", error.reason}, {"message", error.message}}}},
      {});
}

Error superseded() { return {Code::kCancelled, "a newer request came", "SUPERSEDED", {}}; }

template <class Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Status answer_model(const mesh::Model& model) {
  std::string bytes;
  bytes.reserve(12 * (model.vertices.size() + model.triangles.size()));
  for (const Eigen::Vector3d& vertex : model.vertices) {
    for (const double coordinate : vertex) put(bytes, static_cast<float>(coordinate));
  }
  for (const Eigen::Vector3i& triangle : model.triangles) {
    for (const int corner : triangle) put(bytes, static_cast<std::uint32_t>(corner));
  }
  return answer({{"vertices", model.vertices.size()},
                 {"triangles", model.triangles.size()},
                 {"warnings", warnings_json(model.warnings)}},
                bytes);
}

/// A number within bounds.
Result<double> read_number(const nlohmann::json& value, const std::string& key, double least,
                           double most) {
  const double number =
      value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (number >= least && number <= most) return number;
  return fail(Code::kInvalidArgument,
              key + ": not a number in mm or mm/s within what is possible. Correct it");
}

struct Request {
  std::int64_t id = -1;
  pipeline::DipOptions dip;
};

Status take(Request& request, const std::string& key, const nlohmann::json& value) {
  if (key == "pose") {
    HP_ASSIGN_OR_RETURN(const PoseFile pose, parse_pose(value, "pose"));
    request.dip.X_FO = pose.pose();
  } else if (key == "film" && value.is_string() && !film::polygon_file(value)) {
    HP_ASSIGN_OR_RETURN(request.dip.outline, film::parse_outline(value.get<std::string>()));
  } else if (key == "depth_mm") {
    HP_ASSIGN_OR_RETURN(request.dip.depth_mm, read_number(value, key, 1e-3, 1e4));
  } else if (key == "dip_speed_mm_per_s") {
    HP_ASSIGN_OR_RETURN(request.dip.dip_speed_mm_per_s, read_number(value, key, 1e-3, 1000));
  } else if (key != "id") {
    return fail(Code::kInvalidArgument, key + ": not known, or not its kind of value. See --help");
  }
  return {};
}

/// @param request  gets the id even where the rest is refused
Status read_request(const std::string& line, const pipeline::DipOptions& otherwise,
                    Request& request) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object()) {
    return fail(Code::kInvalidArgument, "a request is a JSON object on one line");
  }
  request.dip = otherwise;
  const auto id = json.find("id");
  if (id == json.end() || !id->is_number_unsigned() ||
      id->get<std::uint64_t>() > std::uint64_t{1} << 53) {
    return fail(Code::kInvalidArgument, "id: not a whole number. Give each request one");
  }
  request.id = id->get<std::int64_t>();
  for (const auto& [key, value] : json.items()) HP_RETURN_IF_ERROR(take(request, key, value));
  return {};
}

std::string map_bytes(const flow::SurfaceMap& map) {
  std::string bytes;
  bytes.reserve(16 * map.film_mm.size());
  for (std::size_t i = 0; i < map.film_mm.size(); ++i) {
    put(bytes, static_cast<float>(map.film_mm[i].x()));
    put(bytes, static_cast<float>(map.film_mm[i].y()));
    put(bytes, static_cast<float>(map.contact_time_s[i]));
    put(bytes, static_cast<float>(map.stretch[i]));
  }
  return bytes;
}

Status answer_dip(std::int64_t id, const pipeline::Dip& dip, double seconds) {
  const pipeline::DipFigures& f = dip.figures;
  return answer({{"id", id},
                 {"pose", pose_json(dip.X_FO)},
                 {"depth_mm", f.depth_mm},
                 {"coverage", f.coverage},
                 {"theta_clamped_share", f.clamped_share},
                 {"stretch", stretch_json(f)},
                 {"seconds", seconds},
                 {"warnings", warnings_json(dip.warnings)}},
                map_bytes(dip.map.surface));
}

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

Result<pipeline::DipOptions> read_defaults(const Options& o) {
  pipeline::DipOptions dip;
  HP_ASSIGN_OR_RETURN(dip.outline, film::parse_outline(o.film));
  if (!o.pose.empty()) {
    HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(o.pose));
    dip.X_FO = file.pose();
  }
  if (!o.profile.empty()) {
    HP_ASSIGN_OR_RETURN(dip.profile, film::read_profile(o.profile));
  }
  dip.depth_mm = o.depth_mm;
  dip.dip_speed_mm_per_s = o.dip_speed_mm_per_s;
  return dip;
}

/// Answers one request; fails only where nobody reads answers.
Status serve(const std::string& line, const mesh::Model& model,
             const pipeline::DipOptions& otherwise, const Context& context) {
  Request request;
  if (const Status read = read_request(line, otherwise, request); !read) {
    return answer_error(request.id, read.error());
  }
  const double begin_s = seconds_now();
  const auto dip = pipeline::dip(model, pipeline::preview_of(request.dip), context);
  if (dip) return answer_dip(request.id, *dip, seconds_now() - begin_s);
  const bool is_cancelled = dip.error().code == Code::kCancelled;
  return answer_error(request.id, is_cancelled ? superseded() : dip.error());
}

}  // namespace

Status run_preview(const Options& options, Ending& ending) {
  const auto ended = [&ending] { return ending.requested(); };
  HP_ASSIGN_OR_RETURN(const pipeline::DipOptions otherwise, read_defaults(options));
  HP_ASSIGN_OR_RETURN(const mesh::Model model, mesh::read_model(options.mesh, options.scale,
                                                                {options.threads, nullptr, ended}));
  HP_RETURN_IF_ERROR(answer_model(model));
  PreviewRequests requests(STDIN_FILENO);
  const Context context{options.threads, nullptr, [&] { return ended() || requests.has_newer(); }};
  while (const auto next = requests.next(ended)) {
    for (const std::string& line : next->passed_over) {
      Request request;
      const Status read = read_request(line, otherwise, request);
      HP_RETURN_IF_ERROR(answer_error(request.id, read ? superseded() : read.error()));
    }
    HP_RETURN_IF_ERROR(serve(next->line, model, otherwise, context));
  }
  return check_cancelled({1, nullptr, ended});
}

}  // namespace hydroprint::worker
