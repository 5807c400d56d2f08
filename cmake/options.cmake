# Compiler options and dependencies of everything here. Consumers of the library inherit none of them.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

if(PROJECT_IS_TOP_LEVEL)
    set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
    if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
        set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
    endif()
    find_program(CCACHE ccache)
    if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
        # Paths in this repository are hashed relative to it, so that clones in other folders share the compiler cache.
        set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
                                        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
                                        ${CCACHE}
        )
    endif()
endif()

find_package(fmt REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(NLopt REQUIRED)
# Only the headers of Asio are used.
find_package(Boost 1.74 REQUIRED)
find_package(Ceres REQUIRED)
find_package(nlohmann_json 3.10 REQUIRED)
find_package(Threads REQUIRED)
# Long runs may compute by machine code, which this library assembles. Without it only speed is lost.
find_package(asmjit CONFIG QUIET)
set(native OFF)
if(asmjit_FOUND AND UNIX AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(native ON)
endif()
option(GRAZE_NATIVE "Make machine code for long runs, on x86-64; needs AsmJit" ${native})
if(GRAZE_NATIVE)
    find_package(asmjit CONFIG REQUIRED)
endif()
include(cmake/hdf5.cmake)
include(cmake/httplib.cmake)

# Contractions to fused operations happen only where the source asks for them: lanes and scalar must agree bit for bit.
add_library(graze_options INTERFACE)
target_compile_options(graze_options INTERFACE -ffp-contract=off)
option(GRAZE_WARNINGS "Let compilers warn" ON)
if(GRAZE_WARNINGS)
    target_compile_options(graze_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-psabi)
else() # which takes a fiftieth less time
    target_compile_options(graze_options INTERFACE -w)
endif()
# g++ 12 sees an overlapping copy in every `"text" + string` (its bug 105651).
target_compile_options(graze_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# g++ frees memory less often, which saves a tenth of the time for a fifth more memory, 1.5 GB in the largest file.
option(GRAZE_MEMORY_FOR_TIME "Let g++ take more memory and less time" ON)
if(GRAZE_MEMORY_FOR_TIME)
    target_compile_options(
        graze_options
        INTERFACE "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-expand=1000 --param ggc-min-heapsize=2000000>"
    )
endif()
if(GRAZE_WARNINGS_AS_ERRORS)
    target_compile_options(graze_options INTERFACE -Werror)
endif()
if(GRAZE_SANITIZERS)
    string(REPLACE "," ";" sanitizers "${GRAZE_SANITIZERS}")
    set(sanitize -fsanitize=${GRAZE_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
        list(APPEND sanitize -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizers.ignore)
        # The address sanitizer finds these mistakes as well, and checks of every access double the time to compile.
        if("undefined" IN_LIST sanitizers)
            list(APPEND sanitize -fno-sanitize=null,alignment,object-size,vptr)
        endif()
    endif()
    # Targets with this property are compiled without: see cmake/kernels.cmake.
    target_compile_options(graze_options INTERFACE "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:GRAZE_UNSANITIZED>>>:${sanitize}>")
    target_link_options(graze_options INTERFACE ${sanitize})
endif()

# Only the headers of Eigen and toml++ are used, so that consumers of a static libgraze.a need not link them.
add_library(graze_headers INTERFACE)
target_include_directories(
    graze_headers SYSTEM INTERFACE
    $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>
    $<TARGET_PROPERTY:tomlplusplus::tomlplusplus,INTERFACE_INCLUDE_DIRECTORIES>
)

# Folders that do not compute for long, and tests, which compute in the library: their optimisation would take longer
# than it saves (-Og takes a quarter less than -O1). Those that compute for long do it in the Taylor kernels, which have
# options of their own, so that -O3 would make them larger rather than faster.
set(GRAZE_COMPILED_FAST $<$<CONFIG:Release>:-Og>)
set(GRAZE_COMPILED_COMPUTING $<$<CONFIG:Release>:-O2>)
set(GRAZE_TESTS_COMPILED $<$<CONFIG:Release>:-O0>)
if(GRAZE_SANITIZERS)
    set(GRAZE_COMPILED_FAST -O0)
    set(GRAZE_TESTS_COMPILED -O0)
endif()
