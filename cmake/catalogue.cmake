# Embeds the shipped models, studies and designs into the library, so that the program has them wherever it is installed.
# Included from CMakeLists.txt this file adds the step to the build; as a script it is that step:
#   cmake -DOUTPUT=catalogue_data.cpp -DFUNCTION=embedded_models "-DMODELS=a.toml;b.toml" -P catalogue.cmake
if(CMAKE_SCRIPT_MODE_FILE)
    set(definitions "")
    set(entries "")
    set(index 0)
    foreach(model IN LISTS MODELS)
        get_filename_component(name "${model}" NAME_WLE)
        file(READ "${model}" bytes HEX)
        string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
        string(REPLACE "'\\x0a'," "'\\n',\n" bytes "${bytes}") # one source line for each line of the file
        string(APPEND definitions "const char text_${index}[] = {${bytes}'\\0'};\n")
        string(APPEND entries "    {\"${name}\", {text_${index}, sizeof(text_${index}) - 1}},\n")
        math(EXPR index "${index} + 1")
    endforeach()
    list(LENGTH MODELS count)
    file(WRITE "${OUTPUT}" "// Written by cmake/catalogue.cmake.
#include \"model/catalogue_data.hpp\"

#include <array>

namespace graze {
namespace {

${definitions}
const std::array<EmbeddedModel, ${count}> models = {{
${entries}}};

} // namespace

std::span<const EmbeddedModel> ${FUNCTION}() { return models; }

} // namespace graze
")
    return()
endif()

# Embeds the files of FOLDER into TARGET; FUNCTION returns them.
function(graze_embed target folder function)
    file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.toml)
    # Sort by name without the extension: with it, "a-b.toml" would come before "a.toml".
    list(TRANSFORM files REPLACE "\\.toml$" "")
    list(SORT files)
    list(TRANSFORM files APPEND ".toml")
    set(source ${CMAKE_CURRENT_BINARY_DIR}/generated/${function}.cpp)
    add_custom_command(
        OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DFUNCTION=${function} "-DMODELS=${files}" -P
                ${PROJECT_SOURCE_DIR}/cmake/catalogue.cmake
        DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/catalogue.cmake
        COMMENT "Embedding the files of ${folder}/"
        VERBATIM)
    target_sources(${target} PRIVATE ${source})
endfunction()

if(TARGET graze_model)
    graze_embed(graze_model models embedded_models)
endif()
if(TARGET graze_study)
    graze_embed(graze_study studies embedded_studies)
endif()
if(TARGET graze_design)
    graze_embed(graze_design designs embedded_designs)
endif()
