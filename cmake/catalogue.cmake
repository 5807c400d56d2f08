# The shipped models become part of the library, for the program to have them wherever it is installed.
# Included from CMakeLists.txt this file adds the step to the build; as a script it is that step:
#   cmake -DOUTPUT=catalogue_data.cpp "-DMODELS=a.toml;b.toml" -P catalogue.cmake
if(CMAKE_SCRIPT_MODE_FILE)
    set(definitions "")
    set(entries "")
    set(index 0)
    foreach(model IN LISTS MODELS)
        get_filename_component(name "${model}" NAME_WLE)
        file(READ "${model}" bytes HEX)
        string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
        string(REPLACE "'\\x0a'," "'\\n',\n" bytes "${bytes}") # a line for each line of the file
        string(APPEND definitions "const char text_${index}[] = {${bytes}'\\0'};\n")
        string(APPEND entries "    {\"${name}\", {text_${index}, sizeof(text_${index}) - 1}},\n")
        math(EXPR index "${index} + 1")
    endforeach()
    list(LENGTH MODELS count)
    file(WRITE "${OUTPUT}" "// Written by cmake/catalogue.cmake from the files of models/.
#include \"model/catalogue_data.hpp\"

#include <array>

namespace graze {
namespace {

${definitions}
const std::array<EmbeddedModel, ${count}> models = {{
${entries}}};

} // namespace

std::span<const EmbeddedModel> embedded_models() { return models; }

} // namespace graze
")
    return()
endif()

if(TARGET graze_model)
    file(GLOB models CONFIGURE_DEPENDS models/*.toml)
    # By name alone: with its ending, "a-b.toml" would come before "a.toml".
    list(TRANSFORM models REPLACE "\\.toml$" "")
    list(SORT models)
    list(TRANSFORM models APPEND ".toml")
    set(catalogue_source ${CMAKE_CURRENT_BINARY_DIR}/generated/catalogue_data.cpp)
    add_custom_command(
        OUTPUT ${catalogue_source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${catalogue_source} "-DMODELS=${models}" -P
                ${CMAKE_CURRENT_SOURCE_DIR}/cmake/catalogue.cmake
        DEPENDS ${models} cmake/catalogue.cmake
        COMMENT "Embedding the shipped models"
        VERBATIM)
    target_sources(graze_model PRIVATE ${catalogue_source})
endif()
