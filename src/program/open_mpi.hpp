#pragma once

#include <cstddef>
#include <string>

namespace graze {

// Open MPI as it is called by what its library exports, so that graze loads it only where it is started by it, and
// needs nothing of it to be compiled. All versions of the library with this name (Open MPI 3, 4 and 5) have the same
// binary interface; a test compares it with mpi.h where that is there.

namespace open_mpi {

constexpr const char* library_name = "libmpi.so.40";

struct Status {
    int source, tag, error, cancelled;
    std::size_t count;
};
using Communicator = void*;
using DataType = void*;
using Request = void*;
using ReceivedMessage = void*;

constexpr int any_source = -1, any_tag = -1, thread_funneled = 1, success = 0;

/// The functions that graze needs.
struct Functions {
    int (*init_thread)(int* count, char*** words, int required, int* provided);
    int (*finalize)();
    int (*comm_rank)(Communicator, int* rank);
    int (*comm_size)(Communicator, int* size);
    int (*isend)(const void* bytes, int count, DataType, int to, int tag, Communicator, Request*);
    int (*test)(Request*, int* is_done, Status*);
    int (*improbe)(int from, int tag, Communicator, int* is_there, ReceivedMessage*, Status*);
    int (*mrecv)(void* bytes, int count, DataType, ReceivedMessage*, Status*);
    int (*get_count)(const Status*, DataType, int* count);
    Communicator world;
    DataType byte;
};

/// Loads the library, for the rest of the process. @throws InputError when it is not there, or another one
Functions loaded();

} // namespace open_mpi

} // namespace graze
