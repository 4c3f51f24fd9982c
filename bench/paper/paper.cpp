#include "paper/paper.hpp"

#include <fmt/format.h>

#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "files/output_file.hpp"
#include "paper/study.hpp"
#include "report/gnuplot.hpp"

namespace dermis::bench {

namespace {

constexpr const char* introduction =
    "# Jimenez et al. 2015, \"Separable Subsurface Scattering\": claimed and measured\n\n"
    "Errors are relative L2 distances, all channels together, from the exact convolution with the profile on pixels; "
    "percentages of a step or an edge are of its height, the largest anywhere. "
    "*Natural* pictures are four of 512x512 with a 1/f amplitude spectrum; the *dot* is a disc of 3 px radius. "
    "Models stand on every pixel unless taps are counted. W is the standard deviation of the widest Gaussian (skin) "
    "or, along an axis, of the widest channel (others), and is 16 px unless said otherwise. "
    "*skin* is the sum of six Gaussians of d'Eon and Luebke 2007, *skin-measured* Burley's profile and *dipole-skin1*, "
    "*dipole-marble* dipoles of media of Jensen et al. 2001. The paper's own profiles and pictures are not public "
    "here, and where it gives no number, what counts as holding is our choice. Nothing here is about time.\n\n";

/// Fails before the work if it cannot be written into.
void make_folder(const std::filesystem::path& folder) {
  if (folder.string().find('\n') != std::string::npos) {
    throw Error(ErrorCode::output, "--paper", folder.string(), "a name without line ends");
  }
  std::error_code ignored;
  std::filesystem::create_directory(folder, ignored);
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error(ErrorCode::output, "--paper", folder.string(), "a folder to write into");
  }
  program::check_writable("--paper", folder / "table.md");
}

}  // namespace

std::string reproduce_paper(const std::filesystem::path& folder,
                            const std::function<void(const std::string&)>& report) {
  program::need_gnuplot("--paper");
  make_folder(folder);
  const Study study = make_study(folder, report);
  constexpr std::pair<const char*, Claims (*)(const Study&)> parts[] = {{"figure 2: singular values", fig2},
                                                                        {"figure 4: low ranks", fig4},
                                                                        {"figure 5: slices", fig5},
                                                                        {"figure 7: a step", fig7},
                                                                        {"table 2: the artist's fits", table2},
                                                                        {"equation 5: edges at an angle", edges},
                                                                        {"figure 11: taps", fig11},
                                                                        {"appendix A: guided kernels", guided}};
  Claims claims;
  for (const auto& [what, claims_of] : parts) {
    report(what);
    const Claims more = claims_of(study);
    claims.insert(claims.end(), more.begin(), more.end());
  }

  const std::string table = introduction + table_of(claims);
  program::write_file("--paper", folder / "table.md", table);
  const Json object = {
      {"version", DERMIS_VERSION}, {"width_px", width_px}, {"side_px", side_px}, {"claims", json_of(claims)}};
  program::write_file("--paper", folder / "claims.json", object.dump(2) + "\n");
  return table;
}

}  // namespace dermis::bench
