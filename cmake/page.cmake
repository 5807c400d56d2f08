# The page that `graze view` serves: npm gets the packages of page/package-lock.json, esbuild bundles them with the
# TypeScript of page/source, and assemble.py makes one HTML file, which becomes a source of graze_page. Without these
# tools the library has no page, and says so.
find_program(GRAZE_NPM npm)
find_program(GRAZE_ESBUILD esbuild)
find_package(Python3 COMPONENTS Interpreter QUIET)
mark_as_advanced(GRAZE_NPM GRAZE_ESBUILD)
if(GRAZE_NPM AND GRAZE_ESBUILD AND Python3_FOUND AND EXISTS ${PROJECT_SOURCE_DIR}/page/package-lock.json)
    set(GRAZE_PAGE_POSSIBLE ON)
else()
    set(GRAZE_PAGE_POSSIBLE OFF)
endif()
option(GRAZE_PAGE "Build the page of `graze view`; npm gets its packages from the network" ${GRAZE_PAGE_POSSIBLE})

set(page_source ${CMAKE_CURRENT_BINARY_DIR}/generated/page_html.cpp)
if(GRAZE_PAGE)
    set(page_folder ${PROJECT_SOURCE_DIR}/page)
    set(page_build ${CMAKE_CURRENT_BINARY_DIR}/page)
    set(page_modules ${page_build}/node_modules)
    file(GLOB page_scripts CONFIGURE_DEPENDS ${page_folder}/source/*.ts)
    # The working tree stays as it is: packages are installed in the build folder.
    add_custom_command(
        OUTPUT ${page_build}/installed
        COMMAND ${CMAKE_COMMAND} -E make_directory ${page_build}
        COMMAND ${CMAKE_COMMAND} -E copy ${page_folder}/package.json ${page_folder}/package-lock.json ${page_build}
        COMMAND ${CMAKE_COMMAND} -D npm=${GRAZE_NPM} -D folder=${page_build} -P ${PROJECT_SOURCE_DIR}/cmake/page_packages.cmake
        COMMAND ${CMAKE_COMMAND} -E touch ${page_build}/installed
        DEPENDS ${page_folder}/package.json ${page_folder}/package-lock.json ${PROJECT_SOURCE_DIR}/cmake/page_packages.cmake
        COMMENT "Getting the packages of the page"
        VERBATIM)
    set(bundle ${CMAKE_COMMAND} -E env NODE_PATH=${page_modules} ${GRAZE_ESBUILD} --bundle --minify --target=es2020
               --charset=utf8 --log-level=warning)
    add_custom_command(
        OUTPUT ${page_source} ${page_build}/page.html
        COMMAND ${bundle} --format=iife ${page_folder}/source/main.ts --outfile=${page_build}/page.js
        COMMAND ${bundle} ${page_folder}/style_bundle.css --outfile=${page_build}/page.css
        COMMAND ${Python3_EXECUTABLE} ${page_folder}/assemble.py --page ${page_folder}/page.html
                --script ${page_build}/page.js --style ${page_build}/page.css --modules ${page_modules}
                --html ${page_build}/page.html --source ${page_source}
        DEPENDS ${page_build}/installed ${page_scripts} ${page_folder}/page.html ${page_folder}/style.css
                ${page_folder}/style_bundle.css ${page_folder}/assemble.py
        COMMENT "Bundling the page"
        VERBATIM)
    # Packages that only tests in the browser need are in a folder of their own, so that their licences are not those of
    # the page.
    add_custom_target(page_tools
        COMMAND ${CMAKE_COMMAND} -E make_directory ${page_build}/tools
        COMMAND ${CMAKE_COMMAND} -E copy ${page_folder}/package.json ${page_folder}/package-lock.json ${page_build}/tools
        COMMAND ${CMAKE_COMMAND} -E chdir ${page_build}/tools ${GRAZE_NPM} ci --ignore-scripts --no-audit --no-fund
        COMMENT "Getting the tools that test the page"
        VERBATIM)
    # Checks the types, which esbuild only removes, beside the packages that declare some of them; and the format.
    add_custom_target(page_check
        COMMAND ${CMAKE_COMMAND} -E rm -rf ${page_build}/tools/source
        COMMAND ${CMAKE_COMMAND} -E copy_directory ${page_folder}/source ${page_build}/tools/source
        COMMAND ${CMAKE_COMMAND} -E copy ${page_folder}/tsconfig.json ${page_build}/tools
        COMMAND ${CMAKE_COMMAND} -E chdir ${page_build}/tools node_modules/.bin/tsc --noEmit -p .
        COMMAND ${page_build}/tools/node_modules/.bin/prettier --check --config ${page_folder}/package.json
                ${page_folder}/source/*.ts ${PROJECT_SOURCE_DIR}/tests/browser/*.mjs
        COMMENT "Checking types and format of the page"
        VERBATIM)
    add_dependencies(page_check page_tools)
else()
    file(CONFIGURE OUTPUT ${page_source} CONTENT "#include \"page/page_html.hpp\"

namespace graze {

std::string_view page_html() { return {}; }

} // namespace graze
")
endif()
if(TARGET graze_page)
    target_sources(graze_page PRIVATE ${page_source})
    set_source_files_properties(${page_source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endif()
