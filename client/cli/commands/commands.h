#pragma once

namespace CLI {
class App;
}

namespace hydroprint::cli {

class Program;

// Each function adds one command to the program's command line.
void add_sample(CLI::App& app, Program& program);
void add_upload(CLI::App& app, Program& program);
void add_submit(CLI::App& app, Program& program);
void add_watch(CLI::App& app, Program& program);
void add_list(CLI::App& app, Program& program);
void add_show(CLI::App& app, Program& program);
void add_report(CLI::App& app, Program& program);
void add_events(CLI::App& app, Program& program);
void add_cancel(CLI::App& app, Program& program);
void add_retry(CLI::App& app, Program& program);
void add_delete(CLI::App& app, Program& program);
void add_artifacts(CLI::App& app, Program& program);
void add_download(CLI::App& app, Program& program);
void add_assets(CLI::App& app, Program& program);
void add_queue(CLI::App& app, Program& program);
void add_status(CLI::App& app, Program& program);
void add_rig(CLI::App& app, Program& program);
void add_camera(CLI::App& app, Program& program);
void add_capture(CLI::App& app, Program& program);
void add_calibrate(CLI::App& app, Program& program);
void add_calibrate_camera(CLI::App& app, Program& program);
void add_calibrations(CLI::App& app, Program& program);
void add_loop(CLI::App& app, Program& program);
void add_preview(CLI::App& app, Program& program);
void add_inspect(CLI::App& app, Program& program);
void add_plan(CLI::App& app, Program& program);
void add_print(CLI::App& app, Program& program);
void add_dip(CLI::App& app, Program& program);
void add_confirm(CLI::App& app, Program& program);
void add_login(CLI::App& app, Program& program);  // also adds logout and whoami
void add_users(CLI::App& app, Program& program);
void add_keys(CLI::App& app, Program& program);
void add_sessions(CLI::App& app, Program& program);
void add_audit(CLI::App& app, Program& program);
void add_pin(CLI::App& app, Program& program);  // also adds unpin
void add_admin(CLI::App& app, Program& program);
void add_share(CLI::App& app, Program& program);
void add_completion(CLI::App& app, Program& program);
void add_help(CLI::App& app, Program& program);

/// Adds `rig lease` to `rig`.
void add_lease(CLI::App& parent, Program& program);

}  // namespace hydroprint::cli
