// Every kernel program compiles without a word, at every vector width and in all variants of a plan.
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "opencl/kernel_sources.hpp"
#include "opencl/opencl.hpp"
#include "opencl/params.hpp"
#include "opencl/program.hpp"
#include "support/catch.hpp"

using dermis::build_constant;

namespace {

/// Names that an #if of a kernel asks for, each 0 or 1.
const std::set<std::string> all_flags = {"HAS_ALBEDO", "HAS_DEPTH",   "HAS_MASK",      "HAS_MATERIAL", "HAS_MATTE",
                                         "HAS_NORMAL", "HAS_STRETCH", "HAS_THICKNESS", "PIXEL_WIDTH",  "JITTER",
                                         "SHEARED",    "LIT",         "TANGENT_DISC",  "INTERLEAVED",  "SUMS_WEIGHTS",
                                         "PROJECTED",  "WALK"};

/// Other names that an #if asks for.
const std::set<std::string> not_flags = {
    "V",          "TERMS",           "TABLE_SHIFT",        "FLATNESS",   "LEAST_CENTRE_WEIGHT", "SHEAR_RUN",
    "SHEAR_RUNS", "DERMIS_PARAMS_H", "INTERLEAVES_FLOATS", "LOCAL_TAPS", "LOCAL_PIXELS",        "MATERIALS"};

/// Kernel files that may stand in one program, their vector widths, and the flags that they only know one value of.
/// Most of the time goes into the compiler's own headers: some files are together here that plans build apart.
struct Group {
  std::vector<std::string> files;
  std::vector<int> widths;
  std::map<std::string, int> fixed;
};

const std::vector<int> all_widths = {1, 4, 8, 16};

const std::vector<Group> groups = {
    {{"frame/finish.cl", "separable/tile.cl"}, all_widths, {}},
    {{"frame/prepare.cl", "integral/exact.cl"}, all_widths, {}},
    {{"frame/entering_light.cl"}, all_widths, {{"HAS_DEPTH", 1}, {"HAS_NORMAL", 1}}},
    {{"frame/prepare.cl", "separable/pixel.cl", "separable/passes.cl"}, {1}, {{"LOCAL_TAPS", 0}, {"LOCAL_PIXELS", 0}}},
    {{"separable/passes.cl"}, {1}, {{"LOCAL_TAPS", 1}, {"LOCAL_PIXELS", 0}, {"JITTER", 0}}},
    {{"separable/passes.cl"}, {1}, {{"LOCAL_TAPS", 1}, {"LOCAL_PIXELS", 1}, {"JITTER", 0}}},
    {{"frame/finish.cl", "integral/disc_texels.cl", "integral/disc.cl"}, {1}, {}},
    {{"classify/classify.cl", "classify/choose_passes.cl", "classify/fingerprint.cl"}, {BLOCK}, {}},
    {{"classify/classify_pixels.cl", "classify/choose_passes.cl"}, {1}, {}},
    {{"views/view_pixels.cl"}, {1}, {{"HAS_DEPTH", 1}}},
    {{"views/hidden_light.cl"}, all_widths, {{"HAS_DEPTH", 1}}},
    {{"texture/texture_prepare.cl", "texture/texture_finish.cl", "texture/texture_blur.cl"}, all_widths, {{"LIT", 0}}},
    {{"texture/recursion.cl"}, all_widths, {{"LIT", 0}, {"HAS_ALBEDO", 0}, {"HAS_MASK", 0}}},
    {{"lighting/shadow_maps.cl", "lighting/shade.cl"}, {1}, {}},
    {{"lighting/shadow_maps.cl", "lighting/transmit.cl"}, {1}, {}},
};

/// Build options of variants in which any two flags have all four pairs of values, and each flag both with each width.
std::vector<std::string> variants_of(const Group& group, const std::string& source) {
  std::vector<std::string> flags;
  for (const std::string& flag : all_flags) {
    if (std::regex_search(source, std::regex("\\b" + flag + "\\b")) && !group.fixed.contains(flag))
      flags.push_back(flag);
  }
  // Without optimisation, which takes three times as long as all that warns, but the code of optimised kernels.
  std::string common =
      "-cl-std=CL1.2 -cl-opt-disable -D__OPTIMIZE__=1 -DTABLE_SHIFT=20 -DFLATNESS=1e-2f"
      " -DLEAST_CENTRE_WEIGHT=1e-6f -DSPACING=1e0f -DREACH=3e0f"
      " -DNARROW=1e0f -DMOST_TEXELS=9e0f";
  for (const auto& [flag, value] : group.fixed) common += build_constant(flag.c_str(), value);
  // In a pair of rows a flag is a bit of its number and the other one. The numbers of two flags differ in some bit, and
  // agree in the highest one, where they are 0.
  const int pairs = std::max(4, 1 + static_cast<int>(std::bit_width(flags.size() - 1)));
  std::vector<std::string> variants;
  for (int row = 0; row < 2 * pairs; ++row) {
    const int bit = row / 2;
    std::string options = common + build_constant("V", group.widths[bit % group.widths.size()]) +
                          build_constant("TERMS", 1 + bit % 4) + build_constant("MATERIALS", 1 + row % 2);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      options += build_constant(flags[i].c_str(), (static_cast<int>(i >> bit) ^ row) & 1);
    }
    variants.push_back(options);
  }
  return variants;
}

/// What is written to file descriptor 2 while it lives.
class ErrorOutput {
 public:
  ErrorOutput() : file_(std::tmpfile()), before_(dup(2)) { dup2(fileno(file_), 2); }
  ErrorOutput(const ErrorOutput&) = delete;
  ErrorOutput& operator=(const ErrorOutput&) = delete;
  ~ErrorOutput() {
    dup2(before_, 2);
    close(before_);
    std::fclose(file_);
  }

  std::string text() const {
    std::string text(static_cast<std::size_t>(lseek(fileno(file_), 0, SEEK_END)), '\0');
    return {text.data(), static_cast<std::size_t>(pread(fileno(file_), text.data(), text.size(), 0))};
  }

 private:
  std::FILE* file_;
  int before_;
};

/// What the compiler says about a program, in its log and on file descriptor 2.
std::string remarks_on(const dermis::Device& device, const std::string& source, const std::string& options) {
  // A name that no other run has keeps the program out of the driver's cache, from which it would come in silence.
  static const auto run = std::chrono::system_clock::now().time_since_epoch().count();
  const ErrorOutput errors;
  cl::Program program(cl::Context(device.context(), true), source);
  std::string failure;
  try {
    program.compile((options + " -DRUN=" + std::to_string(run)).c_str());
  } catch (const cl::Error& error) {
    failure = std::string(error.what()) + " failed\n";
  }
  std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(cl::Device(device.id(), true));
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return failure + log + errors.text();
}

}  // namespace

TEST_CASE("no kernel makes a compiler warn", "[warnings]") {
  const dermis::Device device = dermis::Device::open();
  for (const Group& group : groups) {
    const std::string source = dermis::assemble_source(group.files);
    for (const std::string& options : variants_of(group, source)) {
      CAPTURE(group.files, options);
      CHECK(remarks_on(device, source, options) == "");
    }
  }
}

TEST_CASE("a kernel that makes a compiler warn is found", "[warnings]") {
  const std::string remarks = remarks_on(dermis::Device::open(), "kernel void compare(int a) { a == 1; }", "");
  CHECK(remarks.find("warning: ") != std::string::npos);
}

TEST_CASE("all kernel files and all flags are in the list of variants", "[warnings]") {
  std::set<std::string> listed;
  for (const Group& group : groups) listed.insert(group.files.begin(), group.files.end());
  const std::regex condition("#\\s*(?:if|elif|ifdef|ifndef)\\b.*");
  const std::regex name("\\b[A-Z][A-Z_0-9]*\\b");
  for (const auto& [file, source] : dermis::kernel_sources()) {
    CAPTURE(file);
    CHECK((!file.ends_with(".cl") || listed.contains(file)));
    for (std::sregex_iterator line(source.begin(), source.end(), condition), end; line != end; ++line) {
      const std::string text = line->str();
      for (std::sregex_iterator word(text.begin(), text.end(), name); word != end; ++word) {
        CAPTURE(text, word->str());
        CHECK((all_flags.contains(word->str()) || not_flags.contains(word->str())));
      }
    }
  }
}
