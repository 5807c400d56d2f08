# The installed package: find_package(graze) gives the target graze::graze.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/graze)
install(TARGETS graze EXPORT graze)
install(DIRECTORY include/graze TYPE INCLUDE FILES_MATCHING PATTERN "*.hpp")
install(EXPORT graze NAMESPACE graze:: FILE graze-targets.cmake DESTINATION ${package_folder})
configure_package_config_file(
    cmake/graze-config.cmake.in graze-config.cmake INSTALL_DESTINATION ${package_folder}
    NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO
)
write_basic_package_version_file(graze-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/graze-config.cmake ${PROJECT_BINARY_DIR}/graze-config-version.cmake
        DESTINATION ${package_folder}
)

if(TARGET graze_executable)
    install(TARGETS graze_executable)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/manual/man1 TYPE MAN FILES_MATCHING PATTERN "*.1")
    install(FILES ${PROJECT_BINARY_DIR}/manual/graze DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${PROJECT_BINARY_DIR}/manual/_graze DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
    install(FILES ${PROJECT_BINARY_DIR}/manual/study.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/graze)
    install(FILES ${PROJECT_BINARY_DIR}/manual/graze.fish
            DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
    )
endif()
install(DIRECTORY models studies designs DESTINATION ${CMAKE_INSTALL_DATADIR}/graze FILES_MATCHING PATTERN "*.toml")
# Pages are installed with the tree of the repository, so that links between them hold, together with the files to which
# they link.
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md TYPE DOC)
install(DIRECTORY docs examples notebooks TYPE DOC)
