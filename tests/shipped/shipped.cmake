# Shipped studies that take long are computed once, by tests that come before those that look at their results. CTest tells
# these where the results are; without it they compute what they look at.
set(shipped_folder ${PROJECT_BINARY_DIR}/shipped)
set(left_out_microactuator sweep) # half of the time; what looks at it is content with fewer points
foreach(study microactuator microbeam microbeam-amplitudes microbeam-stops)
    add_test(NAME shipped.${study} COMMAND bash ${PROJECT_SOURCE_DIR}/tests/shipped/compute_shipped.sh
                                           $<TARGET_FILE:graze_executable> ${shipped_folder} ${study}
                                           ${left_out_${study}}
    )
    # The cost makes ctest start them first.
    set_tests_properties(shipped.${study} PROPERTIES FIXTURES_SETUP shipped_${study} TIMEOUT 1200 COST 500)
    string(REPLACE "-" "_" name ${study}) # as it is in names of tests
    string(APPEND readers "set(fixture_of_${name} shipped_${study})\nlist(APPEND fixtures shipped_${study})\n")
endforeach()
# Names of tests are known to CTest alone.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/shipped_readers.cmake @ONLY CONTENT [[
@readers@
foreach(test IN LISTS test_study_tests test_study_slow_tests test_picture_tests)
    if(test MATCHES "^study\\.(ShippedFigures|OrbitMotion)(Slow)?\\.")
        set(needed ${fixtures})
    elseif(test MATCHES "ShippedPictures\\.[A-Za-z]+/([a-z_]+)$")
        set(needed ${fixture_of_${CMAKE_MATCH_1}})
    else()
        set(needed)
    endif()
    if(NOT needed)
        continue()
    endif()
    set_tests_properties(${test} PROPERTIES FIXTURES_REQUIRED "${needed}" ENVIRONMENT "GRAZE_SHIPPED=@shipped_folder@")
endforeach()
]])
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${PROJECT_BINARY_DIR}/generated/shipped_readers.cmake)
# The program that computes is as new as they are.
foreach(folder study picture)
    if(TARGET test_${folder})
        add_dependencies(test_${folder} graze_executable)
    endif()
endforeach()
