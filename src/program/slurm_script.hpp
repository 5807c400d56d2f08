#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// One word for a shell, whatever characters it contains.
std::string shell_word(std::string_view text);

/// An array of jobs of SLURM: each of its tasks computes the part of a study that has the task's number.
struct SlurmArray {
    std::string name;                   ///< of the study
    std::string folder;                 ///< of the parts, from the root on; the messages of the tasks go there, too
    std::size_t count = 1;              ///< of all parts
    std::vector<std::size_t> numbers{}; ///< of the parts that are to be computed, rising
    std::vector<std::string> command{}; ///< graze run STUDY with its options; without --part, --jobs and --quiet
};

/// The file with the messages of a part. @param number of the part; "%a" is that of the task
std::string messages_of_part(const SlurmArray& array, const std::string& number);
/// The array as a script for sbatch.
/// @throws InputError for a folder whose name a script cannot have
std::string slurm_script(const SlurmArray& array);

} // namespace graze
