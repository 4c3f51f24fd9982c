// dermis preview: pictures as one sRGB PNG, side by side.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/exr.hpp"
#include "files/output_file.hpp"
#include "files/picture_png.hpp"

namespace dermis::program {
namespace {

struct PreviewArguments {
  std::vector<std::string> pictures;
  std::string output;
  std::vector<std::string> roles;
};

struct Beauty {
  int width;
  int height;
  std::vector<float> rgb;
};

Beauty read_beauty(const std::string& path, const std::vector<std::string>& role_overrides) {
  const exr::Picture picture = exr::Picture::read(path);
  const exr::Roles roles = exr::find_roles(picture, {.overrides = role_overrides});
  exr::require(picture, roles, exr::Role::beauty);
  return {picture.width(), picture.height(), exr::load(picture, roles, exr::Role::beauty)};
}

/// Puts pictures from left to right, with their tops aligned and black below the lower ones.
Beauty side_by_side(const std::vector<Beauty>& beauties) {
  Beauty sheet{0, 0, {}};
  for (const Beauty& beauty : beauties) {
    sheet.width += beauty.width;
    sheet.height = std::max(sheet.height, beauty.height);
  }
  sheet.rgb.resize(static_cast<std::size_t>(3) * sheet.width * sheet.height);
  int left = 0;
  for (const Beauty& beauty : beauties) {
    for (int y = 0; y < beauty.height; ++y) {
      std::copy_n(beauty.rgb.begin() + static_cast<std::ptrdiff_t>(3) * beauty.width * y, 3 * beauty.width,
                  sheet.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(sheet.width) * y + left));
    }
    left += beauty.width;
  }
  return sheet;
}

int run_preview(const PreviewArguments& arguments) {
  check_writable("--output", arguments.output);
  std::vector<Beauty> beauties;
  for (const std::string& path : arguments.pictures) beauties.push_back(read_beauty(path, arguments.roles));
  const Beauty sheet = side_by_side(beauties);
  write_file("--output", arguments.output, srgb_png(sheet.width, sheet.height, sheet.rgb));
  return 0;
}

}  // namespace

Command add_preview(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("preview", "the beauty of pictures as one sRGB PNG, side by side");
  const auto arguments = std::make_shared<PreviewArguments>();
  app->add_option("files", arguments->pictures, "the OpenEXR files to read")->required()->type_name("FILE");
  app->add_option("-o,--output", arguments->output, "the PNG file to write")
      ->required()
      ->check(file_name_ending({".png"}))
      ->type_name("OUT.png");
  app->add_option("--role", arguments->roles, "another beauty, for instance beauty=ViewLayer.sss")
      ->type_name("ROLE=CHANNELS")
      ->expected(1)
      ->take_all();
  return {app, [arguments] { return run_preview(*arguments); }};
}

}  // namespace dermis::program
