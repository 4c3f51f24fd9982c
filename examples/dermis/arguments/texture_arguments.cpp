#include "arguments/texture_arguments.hpp"

#include <fmt/format.h>

#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"
#include "dermis/error.hpp"

namespace dermis::program {

void add_texture_arguments(CLI::App& app, TextureArguments& arguments) {
  app.add_option("--space", arguments.space,
                 "screen, or texture: the light lies in a UV layout, whose texels span what --role stretch_u and "
                 "stretch_v, a position map with --mm-per-unit, or --mm-per-texel say")
      ->check(one_of({"screen", "texture"}))
      ->capture_default_str();
  app.add_option("--mm-per-texel", arguments.mm_per_texel, "of a texture whose texels all span as much: millimetres")
      ->check(real_number([](double mm) { return mm >= 1e-9 && mm <= 1e9; }, "millimetres per texel, 1e-9..1e9"));
}

void check_space_of_screen(const TextureArguments& arguments, const std::string& method) {
  if (method == "gaussians" || method == "recursive")
    throw Error(ErrorCode::usage, "--method", method + " with --space screen", "--space texture with it");
  if (arguments.mm_per_texel)
    throw Error(ErrorCode::usage, "--mm-per-texel", fmt::format("{} with --space screen", *arguments.mm_per_texel),
                "--space texture with it");
}

}  // namespace dermis::program
