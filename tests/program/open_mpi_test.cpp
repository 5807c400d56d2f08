#include "program/open_mpi.hpp"

// Debian's link to the header of the MPI that is chosen there.
#if __has_include(<mpi/mpi.h>)
#define OMPI_SKIP_MPICXX 1
#include <mpi/mpi.h>
#endif

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>

namespace graze::open_mpi_test {

#ifdef OPEN_MPI

template <class Own, class Theirs>
constexpr bool same = sizeof(Own) == sizeof(Theirs) && std::is_pointer_v<Own> == std::is_pointer_v<Theirs>;
static_assert(same<open_mpi::Communicator, MPI_Comm> && same<open_mpi::DataType, MPI_Datatype> &&
              same<open_mpi::Request, MPI_Request> && same<open_mpi::ReceivedMessage, MPI_Message>);
static_assert(sizeof(open_mpi::Status) == sizeof(MPI_Status) &&
              offsetof(open_mpi::Status, source) == offsetof(MPI_Status, MPI_SOURCE) &&
              offsetof(open_mpi::Status, tag) == offsetof(MPI_Status, MPI_TAG) &&
              offsetof(open_mpi::Status, error) == offsetof(MPI_Status, MPI_ERROR));
static_assert(open_mpi::any_source == MPI_ANY_SOURCE && open_mpi::any_tag == MPI_ANY_TAG &&
              open_mpi::success == MPI_SUCCESS && open_mpi::thread_funneled == MPI_THREAD_FUNNELED);

/// The same function, but for the types of handles.
template <class Own, class Theirs>
struct SameCall : std::false_type {};
template <class... Own, class... Theirs>
struct SameCall<int (*)(Own...), int(Theirs...)>
    : std::bool_constant<sizeof...(Own) == sizeof...(Theirs) && (same<Own, Theirs> && ...)> {};
using Functions = open_mpi::Functions;
static_assert(SameCall<decltype(Functions::init_thread), decltype(MPI_Init_thread)>::value);
static_assert(SameCall<decltype(Functions::finalize), decltype(MPI_Finalize)>::value);
static_assert(SameCall<decltype(Functions::comm_rank), decltype(MPI_Comm_rank)>::value);
static_assert(SameCall<decltype(Functions::comm_size), decltype(MPI_Comm_size)>::value);
static_assert(SameCall<decltype(Functions::isend), decltype(MPI_Isend)>::value);
static_assert(SameCall<decltype(Functions::test), decltype(MPI_Test)>::value);
static_assert(SameCall<decltype(Functions::improbe), decltype(MPI_Improbe)>::value);
static_assert(SameCall<decltype(Functions::mrecv), decltype(MPI_Mrecv)>::value);
static_assert(SameCall<decltype(Functions::get_count), decltype(MPI_Get_count)>::value);

TEST(OpenMpi, IsAsItsHeaderSays) {
    const open_mpi::Functions functions = open_mpi::loaded();
    EXPECT_NE(functions.world, nullptr);
    EXPECT_NE(functions.byte, nullptr);
}

#else

TEST(OpenMpi, IsAsItsHeaderSays) {
    GTEST_SKIP() << "there is no mpi.h of Open MPI";
}

#endif

} // namespace graze::open_mpi_test
