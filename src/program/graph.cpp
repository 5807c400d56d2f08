#include "program/graph.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/check.hpp"
#include "program/drawing.hpp"
#include "program/output_file.hpp"
#include "program/process.hpp"

#include <fmt/format.h>

namespace graze {

void draw_graph(const Model& model, const std::string& path) {
    const std::string ending = picture_ending(path, "--graph", {"svg", "png", "pdf", "eps", "dot"});
    const std::string graph = connectivity_graph(model);
    if (ending == "dot")
        return write_file(path, graph);
    const std::string program =
        require_drawing_program("dot", "install Graphviz (Debian: apt-get install graphviz), or ask for a .dot file");
    FileReplacement file(path);
    const ProcessResult result = run_process({program, "-T" + ending, "-o", file.temporary_path()}, graph);
    if (result.status != 0)
        throw InputError(fmt::format("Graphviz could not draw '{}': {}", path, one_line(result.output)),
                         "ask for a .dot file and look at it");
    require_well_formed_picture(file, ending, path);
    file.commit();
}

} // namespace graze
