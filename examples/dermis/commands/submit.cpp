// dermis submit: a job for a render farm, whose tasks each do a chunk of the frames of a call of dermis.
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>

#include "arguments/config_file.hpp"
#include "arguments/memory_argument.hpp"
#include "arguments/number_argument.hpp"
#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {

enum class FarmEngine { slurm, parallel, deadline, opencue };

}  // namespace dermis::program

namespace dermis {

template <>
inline constexpr std::array<Named<program::FarmEngine>, 4> word_table<program::FarmEngine> = {
    {{program::FarmEngine::slurm, "slurm"},
     {program::FarmEngine::parallel, "parallel"},
     {program::FarmEngine::deadline, "deadline"},
     {program::FarmEngine::opencue, "opencue"}}};

}  // namespace dermis

namespace dermis::program {
namespace {

constexpr std::int64_t most_chunks = 1000;  // Slurm takes array indices up to 1000 unless its administrator says more

struct FarmJob {
  FarmEngine engine = FarmEngine::slurm;
  std::int64_t chunks = 0;
  std::int64_t cores = 1;
  std::int64_t memory_mb = 0;  ///< 0: what the farm gives to a task that asks for none
  std::string name = "dermis";
  bool sends = false;
  std::vector<std::string> words;  ///< of the command that tasks run, and its options
};

/// The call, as the program would read it: what is wrong with it is told here and not by each task.
void check_call(const std::vector<std::string>& words) {
  CLI::App app{"dermis", "dermis"};
  const std::array known{add_filter(app), add_texture(app)};  // these own what options write to
  for (const Command& one : known) add_memory_argument(*one.app);
  const auto command = std::find_if(known.begin(), known.end(),
                                    [&](const Command& one) { return one.app->get_name() == words.front(); });
  if (command == known.end())
    throw Error(ErrorCode::usage, "command", words.front(), "filter or texture, which have --chunk");
  for (const std::string& word : words) {
    if (word.starts_with("--chunk") || word.starts_with("--threads"))
      throw Error(ErrorCode::usage, "command", word,
                  "neither --chunk nor --threads, as --chunks and --cores stand for them");
    if (exr::escaped(word) != word)
      throw Error(ErrorCode::usage, "command", word, "no control characters, which jobs cannot hold");
  }
  std::vector<std::string> all = with_config(*command->app, {words.begin() + 1, words.end()});
  all.insert(all.begin(), words.front());
  std::reverse(all.begin(), all.end());  // as CLI11 takes a vector
  try {
    app.parse(std::move(all));
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::usage, "command", error.what(), "a call that dermis takes");
  }
}

std::vector<std::string> words_of_task(const FarmJob& job, std::string_view number) {
  std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string()};
  words.insert(words.end(), job.words.begin(), job.words.end());
  // A task that was lost, or a job that is sent again, does what is left of it.
  if (job.words.front() == "filter" && std::find(words.begin(), words.end(), "--skip-existing") == words.end())
    words.emplace_back("--skip-existing");
  words.insert(words.end(),
               {"--threads", std::to_string(job.cores), "--chunk", fmt::format("{}/{}", number, job.chunks)});
  return words;
}

std::string joined(const std::vector<std::string>& words, std::string (*quoted)(const std::string&)) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted(word);
  return line;
}

bool needs_quotes(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:%@";
  return word.empty() || word.find_first_not_of(plain) != std::string::npos;
}

std::string quoted_for_shell(const std::string& word) {
  if (!needs_quotes(word)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Deadline has a word for quotation marks, and others of the same form, as <STARTFRAME>.
std::string quoted_for_deadline(const std::string& word) {
  if (word.find('"') != std::string::npos ||
      (word.find('<') != std::string::npos && word.find("<STARTFRAME>") == std::string::npos))
    throw Error(ErrorCode::usage, "command", word, "neither quotation marks nor < for Deadline");
  return word.find(' ') != std::string::npos || word.empty() ? "<QUOTE>" + word + "<QUOTE>" : word;
}

std::string as_xml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string slurm_script(const FarmJob& job) {
  std::string text = fmt::format(R"(#!/bin/bash
#SBATCH --job-name={}
#SBATCH --array=1-{}
#SBATCH --cpus-per-task={}
#SBATCH --requeue
#SBATCH --open-mode=append
)",
                                 job.name, job.chunks, job.cores);
  if (job.memory_mb > 0) text += fmt::format("#SBATCH --mem={}M\n", job.memory_mb);
  std::vector<std::string> words = words_of_task(job, "");
  words.pop_back();
  return text + fmt::format("exec {} \"$SLURM_ARRAY_TASK_ID/{}\"\n", joined(words, quoted_for_shell), job.chunks);
}

std::string parallel_script(const FarmJob& job) {
  std::vector<std::string> words = words_of_task(job, "");
  words.pop_back();
  // Parallel gives the command to a shell once more.
  const std::string command = fmt::format("{} {{}}/{}", joined(words, quoted_for_shell), job.chunks);
  return fmt::format("#!/bin/bash\nseq {} | parallel --halt never --line-buffer --tag {}\n", job.chunks,
                     quoted_for_shell(command));
}

std::string deadline_script(const FarmJob& job) {
  std::vector<std::string> words = words_of_task(job, "<STARTFRAME>");
  const std::string program = words.front();
  words.erase(words.begin());
  return fmt::format(
      "#!/bin/bash\ndeadlinecommand -SubmitCommandLineJob -name {} -frames 1-{} -chunksize 1 -executable {} -arguments "
      "{} "
      "-startupdirectory {}\n",
      job.name, job.chunks, quoted_for_shell(program), quoted_for_shell(joined(words, quoted_for_deadline)),
      quoted_for_shell(std::filesystem::current_path().string()));
}

/// A job of OpenCue, by cjsl-1.15.dtd; #IFRAME# is the number of the task's first frame.
std::string opencue_spec(const FarmJob& job) {
  const char* user = std::getenv("USER");
  const std::string command =
      fmt::format("cd {} && {}", quoted_for_shell(std::filesystem::current_path().string()), [&] {
        std::vector<std::string> words = words_of_task(job, "");
        words.pop_back();
        return fmt::format("{} #IFRAME#/{}", joined(words, quoted_for_shell), job.chunks);
      }());
  return fmt::format(
      R"(<?xml version="1.0"?>
<!DOCTYPE spec PUBLIC "SPI Cue Specification Language" "http://localhost:8080/spcue/dtd/cjsl-1.15.dtd">
<spec>
  <show>{0}</show>
  <shot>{0}</shot>
  <user>{1}</user>
  <job name="{0}">
    <layers>
      <layer name="scatter" type="Render">
        <cmd>{2}</cmd>
        <range>1-{3}</range>
        <chunk>1</chunk>
        <cores>{4}</cores>
        <threadable>0</threadable>
{5}        <services>
          <service>shell</service>
        </services>
      </layer>
    </layers>
  </job>
</spec>
)",
      job.name, as_xml(user != nullptr ? user : "dermis"), as_xml(command), job.chunks, job.cores,
      job.memory_mb > 0 ? fmt::format("        <memory>{}m</memory>\n", job.memory_mb) : std::string());
}

std::string text_of(const FarmJob& job) {
  switch (job.engine) {
    case FarmEngine::slurm:
      return slurm_script(job);
    case FarmEngine::parallel:
      return parallel_script(job);
    case FarmEngine::deadline:
      return deadline_script(job);
    case FarmEngine::opencue:
      return opencue_spec(job);
  }
  return {};
}

/// Hands the text to the engine's own command, which says what became of it.
int send(const FarmJob& job, const std::string& text) {
  if (job.engine == FarmEngine::opencue)
    throw Error(ErrorCode::usage, "--send", "opencue",
                "slurm, parallel or deadline; OpenCue takes the text by its Python API");
  FILE* command = popen(job.engine == FarmEngine::slurm ? "sbatch" : "bash", "w");
  const bool is_written = command != nullptr && std::fwrite(text.data(), 1, text.size(), command) == text.size();
  const int status = command != nullptr ? pclose(command) : -1;
  if (!is_written || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(ErrorCode::output, "--send",
                fmt::format("exit code {} of {}", WEXITSTATUS(status), name_of(job.engine)),
                "a job that is taken and done");
  return 0;
}

int run_submit(const FarmJob& job) {
  check_call(job.words);
  const std::string text = text_of(job);
  if (job.sends) return send(job, text);
  print(text);
  return 0;
}

}  // namespace

Command add_submit(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("submit", "a job for a render farm, whose tasks do the frames in chunks");
  const auto job = std::make_shared<FarmJob>();
  add_word(*app, "--engine", job->engine, "the farm's manager; parallel is GNU Parallel on this machine")->required();
  app->add_option("--chunks", job->chunks, "how many tasks share the frames: 1..1000")
      ->required()
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= most_chunks; }, "1..1000"))
      ->type_name("N");
  app->add_option("--cores", job->cores, "cores of a task, which it asks for and uses")
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= 1024; }, "1..1024"))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--memory-mb", job->memory_mb, "memory that a task asks for, MB; without it what the farm gives")
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= 1 << 24; }, "1 or more"))
      ->type_name("N");
  app->add_option("--name", job->name, "of the job")
      ->check([](const std::string& name) {
        return needs_quotes(name) || name.find_first_of("=/,:%@") != std::string::npos
                   ? refusal(name, "letters, digits, and the characters . _ - +")
                   : std::string();
      })
      ->type_name("NAME")
      ->capture_default_str();
  app->add_flag("--send", job->sends, "hand the job over instead of printing it; not for opencue");
  app->add_option("command", job->words, "after --: filter or texture with all options, but for --chunk")->required();
  app->footer("dermis submit --engine slurm --chunks 20 -- filter shot.####.exr -o sss.####.exr --profile skin");
  return {app, [job] { return run_submit(*job); }};
}

}  // namespace dermis::program
