#include "sim/worker/verbs/preview.h"

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

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/checked_json.h"
#include "sim/base/pose_file.h"
#include "sim/film/outline.h"
#include "sim/mesh/read/read_model.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/preview.h"
#include "sim/worker/common/dip.h"
#include "sim/worker/common/report_values.h"
#include "sim/worker/common/task.h"
#include "sim/worker/verbs/preview_requests.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(For programs: reads the model once, and then one request per line from stdin, such as
  {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3"}
Each answer on stdout is a line of JSON, followed by binary data whose length is its "bytes" (four floats per vertex:
film_x, film_y, contact_time, stretch). It is a rough result, computed in a fraction of a second. The first answer is the
model itself. A newer request cancels the current one. sim/worker/verbs/preview.h describes the protocol.

Example:
  echo '{"id": 1}' | hydroprint-worker preview --mesh ball.ply | head -n 1

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

/// Writes all bytes to stdout.
Status write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      return fail(Code::kInternal, std::string("stdout: ") + std::strerror(errno) +
                                       ". Read all answers from stdout");
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

Error superseded() {
  return {Code::kCancelled, "a newer request replaced this one", "SUPERSEDED", {}};
}

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

/// Returns `value` if it is a number from `least` to `most`; otherwise an error that names `key`.
Result<double> read_number(const nlohmann::json& value, const std::string& key, double least,
                           double most) {
  const double number =
      value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (number >= least && number <= most) return number;
  return fail(Code::kInvalidArgument,
              key + ": not a number, or out of range. Check the value and its unit (mm or mm/s)");
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
    return fail(Code::kInvalidArgument,
                key + ": unknown key, or a value of the wrong type. See --help");
  }
  return {};
}

/// @param request  its id is set even if the rest is refused
Status read_request(const std::string& line, const pipeline::DipOptions& otherwise,
                    Request& request) {
  const auto json = parse_json(line).value_or(nullptr);
  if (!json.is_object()) {
    return fail(Code::kInvalidArgument,
                "not a JSON object. Write each request as a JSON object on a line of its own");
  }
  request.dip = otherwise;
  const auto id = json_unsigned(json, "id");
  if (!id || *id > std::uint64_t{1} << 53) {
    return fail(Code::kInvalidArgument,
                "id: missing, or not an integer from 0 to 2^53. Give each request such an id");
  }
  request.id = static_cast<std::int64_t>(*id);
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

/// Answers one request. Fails only if the answer cannot be written.
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

class Preview final : public Task {
 public:
  explicit Preview(DipOptions options) : options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.object.mesh.string(); }
  [[nodiscard]] Result<Finished> run(const RunOptions& options, Termination& termination,
                                     int stderr_fd) override;

 private:
  DipOptions options_;
};

Result<Finished> Preview::run(const RunOptions& options, Termination& termination,
                              int /*stderr_fd*/) {
  const auto ended = [&termination] { return termination.requested(); };
  HP_ASSIGN_OR_RETURN(const pipeline::DipOptions otherwise, read_dip(options_));
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(options_.object.mesh, options_.object.scale,
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
  HP_RETURN_IF_ERROR(check_cancelled({1, nullptr, ended}));
  return Finished{};
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(DipOptions options,
                      dip_options(static_cast<const v1::SimulateSpec&>(spec), inputs));
  return std::make_unique<Preview>(std::move(options));
}

void add_flags(Flags& flags) {
  flags.add_fields({"mesh", "scale", "pose", "film", "profile", "depth_mm", "dip_speed_mm_per_s"});
}

}  // namespace

Verb preview_verb() {
  return {"preview", "Answer requests for fast approximate dips while the pose changes",
          kExamples, &v1::SimulateSpec::default_instance(),
          add_flags, plan,
          false};
}

}  // namespace hydroprint::worker
