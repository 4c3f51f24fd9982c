// The claims of Jimenez et al. 2015 ("Separable Subsurface Scattering") beside measurements.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace dermis::bench {

/// Writes table.md, claims.json and fig2, fig4, fig5, fig7 and fig11.svg into `folder`, which is made if its parent is
/// there. Returns the table. `report` is told what is going on. Throws Error(output) if something cannot be written or
/// there is no gnuplot.
std::string reproduce_paper(const std::filesystem::path& folder, const std::function<void(const std::string&)>& report);

}  // namespace dermis::bench
