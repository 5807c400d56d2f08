# Headers that most sources include are precompiled twice: for sources that are optimised and for those that are compiled
# fast, since compilers do not let different options share them. Sources still include every header that they use.
function(add_prefix name) # NAME HEADER...
    if(GRAZE_PRECOMPILED_HEADERS)
        file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/generated/${name}.cpp CONTENT "// Carries a precompiled header.\n")
        add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/generated/${name}.cpp)
        set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
        target_link_libraries(${name} PRIVATE graze_options graze_headers fmt::fmt)
        target_precompile_headers(${name} PRIVATE ${ARGN})
    endif()
endfunction()
function(use_prefix target name)
    if(GRAZE_PRECOMPILED_HEADERS)
        target_precompile_headers(${target} REUSE_FROM ${name})
    endif()
endfunction()

set(headers <algorithm> <array> <cmath> <complex> <filesystem> <functional> <map> <memory> <numeric> <optional> <span>
           <sstream> <string> <vector> <fmt/format.h> <fmt/ranges.h>)
add_prefix(graze_prefix_computing ${headers} <Eigen/Core> <Eigen/LU> <Eigen/QR>)
add_prefix(graze_prefix_fast ${headers} <Eigen/Core>)
if(TARGET graze_prefix_fast)
    target_compile_options(graze_prefix_computing PRIVATE ${GRAZE_COMPILED_COMPUTING})
    target_compile_options(graze_prefix_fast PRIVATE ${GRAZE_COMPILED_FAST})
endif()
