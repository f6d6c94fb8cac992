#include "client/assets.h"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

std::string owners_text(const v1::Asset& asset) {
  std::string text;
  for (const std::string& owner : asset.owners())
    text += (text.empty() ? "  " : ", ") + printable(owner);
  return text;
}

Status list_assets(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_assets(program.daemon()));
  if (program.json()) {
    print(list);
    return {};
  }
  for (const v1::Asset& asset : list.assets())
    std::cout << asset.name() << "  " << format_time(client::time_of(asset.create_time())) << "  "
              << format_bytes(asset.size_bytes()) << "  " << printable(asset.media_type())
              << owners_text(asset) << "\n";
  return {};
}

Status delete_assets(Program& program, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    HP_RETURN_IF_ERROR(client::delete_asset(program.daemon(), name));
    if (!program.json()) std::cout << name << " deleted" << std::endl;
  }
  if (program.json()) print({{"deleted", names}});
  return {};
}

}  // namespace

void add_assets(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("assets", "List or delete uploaded files");
  command->require_subcommand(0, 1);
  CLI::App* lister = command->add_subcommand(
      "list", "List your assets, sorted by hash; as an operator, list all (default)");
  for (CLI::App* listing : {command, lister})
    program.on(*listing, [&program] { return list_assets(program); });
  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* deleter = command->add_subcommand(
      "delete", "Delete your assets; as an operator, any asset that no unfinished job needs");
  deleter->add_option("asset", *names, "assets/SHA256")->type_name("ASSET")->required();
  program.on(*deleter, [&program, names] { return delete_assets(program, *names); });
}

}  // namespace hydroprint::cli
