/// The program but for main().
#pragma once

namespace dermis::program {

/// Runs the command line and returns the exit code, that of ErrorCode for an error, which is one line on stderr. To be
/// called once in a process.
int run(int argc, char** argv);

/// From here on a signal that ends the process leaves no temporary files, while one that is ignored, as by nohup, stays
/// so; and a limit on the size of files, or a pipe that nobody reads, makes writing fail. `run` does this first.
void handle_signals();

}  // namespace dermis::program
