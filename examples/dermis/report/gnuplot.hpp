/// Figures, drawn by gnuplot. What stands in a script is run, so no name of a file does, and no text but as
/// `script_string` has it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::program {

/// The colours of red, green and blue curves, as a script names them.
inline constexpr std::array<std::string_view, 3> channel_colours = {"#c02020", "#209020", "#2040c0"};

/// Any text as a string of a gnuplot script: between single quotes, where neither backslashes nor backquotes mean
/// anything, with control characters, which may end a line, as \xNN.
std::string script_string(std::string_view text);

/// A file in memory that gnuplot can read.
class FileInMemory {
 public:
  /// Throws Error(output) if there is no memory for it.
  explicit FileInMemory(std::string_view bytes);
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  /// Under which a process that is started while this lives reads the file from its beginning.
  std::string name() const;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Size of a figure, and what else its terminal is told, as "dynamic font 'Helvetica,14'".
struct FigureSize {
  int width_px;
  int height_px;
  std::string_view terminal_options = {};
};

/// Throws Error(output) that names `argument` if there is no gnuplot.
void need_gnuplot(std::string_view argument);

/// Runs a script of one page whose output is an .svg or .png file; the script sets neither terminal nor output.
/// `argument` is named in errors. Throws Error(output) if gnuplot is missing or fails, or the file cannot be written.
void draw_figure(std::string_view argument, const std::filesystem::path& path, const FigureSize& size,
                 const std::string& script);

}  // namespace dermis::program
