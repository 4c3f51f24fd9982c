#include "arguments/cryptomatte_argument.hpp"

#include <cstddef>
#include <string_view>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {

void add_cryptomatte_argument(CLI::App& app, std::vector<std::string>& arguments) {
  app.add_option(
         "--cryptomatte", arguments,
         "pixels that this object, material or asset of the Cryptomatte in the picture covers most of carry the "
         "material id, and what it covers is their matte; repeatable")
      ->allow_extra_args(false)
      ->type_name("NAME=ID");
}

std::vector<MatteId> parse_mattes(const std::vector<std::string>& arguments) {
  constexpr int max_id = 65535;
  std::vector<MatteId> mattes;
  for (const std::string& text : arguments) {
    const std::size_t equals = text.rfind('=');
    const auto id = equals == std::string::npos ? std::nullopt : parse_whole(std::string_view(text).substr(equals + 1));
    if (!id || *id < 0 || *id > max_id || equals == 0)
      throw Error(ErrorCode::usage, "--cryptomatte", text, "NAME=ID with an id from 0 to 65535, as Head=1");
    mattes.push_back({text.substr(0, equals), static_cast<int>(*id)});
  }
  return mattes;
}

NamedMattes load_named_mattes(const exr::Picture& picture, const exr::Roles& roles, const std::vector<MatteId>& mattes,
                              const std::filesystem::path& folder) {
  constexpr float no_id = -1;
  std::vector<std::string> names;
  for (const MatteId& matte : mattes) names.push_back(matte.name);
  exr::Mattes found = exr::load_cryptomatte(picture, roles, names, folder);
  NamedMattes named{std::move(found.cryptomatte), {}, std::move(found.share)};
  for (const int name : found.name)
    named.ids.push_back(name < 0 ? no_id : static_cast<float>(mattes[static_cast<std::size_t>(name)].id));
  return named;
}

}  // namespace dermis::program
