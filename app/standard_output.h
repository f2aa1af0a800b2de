// Standard output, checked: a command whose output is lost fails.
#pragma once

namespace fovea::app {

/// To be called first. A write to a closed pipe or beyond a limit on file sizes becomes an error in
/// place of a signal that kills the program; and no file that is opened later becomes standard
/// input, output or error because the caller has closed one of them.
void prepare_standard_streams();

/// To be called last. OutputError if anything written to standard output was lost.
void finish_standard_output();

/// Whether a write to standard output failed, which the formatting library reports by an exception
/// without a name for the file.
bool standard_output_failed();

}  // namespace fovea::app
