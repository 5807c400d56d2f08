#pragma once

#include "graze/design/design.hpp"
#include "graze/study/study.hpp"

#include <CLI/App.hpp>

#include <string>

namespace graze {

/// The list of files that the running command reads. During its lifetime no FileReplacement replaces one of them, under
/// any name or link: the list is the only place where outputs are compared with inputs. A process has one list; without
/// it no output is refused.
class KeptInputs {
public:
    KeptInputs();
    ~KeptInputs();
    KeptInputs(const KeptInputs&) = delete;
    KeptInputs& operator=(const KeptInputs&) = delete;

    /// Registers an output file, so that inputs that are added later are compared with it.
    /// @throws InputError if it would replace a file of the list, or another output
    static void expect_output(const std::string& option, const std::string& path);
    /// Adds an existing file; other than regular files are ignored, since they cannot be replaced. Does nothing without
    /// a list. @param what its name in messages, as "the model"
    /// @throws InputError if an expected output would replace it
    static void add(const std::string& what, const std::string& path);
    /// @throws InputError if an output of this path would replace a file of the list
    static void require_none_at(const std::string& path);
};

/// Adds the inputs that a command line names: positional arguments, files after `@`, and values of options declared as
/// `FILE:...`. Compares the outputs, values of options declared as `FILE`, with them and with each other. Files that
/// are named inside input files are added where those are read.
/// @throws InputError when an output is the same file as an input or another output
void keep_inputs_of(const CLI::App& command);
/// Adds all files that a study or a design reads. @throws InputError if an expected output would replace one
void keep_inputs_of(const Study& study);
void keep_inputs_of(const Design& design);

} // namespace graze
