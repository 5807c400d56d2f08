# The Taylor kernels are compiled once for each instruction set; the program picks one at run time. The instruction sets
# enabled here are those that `is_supported` in src/tape/jet.cpp checks.
#
# Kernels are some thousand functions, most without loops. They are optimised in every kind of build, and compiled without
# sanitizers and debug information, with which compilers need minutes and gigabytes for them. No option of the sanitizers is
# even given, so that a compiler cache has them for all builds by one compiler.
# The code of one step of a small model about fills the processor's instruction cache; functions are therefore aligned to
# cache lines.
set(GRAZE_KERNELS all CACHE STRING
    "Instruction sets of the Taylor kernels: all, or host: the best one that this machine has, and the baseline"
)
set(kernel_flags_baseline -O3 -g0 -falign-functions=64)
set(kernel_sets baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kernel_flags_avx2 ${kernel_flags_baseline} -mavx2 -mfma -mbmi -mbmi2)
    set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl
                            -mprefer-vector-width=512)
    list(APPEND kernel_sets avx2 avx512)
    if(GRAZE_KERNELS STREQUAL "host" AND EXISTS /proc/cpuinfo)
        file(STRINGS /proc/cpuinfo features LIMIT_COUNT 1 REGEX "^flags")
        string(REGEX MATCHALL "[a-z0-9_]+" features "${features}")
        set(needed_avx2 avx2 fma bmi1 bmi2)
        set(needed_avx512 ${needed_avx2} avx512f avx512bw avx512cd avx512dq avx512vl)
        set(kernel_sets baseline)
        foreach(kernel_set IN ITEMS avx2 avx512)
            list(REMOVE_ITEM needed_${kernel_set} flags ${features})
            if(NOT needed_${kernel_set})
                set(kernel_sets baseline ${kernel_set})
            endif()
        endforeach()
    endif()
endif()
set(kernel_definitions) # of the folder `tape`
foreach(kernel_set IN LISTS kernel_sets)
    string(TOUPPER ${kernel_set} upper)
    list(APPEND kernel_definitions GRAZE_WITH_${upper})
    list(APPEND kernels ${PROJECT_SOURCE_DIR}/src/tape/jet_${kernel_set}.cpp)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/src/tape/jet_${kernel_set}.cpp PROPERTIES
                                COMPILE_OPTIONS "${kernel_flags_${kernel_set}}")
endforeach()
# A precompiled header for other instruction sets cannot be used for them.
add_library(graze_kernels OBJECT ${kernels})
set_target_properties(graze_kernels PROPERTIES POSITION_INDEPENDENT_CODE ON GRAZE_UNSANITIZED ON)
target_include_directories(graze_kernels PRIVATE include src)
target_link_libraries(graze_kernels PRIVATE fmt::fmt graze_options graze_headers)
