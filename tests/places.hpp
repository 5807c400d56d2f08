#pragma once

namespace graze::testing {

/// The folder of this repository, and the program where one is built: told when the build is configured.
extern const char* const source_folder;
extern const char* const program_file;

} // namespace graze::testing
