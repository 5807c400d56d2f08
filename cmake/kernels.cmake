# The Taylor kernels are compiled once for each instruction set; the program picks one at run time. What is switched
# on here is what `is_supported` in src/tape/jet.cpp asks for.
#
# Kernels are some thousand functions without loops. They are optimised in every kind of build, and compiled without
# sanitizers and debug information, with which compilers need minutes and gigabytes for them.
# What is run in a step of a small model about fills the processor's cache of instructions, of which each begins lines of
# its own.
set(kernel_flags_baseline -O3 -g0 -fno-sanitize=all -falign-functions=64)
set(kernel_sets baseline)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kernel_flags_avx2 ${kernel_flags_baseline} -mavx2 -mfma -mbmi -mbmi2)
    set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl
                            -mprefer-vector-width=512)
    list(APPEND kernel_sets avx2 avx512)
endif()
foreach(kernel_set IN LISTS kernel_sets)
    # What was parsed for other instructions cannot be used here.
    set_source_files_properties(
        src/tape/jet_${kernel_set}.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags_${kernel_set}}"
                                                  SKIP_PRECOMPILE_HEADERS ON
    )
endforeach()
