#pragma once

#include "graze/design/design.hpp"
#include "graze/study/study.hpp"

#include <CLI/App.hpp>

#include <string>

namespace graze {

/// The list of files that the running command reads. As long as it lives, no FileReplacement replaces one of them, by
/// whatever name or link it is called: the list is the one place where outputs are compared with inputs. There is one
/// list in a process; without it, nothing is refused.
class KeptInputs {
public:
    KeptInputs();
    ~KeptInputs();
    KeptInputs(const KeptInputs&) = delete;
    KeptInputs& operator=(const KeptInputs&) = delete;

    /// Says that an option asks for a file to be written, so that it is compared with what is added later.
    /// @throws InputError if it would replace a file of the list, or another output
    static void expect_output(const std::string& option, const std::string& path);
    /// Adds a file that is there; what is no regular file cannot be replaced and is passed over. Without a list nothing
    /// happens. @param what it is in messages, as "the model"
    /// @throws InputError if an expected output would replace it
    static void add(const std::string& what, const std::string& path);
    /// @throws InputError if an output of this path would replace a file of the list
    static void require_none_at(const std::string& path);
};

/// Adds what a command line names as inputs: all positional arguments, files behind `@`, and those of options that are
/// declared as `FILE:...`. Then compares the outputs, which are the options that are declared as `FILE`, with them and
/// with each other. What other files say that is read is added where they are read.
/// @throws InputError when two are the same file
void keep_inputs_of(const CLI::App& command);
/// Adds what a study or a design reads. @throws InputError if an expected output would replace it
void keep_inputs_of(const Study& study);
void keep_inputs_of(const Design& design);

} // namespace graze
