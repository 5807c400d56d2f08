# Tests by folder, examples, the installed package, the documentation. Suites whose name ends in "Slow" are labelled
# slow, so that `ctest -LE slow` leaves them out.
find_package(GTest REQUIRED)
include(GoogleTest)

# Only one small source contains absolute paths, so that a compiler cache serves clones in other folders.
file(WRITE ${PROJECT_BINARY_DIR}/generated/places.cpp.in
     "#include \"places.hpp\"\n\nnamespace graze::testing {\n\n\
const char* const source_folder = \"@PROJECT_SOURCE_DIR@\";\n\
const char* const program_file = \"@PROJECT_BINARY_DIR@/bin/graze\";\n\n} // namespace graze::testing\n"
)
configure_file(${PROJECT_BINARY_DIR}/generated/places.cpp.in ${PROJECT_BINARY_DIR}/generated/places.cpp @ONLY)
add_library(graze_places OBJECT ${PROJECT_BINARY_DIR}/generated/places.cpp)
target_include_directories(graze_places PUBLIC tests)

# The headers that all tests include are precompiled once, with the definitions of the libraries of all folders.
if(GRAZE_PRECOMPILED_HEADERS)
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/generated/test_prefix.cpp CONTENT "// Carries a precompiled header.\n")
    add_library(graze_test_prefix OBJECT ${PROJECT_BINARY_DIR}/generated/test_prefix.cpp)
    target_link_libraries(graze_test_prefix PRIVATE GTest::gtest GTest::gmock graze_options graze_headers fmt::fmt)
    foreach(folder IN LISTS GRAZE_FOLDERS)
        target_link_libraries(graze_test_prefix PRIVATE ${GRAZE_NEEDS_${folder}})
    endforeach()
    target_compile_options(graze_test_prefix PRIVATE ${GRAZE_TESTS_COMPILED})
    # Eigen comes before fmt, which has g++ optimise its functions: g++ 12 would then parse intrinsics as if it optimised.
    target_precompile_headers(
        graze_test_prefix PRIVATE <Eigen/Core> <gtest/gtest.h> <gmock/gmock.h> <fmt/format.h> <algorithm> <functional>
    )
endif()

# Tests of wrong uses are linked with the whole library.
set(before_misuse ${GRAZE_FOLDERS})

# Simulated instruments are tested with the clients of real ones.
set(before_instrument ${before_acquire})

# Under the thread sanitizer only tests of code that runs in several threads are built.
set(test_folders ${GRAZE_FOLDERS} instrument program misuse)
if(GRAZE_SANITIZERS STREQUAL "thread")
    set(test_folders threads)
    set(before_threads ${before_design})
    set(test_threads base/thread_team base/turns sweep/plan study/run_schedule study/runner study/part_exchange study/workers study/shared_model study/side_by_side branch/yield
                     trip/disturbed_trip design/value_map page/event_stream page/job_queue)
    # Of the page only what runs in threads of its own, without the folders that it needs otherwise.
    set(threads_of_page src/page/event_stream.cpp src/page/job_queue.cpp src/page/error_answer.cpp src/page/json_text.cpp)
endif()

set(GRAZE_UNTESTED "" CACHE STRING "Folders whose tests are left out")
if(GRAZE_UNTESTED)
    list(REMOVE_ITEM test_folders ${GRAZE_UNTESTED})
endif()

foreach(folder IN LISTS test_folders)
    file(GLOB sources CONFIGURE_DEPENDS tests/${folder}/*.cpp)
    list(TRANSFORM test_${folder} REPLACE "(.+)" "tests/\\1_test.cpp" OUTPUT_VARIABLE chosen)
    list(APPEND sources ${chosen} ${${folder}_of_page})
    if(NOT sources OR (folder STREQUAL program AND NOT TARGET graze_program))
        continue()
    endif()
    add_executable(test_${folder} ${sources})
    target_include_directories(test_${folder} PRIVATE include src tests)
    target_link_libraries(test_${folder} PRIVATE GTest::gtest_main GTest::gmock graze_options graze_headers fmt::fmt)
    if(folder STREQUAL program)
        # Objects come before those of tests, and libraries behind them. Of what headers define several times, as CLI11's
        # do, linkers take the first: it is to be the program's, and not that of tests, which are not optimised.
        foreach(part IN ITEMS kernels ${GRAZE_FOLDERS} program)
            target_sources(test_${folder} PRIVATE $<TARGET_OBJECTS:graze_${part}>)
        endforeach()
        target_link_libraries(test_${folder} PRIVATE graze_program)
        add_dependencies(test_${folder} graze_executable)
    else()
        if(folder MATCHES "^(acquire|instrument|misuse)$")
            target_link_libraries(test_${folder} PRIVATE graze_instrument)
        endif()
        foreach(part IN LISTS before_${folder})
            target_link_libraries(test_${folder} PRIVATE graze_${part})
        endforeach()
    endif()
    if(GRAZE_PRECOMPILED_HEADERS)
        target_precompile_headers(test_${folder} REUSE_FROM graze_test_prefix)
        target_compile_definitions(test_${folder} PRIVATE $<TARGET_PROPERTY:graze_test_prefix,COMPILE_DEFINITIONS>)
    endif()
    target_link_libraries(test_${folder} PRIVATE graze_places)
    # Small batches: a test is changed, compiled and run again more often than other sources.
    compile_together(test_${folder} 8 ${sources})
    target_compile_options(test_${folder} PRIVATE ${GRAZE_TESTS_COMPILED})
    gtest_discover_tests(
        test_${folder} TEST_PREFIX ${folder}. TEST_FILTER "-*Slow.*" DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES
        TEST_LIST test_${folder}_tests
        PROPERTIES TIMEOUT 600
    )
    gtest_discover_tests(
        test_${folder} TEST_PREFIX ${folder}. TEST_FILTER "*Slow.*" DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES
        TEST_LIST test_${folder}_slow_tests
        PROPERTIES TIMEOUT 1200 LABELS slow
    )
endforeach()

# Examples are compiled as a user's programs are: with the public interface only.
file(GLOB examples CONFIGURE_DEPENDS examples/*.cpp)
foreach(source IN LISTS examples)
    cmake_path(GET source STEM name)
    add_executable(example_${name} ${source})
    target_link_libraries(example_${name} PRIVATE graze::graze graze_options)
    set_target_properties(example_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/examples)
    add_test(NAME example.${name} COMMAND example_${name} WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/examples)
    set_tests_properties(example.${name} PROPERTIES TIMEOUT 300)
endforeach()

add_test(
    NAME layers COMMAND bash ${PROJECT_SOURCE_DIR}/tests/layers/check_layers.sh ${PROJECT_SOURCE_DIR} ${GRAZE_FOLDERS}
                        instrument python program
)

find_package(Python3 COMPONENTS Interpreter QUIET)
if(Python3_FOUND)
    add_test(NAME names COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/layers/check_names.py
                                ${PROJECT_SOURCE_DIR}
    )
    add_test(NAME headers COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/layers/check_headers.py
                                  ${PROJECT_SOURCE_DIR}
    )
    add_test(NAME promises COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/documentation/check_promises.py
                                   ${PROJECT_SOURCE_DIR}
    )
endif()

if(TARGET graze_executable)
    if(GRAZE_INSTALL)
        add_test(
            NAME package
            COMMAND
                ${CMAKE_COMMAND} -D build=${PROJECT_BINARY_DIR} -D work=${PROJECT_BINARY_DIR}/package -D
                compiler=${CMAKE_CXX_COMPILER} -D generator=${CMAKE_GENERATOR} -D sanitizers=${GRAZE_SANITIZERS} -P
                ${PROJECT_SOURCE_DIR}/tests/package/install_and_use.cmake
        )
        find_program(SHLIBDEPS dpkg-shlibdeps)
        find_program(FILE_COMMAND file)
        find_program(FAKEROOT fakeroot)
        if(SHLIBDEPS AND FILE_COMMAND AND FAKEROOT AND NOT GRAZE_SANITIZERS)
            add_test(NAME package.debian COMMAND bash ${PROJECT_SOURCE_DIR}/tests/package/debian.sh
                                                 ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER} ${CMAKE_GENERATOR}
            )
        endif()
    endif()
    if(NOT GRAZE_SANITIZERS) # Open MPI itself leaks
        add_test(NAME mpi COMMAND bash ${PROJECT_SOURCE_DIR}/tests/cluster/mpi.sh $<TARGET_FILE:graze_executable>
                                  ${PROJECT_BINARY_DIR}/mpi
        )
        set_tests_properties(mpi PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 COST 100)
    endif()
    add_test(NAME layout.other_readers COMMAND bash ${PROJECT_SOURCE_DIR}/tests/layout/readers/read_drawings.sh
                                               $<TARGET_FILE:graze_executable> ${PROJECT_BINARY_DIR}/drawings
    )
    set_tests_properties(layout.other_readers PROPERTIES SKIP_RETURN_CODE 77 LABELS slow TIMEOUT 600)
    # The cost makes ctest start the longest test first.
    add_test(NAME demo COMMAND bash ${PROJECT_SOURCE_DIR}/examples/demo.sh ${PROJECT_BINARY_DIR}/demo)
    set_tests_properties(
        demo PROPERTIES ENVIRONMENT "GRAZE=$<TARGET_FILE:graze_executable>" LABELS slow TIMEOUT 1200 COST 1000
    )
    include(tests/documentation/documentation.cmake)
    if(NOT GRAZE_SANITIZERS) # under which those that look at them are left out
        include(tests/shipped/shipped.cmake)
    endif()
endif()
