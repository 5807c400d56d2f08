# Every page of the documentation is run by a test of its own; another test checks the links between pages.
set(runner ${CMAKE_CURRENT_LIST_DIR}/run_page.sh)
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md)
list(APPEND pages ${PROJECT_SOURCE_DIR}/README.md)
foreach(page IN LISTS pages)
    cmake_path(RELATIVE_PATH page BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    add_test(NAME documentation.${name}
             COMMAND bash ${runner} ${page} ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/documentation/${name}
    )
    set_tests_properties(
        documentation.${name} PROPERTIES TIMEOUT 600 ENVIRONMENT_MODIFICATION
                                         "PATH=path_list_prepend:$<TARGET_FILE_DIR:graze_executable>"
    )
endforeach()
if(Python3_FOUND)
    add_test(NAME documentation.keys COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/check_keys.py
                                             $<TARGET_FILE:graze_executable> ${PROJECT_SOURCE_DIR}/docs/study-format.md
    )
endif()
add_test(NAME documentation.links COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/check_links.sh ${PROJECT_SOURCE_DIR})

# Tests of the runner itself: each page named bad_* has one mistake, which the runner must find.
file(GLOB cases CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/cases/*.md)
foreach(page IN LISTS cases)
    cmake_path(GET page STEM name)
    add_test(NAME documentation.runner.${name}
             COMMAND bash ${runner} ${page} ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/documentation/runner/${name}
    )
    if(name MATCHES "^bad_")
        set_tests_properties(documentation.runner.${name} PROPERTIES WILL_FAIL ON)
    endif()
endforeach()
