/// --space and --mm-per-texel: whether light lies on a screen or in a UV layout.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace dermis::program {

struct TextureArguments {
  std::string space = "screen";
  std::optional<double> mm_per_texel;
};

void add_texture_arguments(CLI::App& app, TextureArguments& arguments);

inline bool is_texture(const TextureArguments& arguments) { return arguments.space == "texture"; }

/// Throws Error(usage) for what is of texture space only. `method` is that of --method.
void check_space_of_screen(const TextureArguments& arguments, const std::string& method);

}  // namespace dermis::program
