# The program uses only the library's public interface; all of it but `main` is a library, so that tests can link it.
file(GLOB program_sources CONFIGURE_DEPENDS src/program/*.cpp)
list(FILTER program_sources EXCLUDE REGEX "/main\\.cpp$")
if(program_sources)
    add_library(graze_program STATIC ${program_sources})
    set_target_properties(graze_program PROPERTIES POSITION_INDEPENDENT_CODE ON)
    compile_together(graze_program 24 ${program_sources})
    target_include_directories(graze_program PUBLIC include PRIVATE src)
    target_link_libraries(graze_program PUBLIC graze_instrument graze fmt::fmt CLI11::CLI11 PRIVATE graze_options)
    target_compile_options(graze_program PRIVATE ${GRAZE_COMPILED_FAST})
    use_prefix(graze_program graze_prefix_fast)
    target_compile_definitions(graze_program PRIVATE GRAZE_VERSION="${PROJECT_VERSION}")
endif()
if(TARGET graze_program AND EXISTS ${PROJECT_SOURCE_DIR}/src/program/main.cpp)
    add_executable(graze_executable src/program/main.cpp)
    target_include_directories(graze_executable PRIVATE src)
    target_link_libraries(graze_executable PRIVATE graze_program graze_options)
    # The program gets a folder of its own, which can be put on the PATH.
    set_target_properties(
        graze_executable PROPERTIES OUTPUT_NAME graze RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin
    )
    # A shared library has the same place relative to that folder as after installation, so that the path to it does not
    # change then: CMake would pad the shorter of two paths with empty ones, which mean the current folder.
    if(BUILD_SHARED_LIBS)
        set_target_properties(graze PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR})
        set_target_properties(
            graze_executable PROPERTIES INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR} BUILD_WITH_INSTALL_RPATH ON
        )
    endif()
endif()

# The program itself writes its manual pages and shell completions.
if(TARGET graze_executable AND GRAZE_INSTALL)
    set(pages ${PROJECT_BINARY_DIR}/manual)
    add_custom_command(
        OUTPUT ${pages}/written
        COMMAND ${CMAKE_COMMAND} -E rm -rf ${pages}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}
        COMMAND graze_executable help --write ${pages}/man1 > ${pages}/list
        COMMAND graze_executable run --schema > ${pages}/study.schema.json
        COMMAND graze_executable completion bash --output ${pages}/graze
        COMMAND graze_executable completion zsh --output ${pages}/_graze
        COMMAND graze_executable completion fish --output ${pages}/graze.fish
        COMMAND ${CMAKE_COMMAND} -E touch ${pages}/written
        DEPENDS graze_executable
        COMMENT "Writing pages for man and completion for shells"
        VERBATIM
    )
    add_custom_target(graze_manual ALL DEPENDS ${pages}/written)
endif()
