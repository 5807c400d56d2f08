# The program stands on the library's public interface; all of it but `main` is a library of its own, for its tests.
file(GLOB program_sources CONFIGURE_DEPENDS src/program/*.cpp)
list(FILTER program_sources EXCLUDE REGEX "/main\\.cpp$")
if(program_sources)
    add_library(graze_program STATIC ${program_sources})
    target_include_directories(graze_program PUBLIC include PRIVATE src)
    target_link_libraries(graze_program PUBLIC graze fmt::fmt CLI11::CLI11 PRIVATE graze_options)
    target_compile_definitions(graze_program PRIVATE GRAZE_VERSION="${PROJECT_VERSION}")
endif()
if(TARGET graze_program AND EXISTS ${PROJECT_SOURCE_DIR}/src/program/main.cpp)
    add_executable(graze_executable src/program/main.cpp)
    target_link_libraries(graze_executable PRIVATE graze_program graze_options)
    # In a folder of its own, which can be put on the PATH without anything else.
    set_target_properties(
        graze_executable PROPERTIES OUTPUT_NAME graze RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin
                                    INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR}
    )
endif()
