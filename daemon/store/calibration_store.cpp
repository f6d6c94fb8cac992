#include "daemon/store/calibration_store.h"

#include "daemon/platform/resource_names.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

std::int64_t number(CalibrationKind kind) { return static_cast<std::int64_t>(kind); }

Status make_active(Database& database, std::int64_t id, CalibrationKind kind) {
  return database.run("UPDATE calibrations SET active=(id=?) WHERE kind=?", {id, number(kind)});
}

/// Reads the state of the rig from the six columns that start at `at`; nullopt if they are NULL.
std::optional<Captured> read_captured(const DbRow& row, int at) {
  if (row.is_null(at)) return std::nullopt;
  return Captured{row.integer(at),
                  {row.integer(at + 1) != 0, row.integer(at + 2) != 0, row.real(at + 3),
                   row.integer(at + 4), row.integer(at + 5)}};
}

Calibration read(const DbRow& row) {
  Calibration out;
  out.id = row.integer(0);
  out.definition = {static_cast<CalibrationKind>(row.integer(1)), row.text(2), row.integer(3),
                    row.integer(4), row.text(7)};
  out.active = row.integer(5) != 0;
  out.create_ms = row.integer(6);
  out.captured = read_captured(row, 8);
  return out;
}

}  // namespace

Result<std::int64_t> insert_calibration(Database& database, const NewCalibration& definition,
                                        std::int64_t now_ms) {
  HP_RETURN_IF_ERROR(
      database.run("INSERT INTO calibrations(kind, owner, job, capture, active, create_ms, body) "
                   "VALUES (?,?,?,?,0,?,?)",
                   {number(definition.kind), definition.owner, definition.job, definition.capture,
                    now_ms, definition.body}));
  const std::int64_t id = database.last_id();
  HP_RETURN_IF_ERROR(make_active(database, id, definition.kind));
  return id;
}

Result<std::int64_t> calibration_of_job(Database& database, std::int64_t job) {
  HP_ASSIGN_OR_RETURN(const auto found,
                      select_numbers(database, "SELECT id FROM calibrations WHERE job=?", {job}));
  return found.empty() ? 0 : found.front();
}

Result<std::vector<Calibration>> CalibrationStore::select(const std::string& where,
                                                          std::initializer_list<DbValue> values) {
  std::vector<Calibration> out;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT c.id, c.kind, c.owner, c.job, c.capture, c.active, c.create_ms, c.body, f.time_ms, "
      "f.watched, f.homed, f.axis_mm, f.homings, f.dips FROM calibrations c LEFT JOIN captures f "
      "ON f.job=c.capture " +
          where,
      values, [&](const DbRow& row) { out.push_back(read(row)); }));
  return out;
}

Result<Calibration> CalibrationStore::create(const NewCalibration& definition,
                                             const RequestKey& request) {
  std::int64_t id = 0;
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const auto earlier,
                        earlier_result(database_, definition.owner, request, clock_()));
    if (earlier) {
      id = parse_number(*earlier);
      return {};
    }
    HP_ASSIGN_OR_RETURN(id, insert_calibration(database_, definition, clock_()));
    return remember_result(database_, definition.owner, request, std::to_string(id), clock_());
  });
  HP_RETURN_IF_ERROR(done);
  return get(id);
}

Result<Calibration> CalibrationStore::get(std::int64_t id) {
  HP_ASSIGN_OR_RETURN(auto found, select("WHERE c.id=?", {id}));
  if (!found.empty()) return std::move(found.front());
  return fail(Code::kNotFound, calibration_name(id) + " does not exist",
              ErrorReason::CALIBRATION_NOT_FOUND);
}

Result<std::optional<Calibration>> CalibrationStore::active(CalibrationKind kind) {
  HP_ASSIGN_OR_RETURN(auto found, select("WHERE c.active=1 AND c.kind=?", {number(kind)}));
  if (found.empty()) return std::optional<Calibration>();
  return std::optional(std::move(found.front()));
}

Result<std::vector<Calibration>> CalibrationStore::list(std::int64_t before_id, int limit) {
  return select(std::string(before_id > 0 ? "WHERE c.id<?1" : "WHERE c.id>?1") +
                    " ORDER BY c.id DESC LIMIT ?2",
                {before_id, std::int64_t{limit}});
}

Result<Calibration> CalibrationStore::activate(std::int64_t id) {
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Calibration found, get(id));
    return make_active(database_, id, found.definition.kind);
  });
  HP_RETURN_IF_ERROR(done);
  return get(id);
}

Status CalibrationStore::remove(std::int64_t id) {
  return database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(get(id));
    return database_.run("DELETE FROM calibrations WHERE id=?", {id});
  });
}

Result<std::optional<Captured>> CalibrationStore::capture(std::int64_t job) {
  std::optional<Captured> out;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT time_ms, watched, homed, axis_mm, homings, dips FROM captures WHERE job=?", {job},
      [&](const DbRow& row) { out = read_captured(row, 0); }));
  return out;
}

Status CalibrationStore::note_capture(std::int64_t job, const RigPlace& place) {
  return database_.run("INSERT INTO captures VALUES (?,?,?,?,?,?,?)",
                       {job, clock_(), std::int64_t{place.watched}, std::int64_t{place.homed},
                        place.axis_mm, place.homings, place.dips});
}

}  // namespace hydroprint::daemon
