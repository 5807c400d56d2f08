# Compiles several sources of a folder at once (unity builds), since most of the work is parsing headers and instantiating
# templates. Sources whose private names collide stay apart.
option(GRAZE_TOGETHER "Compile several sources at once; needs Python" OFF)
if(GRAZE_TOGETHER)
    find_package(Python3 COMPONENTS Interpreter)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/batches.py)
    # A name of one source may be a local name of the next; and in a unity build g++ takes unnamed namespaces for those of a
    # header.
    target_compile_options(graze_options INTERFACE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()

# Where everything is compiled once, and nothing is changed and compiled again, larger batches save time.
set(times 1)
if(DEFINED ENV{CI})
    set(times 3)
endif()
set(GRAZE_BATCHES ${times} CACHE STRING "How many times more sources are compiled at once than suits repeated compiling")

function(compile_together target most) # TARGET MOST SOURCE...
    if(NOT GRAZE_TOGETHER OR NOT Python3_FOUND)
        return()
    endif()
    math(EXPR most "${most} * ${GRAZE_BATCHES}")
    execute_process(
        COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/batches.py ${most} ${ARGN}
        OUTPUT_VARIABLE lines OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY
    )
    string(REPLACE "\n" " " lines "${lines}")
    separate_arguments(lines UNIX_COMMAND "${lines}")
    foreach(line IN LISTS lines)
        list(GET line 0 batch)
        list(GET line 1 source)
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${batch})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
