# The Taylor kernels are compiled once for each instruction set; the program picks one at run time. The instruction sets
# enabled here are those that `is_supported` in src/tape/jet.cpp checks.
#
# Kernels are some thousand functions without loops. They are optimised in every kind of build, and compiled without
# sanitizers and debug information, with which compilers need minutes and gigabytes for them. No option of the sanitizers is
# even given, so that a compiler cache has them for all builds by one compiler.
# The code of one step of a small model about fills the processor's instruction cache; functions are therefore aligned to
# cache lines.
set(kernel_flags_baseline -O3 -g0 -falign-functions=64)
set(kernel_sets baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kernel_flags_avx2 ${kernel_flags_baseline} -mavx2 -mfma -mbmi -mbmi2)
    set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl
                            -mprefer-vector-width=512)
    list(APPEND kernel_sets avx2 avx512)
endif()
set(kernels)
foreach(kernel_set IN LISTS kernel_sets)
    list(APPEND kernels ${PROJECT_SOURCE_DIR}/src/tape/jet_${kernel_set}.cpp)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/src/tape/jet_${kernel_set}.cpp PROPERTIES
                                COMPILE_OPTIONS "${kernel_flags_${kernel_set}}")
endforeach()
# A precompiled header for other instruction sets cannot be used for them.
add_library(graze_kernels OBJECT ${kernels})
set_target_properties(graze_kernels PROPERTIES POSITION_INDEPENDENT_CODE ON GRAZE_UNSANITIZED ON)
target_include_directories(graze_kernels PRIVATE include src)
target_link_libraries(graze_kernels PRIVATE fmt::fmt graze_options graze_headers)
