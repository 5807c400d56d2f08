#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// An array of jobs that has been given to SLURM.
struct SlurmJob {
    std::string id;
    std::string cluster{}; ///< empty: the one that commands mean if nothing is said
};

/// "123;cluster", as sbatch prints it; "123" for the usual cluster.
std::string text_of(const SlurmJob& job);
/// The job in such a line; none if it is of another form.
std::optional<SlurmJob> slurm_job(std::string_view line);

/// What SLURM says of a task of an array.
struct TaskState {
    std::string state;  ///< as "RUNNING" or "TIMEOUT"
    std::string reason; ///< why it waits

    bool is_over() const; ///< and will not be begun again
    bool is_waiting() const;
};

/// What squeue says of the tasks of a job, by their numbers; there are none if SLURM has forgotten the job. None at
/// all: squeue does not answer, as when SLURM's controller is busy.
std::optional<std::map<std::size_t, TaskState>> task_states(const SlurmJob& job);

/// Gives a script to SLURM.
/// @param options of sbatch
/// @throws InputError with what sbatch says if it refuses
SlurmJob submit_script(const std::string& script, const std::vector<std::string>& options);

/// @throws InputError unless SLURM's commands are on the PATH
void require_slurm();

} // namespace graze
