# The Taylor kernels are compiled once for each instruction set; the program picks one at run time. What is switched
# on here is what `is_supported` in src/tape/jet.cpp asks for.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kernel_flags_avx2 -mavx2 -mfma -mbmi -mbmi2)
    set(kernel_flags_avx512 ${kernel_flags_avx2} -mavx512f -mavx512bw -mavx512cd -mavx512dq -mavx512vl
                            -mprefer-vector-width=512)
    foreach(level avx2 avx512)
        set_source_files_properties(src/tape/jet_${level}.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags_${level}}")
    endforeach()
endif()
