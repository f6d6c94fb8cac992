#include "sim/worker/verbs/preview.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "proto/write_json.h"
#include "sim/base/checked_json.h"
#include "sim/base/pose_file.h"
#include "sim/base/process/error_output.h"
#include "sim/display/display_model.h"
#include "sim/film/outline.h"
#include "sim/mesh/read/read_model.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/preview.h"
#include "sim/worker/common/dip.h"
#include "sim/worker/common/report_values.h"
#include "sim/worker/common/task.h"
#include "sim/worker/inspection/inspection.h"
#include "sim/worker/verbs/preview_requests.h"

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExamples =
    R"(For programs: reads the model once, and then one request per line from stdin, such as
  {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3"}
Each answer on stdout is a line of JSON, followed by binary data whose length is its "bytes" (four floats per place:
film_x, film_y, contact_time, stretch). It is a rough result, computed in a fraction of a second. {"id": 8, "read": true}
asks for the model itself. A newer request cancels the current one. sim/worker/verbs/preview.h describes the protocol.

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
  return answer({{"id", id}, {"error", failure_json(error)}}, {});
}

Error superseded() {
  return {Code::kCancelled, "a newer request replaced this one", ErrorReason::PREVIEW_SUPERSEDED};
}

Status answer_failure(std::int64_t id, const Error& error) {
  return answer_error(id, error.code == Code::kCancelled ? superseded() : error);
}

template <class Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
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
  bool reads = false;  ///< asks for the model instead of a dip
  bool shape_only = false;
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
  } else if (key == "read" && value.is_boolean()) {
    request.reads = value.get<bool>();
  } else if (key == "shape_only" && value.is_boolean()) {
    request.shape_only = value.get<bool>();
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

/// @param places  number of places that are shown
std::string map_bytes(const flow::SurfaceMap& map, std::size_t places) {
  std::string bytes;
  bytes.reserve(16 * places);
  for (std::size_t i = 0; i < places; ++i) {
    put(bytes, static_cast<float>(map.film_mm[i].x()));
    put(bytes, static_cast<float>(map.film_mm[i].y()));
    put(bytes, static_cast<float>(map.contact_time_s[i]));
    put(bytes, static_cast<float>(map.stretch[i]));
  }
  return bytes;
}

/// Returns a message as a part of an answer.
Result<Json> json_of(const google::protobuf::Message& message) {
  HP_ASSIGN_OR_RETURN(const std::string text, json_file_of(message));
  return Json::parse(text);
}

Status answer_dip(std::int64_t id, const pipeline::Dip& dip, std::size_t places, double seconds) {
  const pipeline::DipFigures& f = dip.figures;
  v1::Pose pose;
  set_pose(dip.X_FO, pose);
  Json head = {
      {"id", id},
      {"depth_mm", f.depth_mm},
      {"coverage", f.coverage},
      {"theta_clamped_share", f.clamped_share},
      {"stretch", {{"p50", f.stretch_p50}, {"p95", f.stretch_p95}, {"max", f.stretch_max}}},
      {"seconds", seconds},
      {"warnings", Json::array()}};
  HP_ASSIGN_OR_RETURN(head["pose"], json_of(pose));
  for (const Warning& warning : dip.warnings) {
    HP_ASSIGN_OR_RETURN(Json entry, json_of(to_message(warning)));
    head["warnings"].push_back(std::move(entry));
  }
  return answer(std::move(head), map_bytes(dip.map.surface, places));
}

/// Answers with the model for display.
Status answer_display(const Request& request, const mesh::Model& model, const Context& context) {
  const auto shown = inspect_model(model, request.shape_only, context);
  if (!shown) {
    Error error = shown.error();
    if (error.code != Code::kCancelled) error.reason = ErrorReason::INPUT_REFUSED;
    return answer_failure(request.id, error);
  }
  HP_ASSIGN_OR_RETURN(Json summary, json_of(shown->summary));
  return answer({{"id", request.id}, {"summary", std::move(summary)}}, shown->glb);
}

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// The model of the session, and its surfaces for dips once they are needed.
class Object {
 public:
  explicit Object(mesh::Model model) : model_(std::move(model)) {}

  [[nodiscard]] const mesh::Model& model() const { return model_; }
  /// Makes the surfaces unless they exist. A newer request does not end this, because it needs them
  /// too.
  Status prepare(const Context& context) {
    if (surfaces_) return {};
    HP_ASSIGN_OR_RETURN(const mesh::Model shape, display::shown_shape(model_, context));
    HP_ASSIGN_OR_RETURN(surfaces_, pipeline::make_preview_surfaces(model_, shape, context));
    places_ = shape.vertices.size();
    return {};
  }
  /// After prepare().
  [[nodiscard]] const pipeline::PreviewSurfaces& surfaces() const { return *surfaces_; }
  [[nodiscard]] std::size_t places() const { return places_; }

 private:
  mesh::Model model_;
  std::optional<pipeline::PreviewSurfaces> surfaces_;
  std::size_t places_ = 0;
};

/// What ends a session, and what ends a computation.
struct Contexts {
  Context session;  ///< cancelled when the program must end
  Context request;  ///< cancelled also by a newer request
};

/// Answers one request. Fails only if the answer cannot be written.
Status serve(const std::string& line, Object& object, const pipeline::DipOptions& otherwise,
             const Contexts& contexts) {
  Request request;
  if (const Status read = read_request(line, otherwise, request); !read)
    return answer_error(request.id, read.error());
  if (request.reads) return answer_display(request, object.model(), contexts.request);
  const double begin_s = seconds_now();
  if (const Status ready = object.prepare(contexts.session); !ready)
    return answer_failure(request.id, ready.error());
  const auto dip =
      pipeline::preview_dip(object.model(), object.surfaces(), request.dip, contexts.request);
  if (!dip) return answer_failure(request.id, dip.error());
  return answer_dip(request.id, *dip, object.places(), seconds_now() - begin_s);
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
  const Context session{options.threads, nullptr, ended};
  HP_ASSIGN_OR_RETURN(mesh::Model model,
                      mesh::read_model(options_.object.mesh, options_.object.scale, session));
  Object object(std::move(model));
  PreviewRequests requests(STDIN_FILENO);
  const Contexts contexts{
      session, {options.threads, nullptr, [&] { return ended() || requests.has_newer(); }}};
  while (const auto next = requests.next(ended)) {
    for (const std::string& line : next->passed_over) {
      Request request;
      const Status read = read_request(line, otherwise, request);
      HP_RETURN_IF_ERROR(answer_error(request.id, read ? superseded() : read.error()));
    }
    HP_RETURN_IF_ERROR(serve(next->line, object, otherwise, contexts));
    // A reader of the model will soon ask for dips. Their requests report errors.
    if (!requests.has_newer()) (void)object.prepare(session);
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
