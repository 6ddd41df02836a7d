// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/verify.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

#include "packer/commands/options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/verify/map_verifier.hpp"
#include "platform/base/shell_word.hpp"
#include "platform/command_line/command_line.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {
namespace {

struct VerifyArguments {
  std::string path;
  JsonOutput json;
};

Verdict verify(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return verify_map(FolderFiles(path));
  if (const std::string kind = misplaced_map_file(path.string()); !kind.empty()) {
    throw std::runtime_error(path.string() + ": " + kind);
  }
  const std::string name = path.filename().string();
  const FolderFiles folder(folder_around(path));
  return name == kManifestName ? verify_map(folder) : verify_one_pack(folder, name);
}

nlohmann::ordered_json to_json(const Verdict& verdict, const std::string& path) {
  nlohmann::ordered_json json;
  json["path"] = path;
  json["whole"] = verdict.whole();
  json["packs"] = verdict.packs;
  json["signatures"] = verdict.signatures;
  json["bytes"] = verdict.bytes;
  json["problem_count"] = verdict.problem_count();
  json["problems"] = nlohmann::ordered_json::array();
  for (const Problem& problem : verdict.problems) json["problems"].push_back(to_json(problem));
  json["unnamed_files"] = verdict.unnamed;
  return json;
}

// Files that are no files of a map at all, such as Git LFS pointers: what they are, and what to do.
void print_misplaced(const Verdict& verdict, const std::string& path, std::ostream& out) {
  std::set<std::string> named;
  for (const Problem& problem : verdict.problems) {
    if (!named.insert(problem.place.file).second) continue;
    const std::string file = (std::filesystem::path(path) / problem.place.file).string();
    const std::string kind = misplaced_map_file(file);
    if (!kind.empty()) out << file << ": " << kind << "\n";
  }
}

void print(const Verdict& verdict, const std::string& path, std::ostream& out) {
  for (const Problem& problem : verdict.problems) out << to_string(problem) << "\n";
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) print_misplaced(verdict, path, out);
  if (!verdict.unnamed.empty()) {
    out << path << ": " << counted(verdict.unnamed.size(), "pack or part", "packs or parts")
        << " that the manifest does not name; to remove "
        << (verdict.unnamed.size() == 1 ? "it" : "them") << ": zonepack prune " << shell_word(path)
        << "\n";
  }
  out << path << ": ";
  if (verdict.whole()) {
    out << "whole";
  } else {
    out << "DAMAGED: " << counted(verdict.problem_count(), "problem");
  }
  out << "; " << counted(verdict.packs, "pack") << ", " << counted(verdict.signatures, "signature")
      << ", " << size_text(verdict.bytes) << " checked\n";
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* const command = app.add_subcommand(
      "verify",
      "Check every byte of a map or a pack: 0 whole, 1 damaged, with each place and what to do");
  command->add_option("PATH", arguments->path, "folder of a map, or a pack (*.zpk)")
      ->required()
      ->type_name("DIR|PACK");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack verify map", "zonepack verify map --json -"});
  command->callback([arguments, &exit_code] {
    arguments->json.require_writable();
    const Verdict verdict = verify(arguments->path);
    print(verdict, arguments->path, arguments->json.text());
    arguments->json.write(to_json(verdict, arguments->path));
    exit_code = verdict.whole() ? 0 : 1;
  });
}

}  // namespace zonepack::packer
