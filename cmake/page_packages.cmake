# Lets npm get the packages of the page into a folder that has package.json and package-lock.json.
execute_process(
    COMMAND ${npm} ci --omit=dev --ignore-scripts --no-audit --no-fund WORKING_DIRECTORY ${folder} RESULT_VARIABLE failed
)
if(failed)
    message(FATAL_ERROR "npm could not get the packages of the page of `graze view`. Without a network, build without the page: "
                        "cmake --preset release -D GRAZE_PAGE=OFF, and again what you did"
    )
endif()
