// Needs every installed library: puts an analytic scene's size into an EXR file and reads it back.
#include <dermis/exr.hpp>
#include <dermis/oracle/scenes.hpp>
#include <string>
#include <vector>

int main(int, char** argv) {
  const dermis::oracle::Scene scene = dermis::oracle::scene("step", 7, 5);
  const dermis::exr::Window window = {.width = scene.width, .height = scene.height};
  dermis::exr::Picture picture(window, window);
  picture.add_channels(std::vector<std::string>{"R", "G", "B"}, dermis::Format::f32);
  picture.write(argv[1]);
  return dermis::exr::Picture::read(argv[1]).data_window() == window ? 0 : 1;
}
