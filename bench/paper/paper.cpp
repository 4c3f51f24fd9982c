#include "paper/paper.hpp"

#include <fmt/format.h>

#include <fstream>

#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "paper/plot.hpp"
#include "paper/study.hpp"

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

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw Error(ErrorCode::output, "--paper", path.string(), "a file to write");
}

/// Better known before the work than after it.
void make_folder(const std::filesystem::path& folder) {
  if (folder.string().find('\n') != std::string::npos) {
    throw Error(ErrorCode::output, "--paper", folder.string(), "a name without line ends");
  }
  std::error_code ignored;
  std::filesystem::create_directory(folder, ignored);
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error(ErrorCode::output, "--paper", folder.string(), "a folder to write into");
  }
  write(folder / "table.md", "");
}

void append(Claims& claims, const Claims& more) { claims.insert(claims.end(), more.begin(), more.end()); }

}  // namespace

std::string reproduce_paper(const std::filesystem::path& folder,
                            const std::function<void(const std::string&)>& report) {
  need_gnuplot();
  make_folder(folder);
  const Study study = make_study(folder, report);
  Claims claims;
  report("figure 2: singular values");
  append(claims, fig2(study));
  report("figure 4: low ranks");
  append(claims, fig4(study));
  report("figure 5: slices");
  append(claims, fig5(study));
  report("figure 7: a step");
  append(claims, fig7(study));
  report("table 2: the artist's fits");
  append(claims, table2(study));
  report("equation 5: edges at an angle");
  append(claims, edges(study));
  report("figure 11: taps");
  append(claims, fig11(study));
  report("appendix A: guided kernels");
  append(claims, guided(study));

  const std::string table = introduction + table_of(claims);
  write(folder / "table.md", table);
  const nlohmann::ordered_json object = {
      {"version", DERMIS_VERSION}, {"width_px", width_px}, {"side_px", side_px}, {"claims", json_of(claims)}};
  write(folder / "claims.json", object.dump(2) + "\n");
  return table;
}

}  // namespace dermis::bench
