#include "program/open_mpi.hpp"

#include "graze/base/input_error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace graze::open_mpi {

namespace {

[[noreturn]] void refuse() {
    const char* reason = dlerror();
    throw InputError(fmt::format("this is one of several processes, and it cannot load Open MPI, by which they "
                                 "would work together: {}",
                                 reason == nullptr ? library_name : reason),
                     "install it (on Debian openmpi-bin) on all machines and start them by its mpirun, or let each "
                     "process compute a part of its own by --part");
}

template <class Pointer>
void find(void* library, const char* name, Pointer& pointer) {
    void* const symbol = dlsym(library, name);
    if (symbol == nullptr)
        refuse();
    pointer = reinterpret_cast<Pointer>(symbol); // as POSIX has it
}

} // namespace

Functions loaded() {
    void* const library = dlopen(library_name, RTLD_NOW | RTLD_GLOBAL); // its plugins look for it among the loaded ones
    if (library == nullptr)
        refuse();
    Functions functions{};
    find(library, "MPI_Init_thread", functions.init_thread);
    find(library, "MPI_Finalize", functions.finalize);
    find(library, "MPI_Comm_rank", functions.comm_rank);
    find(library, "MPI_Comm_size", functions.comm_size);
    find(library, "MPI_Isend", functions.isend);
    find(library, "MPI_Test", functions.test);
    find(library, "MPI_Improbe", functions.improbe);
    find(library, "MPI_Mrecv", functions.mrecv);
    find(library, "MPI_Get_count", functions.get_count);
    find(library, "ompi_mpi_comm_world", functions.world);
    find(library, "ompi_mpi_byte", functions.byte);
    return functions;
}

} // namespace graze::open_mpi
