#include "graze/picture/result_picture.hpp"

#include "graze/base/input_error.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <array>
#include <set>
#include <string_view>

namespace graze {

StudyPicture default_picture(const RunRecord& run) {
    StudyPicture picture;
    picture.name = run.name;
    picture.runs = {run.name};
    const bool is_diagram = run.is_swept() || (run.kind == "record" && run.points > 1 && !run.coordinates.empty());
    picture.kind = run.kind == "atlas"          ? "atlas"
                   : is_diagram                 ? "bifurcation"
                   : run.is_followed()          ? "branch"
                   : run.is_branch()            ? "portrait"
                   : run.kind == "identify"     ? "residuals"
                   : run.kind != "basin"        ? "history"
                   : run.coordinates.size() > 1 ? "basin"
                                                : "scatter";
    return picture;
}

bool has_own_picture(const RunRecord& run, const ResultFile& file) {
    const std::size_t dot = run.name.find('.');
    const auto atlas = dot == std::string::npos ? std::nullopt : file.find_run(run.name.substr(0, dot));
    return !atlas || atlas->kind != "atlas";
}

namespace {

/// True when a picture shows branches. @throws InputError when its kind cannot show branches, or other runs are mixed
/// in
bool shows_branches(const StudyPicture& picture, const ResultFile& file) {
    std::size_t branches = 0;
    for (const std::string& name : picture.over)
        if (const auto run = file.find_run(name); run && run->is_branch())
            throw InputError(picture.place, fmt::format("run '{}' is a branch, which is not drawn over others", name),
                             "name it among the runs");
    for (const std::string& name : picture.runs) {
        const auto run = file.find_run(name);
        branches += run && run->is_branch() ? 1 : 0;
    }
    if (branches == 0)
        return false;
    if (branches < picture.runs.size())
        throw InputError(picture.place, "branches and other runs cannot be drawn together", "make a picture of each");
    for (const char* kind :
         {"branch", "history", "portrait", "scatter"}) // other kinds need samples, which branches lack
        if (picture.kind == kind)
            return true;
    throw InputError(picture.place,
                     fmt::format("run '{}' is a branch, which has no {}", picture.runs.front(), picture.kind),
                     "choose branch, portrait, history or scatter");
}

/// Names of parameters and states, which are written as symbols in titles and labels.
std::vector<std::string> symbols_of(const StudyPicture& picture, const ResultFile& file) {
    std::set<std::string> names;
    for (const std::string& run : picture.runs) {
        const Model model = StoredRun(file, run, picture.place).model;
        for (const Parameter& parameter : model.parameters)
            names.insert(parameter.name);
        for (const State& state : model.states)
            names.insert(state.name);
    }
    return {names.begin(), names.end()};
}

/// Removes repeated names, so that each run is drawn once.
void remove_repeated(std::vector<std::string>& names) {
    std::set<std::string> known;
    std::erase_if(names, [&](const std::string& name) { return !known.insert(name).second; });
}

using PictureFunction = ResultPicture (*)(const StudyPicture&, const ResultFile&);

/// What draws a kind of picture.
constexpr std::array<std::pair<std::string_view, PictureFunction>, 11> drawings{{{"atlas", atlas_picture},
                                                                                 {"basin", basin_picture},
                                                                                 {"branch", branch_picture},
                                                                                 {"history", motion_picture},
                                                                                 {"map", basin_picture},
                                                                                 {"poincare", motion_picture},
                                                                                 {"portrait", motion_picture},
                                                                                 {"regression", regression_picture},
                                                                                 {"residuals", residual_picture},
                                                                                 {"scatter", scatter_picture},
                                                                                 {"spectrum", spectrum_picture}}};

} // namespace

ResultPicture make_picture(const StudyPicture& given, const ResultFile& file) {
    StudyPicture picture = given;
    if (picture.kind.empty())
        if (const auto run = file.find_run(picture.runs.front()))
            picture.kind = default_picture(*run).kind;
    remove_repeated(picture.runs);
    remove_repeated(picture.over);
    PictureFunction draw = bifurcation_picture;
    for (const auto& [kind, drawing] : drawings)
        if (picture.kind == kind)
            draw = drawing;
    if (shows_branches(picture, file) && draw == motion_picture)
        draw = orbit_picture;
    ResultPicture result = draw(picture, file);
    if (picture.y.empty() && picture.y_labels.empty() && picture.kind != "residuals")
        drop_constant_panels(result.figure);
    result.figure.title = picture.title;
    result.figure.symbols = symbols_of(picture, file);
    result.figure.style = picture.style;
    return result;
}

} // namespace graze
