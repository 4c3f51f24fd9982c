// The dermis program.
#include "commands/run.hpp"

int main(int argc, char** argv) { return dermis::program::run(argc, argv); }
