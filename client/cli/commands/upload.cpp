#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/assets.h"
#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/inputs.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

Status upload(Program& program, const std::vector<std::string>& files) {
  Json assets = Json::array();
  for (const std::string& file : files) {
    HP_ASSIGN_OR_RETURN(const client::Uploaded uploaded, upload_shown(program.daemon(), file));
    assets.push_back(to_json(uploaded.asset));
    if (!program.json())
      std::cout << uploaded.asset.name() << "  " << file
                << (uploaded.was_known ? "  (already uploaded)" : "") << std::endl;
  }
  if (program.json()) print({{"assets", assets}});
  return {};
}

}  // namespace

void add_upload(CLI::App& app, Program& program) {
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("upload", "Upload files; prints their asset names");
  command->add_option("files", *files, "Files to upload")->type_name("FILE")->required();
  command->footer(
      "Files that the daemon already has are not sent again.\n\n"
      "Example:\n"
      "  hydroprint upload spot.obj spot.png");
  program.on(*command, [&program, files] { return upload(program, *files); });
}

}  // namespace hydroprint::cli
