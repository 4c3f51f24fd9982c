// The program as it is started from a shell; other tests call it in processes that have loaded it already.
#include <cstdlib>
#include <string>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

std::string quoted(const std::string& word) { return " '" + word + "'"; }

}  // namespace

TEST_CASE("the first run of all, which compiles the kernels, says nothing") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 40, 30, 3);
  const std::vector<std::string> materials = {"--material", "1=skin", "--material", "2=wax"};
  std::string command = "POCL_CACHE_DIR='" + (folder / "cache") + "'" + quoted(DERMIS_PROGRAM);
  for (const std::string& word : filter_arguments(scene, folder / "out.exr", materials)) command += quoted(word);
  command += " >" + quoted(folder / "stdout") + " 2>" + quoted(folder / "stderr");
  std::filesystem::create_directory(folder / "cache");
  CHECK(std::system(command.c_str()) == 0);
  CHECK(bytes_of_file(folder / "stdout") == "");
  CHECK(bytes_of_file(folder / "stderr") == "");
  run_well(filter_arguments(scene, folder / "again.exr", materials));
  CHECK(relative_l2(folder / "again.exr", folder / "out.exr", "ViewLayer.sss") == 0);
}
