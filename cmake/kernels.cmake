# The Taylor kernels are compiled once for each instruction set; the program picks one at run time.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(kernel_flags_avx2 -march=x86-64-v3)
    set(kernel_flags_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
    foreach(level avx2 avx512)
        set_source_files_properties(src/tape/jet_${level}.cpp PROPERTIES COMPILE_OPTIONS "${kernel_flags_${level}}")
    endforeach()
endif()
