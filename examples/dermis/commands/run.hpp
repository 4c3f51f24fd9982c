/// The program but for main().
#pragma once

namespace dermis::program {

/// Runs the command line and returns the exit code, that of ErrorCode for an error, which is one line on stderr. To be
/// called once in a process.
int run(int argc, char** argv);

}  // namespace dermis::program
