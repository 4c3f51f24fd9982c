/// --frames and --chunk: which pictures of a sequence a call works on.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace dermis::program {

/// A part of a sequence, counted from 1.
struct Chunk {
  std::size_t number = 1;
  std::size_t of = 1;

  /// The first of so many things that is in the chunk, and the first one behind it. Each is in one chunk, and chunks
  /// are as large as each other but for one.
  std::pair<std::size_t, std::size_t> range(std::size_t things) const {
    return {(number - 1) * things / of, number * things / of};
  }
};

struct FramesArguments {
  std::vector<std::int64_t> frames;  ///< in the order that was asked for, each once; none: those that there are
  Chunk chunk;
};

/// "1001-1100x2,1200,-5--1": numbers and ranges with a step. None if it is anything else or more than a million.
std::optional<std::vector<std::int64_t>> parse_frames(std::string_view text);

/// Adds --frames and --chunk.
void add_frames_arguments(CLI::App& app, FramesArguments& arguments);

}  // namespace dermis::program
