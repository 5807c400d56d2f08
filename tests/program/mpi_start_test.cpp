#include "program/mpi_start.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace graze::mpi_start_test {

std::optional<MpiStart> started(const std::map<std::string, std::string>& variables) {
    return mpi_start([&](const char* name) {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
    });
}

TEST(MpiStart, IsSeenWhereProcessesBelongTogether) {
    EXPECT_EQ(started({{"OMPI_COMM_WORLD_SIZE", "64"}, {"OMPI_COMM_WORLD_RANK", "3"}}), (MpiStart{64, 3}));
    EXPECT_EQ(started({{"PMI_SIZE", "4"}, {"PMI_RANK", "0"}}), (MpiStart{4, 0, false}));
    EXPECT_EQ(started({{"SLURM_STEP_NUM_TASKS", "8"}, {"SLURM_PROCID", "7"}, {"SLURM_STEP_ID", "0"}}),
              (MpiStart{8, 7, false}));
    EXPECT_EQ(
        started({{"SLURM_STEP_NUM_TASKS", "8"}, {"SLURM_PROCID", "7"}, {"SLURM_STEP_ID", "0"}, {"PMIX_RANK", "7"}}),
        (MpiStart{8, 7}));
    // mpirun within a job starts one process of its own on each machine by srun.
    EXPECT_EQ(started({{"OMPI_COMM_WORLD_SIZE", "64"},
                       {"OMPI_COMM_WORLD_RANK", "5"},
                       {"SLURM_STEP_NUM_TASKS", "2"},
                       {"SLURM_PROCID", "1"},
                       {"SLURM_STEP_ID", "0"}}),
              (MpiStart{64, 5}));
}

TEST(MpiStart, IsNotSeenInOneProcess) {
    EXPECT_FALSE(started({}));
    EXPECT_FALSE(started({{"OMPI_COMM_WORLD_SIZE", "1"}, {"OMPI_COMM_WORLD_RANK", "0"}}));
    // What a script of a batch job has, and a task of an array of jobs.
    EXPECT_FALSE(started({{"SLURM_NTASKS", "64"}, {"SLURM_PROCID", "0"}, {"SLURM_JOB_ID", "17"}}));
    EXPECT_FALSE(started({{"SLURM_NTASKS", "64"},
                          {"SLURM_PROCID", "0"},
                          {"SLURM_ARRAY_TASK_ID", "3"},
                          {"SLURM_ARRAY_TASK_COUNT", "64"}}));
    EXPECT_FALSE(started({{"SLURM_STEP_NUM_TASKS", "1"}, {"SLURM_PROCID", "0"}, {"SLURM_STEP_ID", "0"}}));
    EXPECT_FALSE(started({{"OMPI_COMM_WORLD_SIZE", "many"}, {"OMPI_COMM_WORLD_RANK", "0"}}));
}

} // namespace graze::mpi_start_test
