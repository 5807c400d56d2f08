# Installs graze into a folder, moves that folder, and builds and runs a consumer with it alone.
# Variables: build (the build folder), work (a folder to work in), compiler, generator; sanitizers, if any.
function(must_run)
    execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT RESULT_VARIABLE result)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "failed with ${result}: ${ARGV}")
    endif()
endfunction()

file(REMOVE_RECURSE ${work})
must_run(${CMAKE_COMMAND} --install ${build} --prefix ${work}/first)
# An installed package must not remember where it was installed.
file(RENAME ${work}/first ${work}/prefix)
file(GLOB installed_models ${work}/prefix/share/graze/models/*.toml)
if(NOT installed_models)
    message(FATAL_ERROR "no models were installed")
endif()
must_run(${work}/prefix/bin/graze models)
foreach(file man/man1/graze.1 man/man1/graze-run.1 bash-completion/completions/graze zsh/site-functions/_graze
             fish/vendor_completions.d/graze.fish
)
    if(NOT EXISTS ${work}/prefix/share/${file})
        message(FATAL_ERROR "share/${file} was not installed")
    endif()
endforeach()

# Links of the installed documentation must have targets.
must_run(bash ${CMAKE_CURRENT_LIST_DIR}/../documentation/check_links.sh ${work}/prefix/share/doc/graze)

# The consumer is copied, so that no relative path leads back into the repository.
file(COPY ${CMAKE_CURRENT_LIST_DIR}/consumer DESTINATION ${work})
set(flags)
if(sanitizers)
    set(flags -D CMAKE_CXX_FLAGS=-fsanitize=${sanitizers})
endif()
must_run(
    ${CMAKE_COMMAND} -S ${work}/consumer -B ${work}/build -G ${generator} -D CMAKE_CXX_COMPILER=${compiler} -D
    CMAKE_PREFIX_PATH=${work}/prefix -D headers=${work}/prefix/include ${flags}
)
must_run(${CMAKE_COMMAND} --build ${work}/build)
must_run(${work}/build/consumer)

# The same for the project that the documentation quotes.
file(COPY ${CMAKE_CURRENT_LIST_DIR}/../../examples/project DESTINATION ${work})
must_run(
    ${CMAKE_COMMAND} -S ${work}/project -B ${work}/project-build -G ${generator} -D CMAKE_CXX_COMPILER=${compiler} -D
    CMAKE_PREFIX_PATH=${work}/prefix ${flags}
)
must_run(${CMAKE_COMMAND} --build ${work}/project-build)
must_run(${work}/project-build/impacts)
