#include "graze/base/input_error.hpp"
#include "graze/study/stored_study.hpp"
#include "picture/atlas_drawing.hpp"
#include "picture/grid_axis.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace graze {

namespace {

DrawnAtlas drawn_atlas(const StudyPicture& picture, const ResultFile& file) {
    const std::string& name = picture.runs.front();
    StoredRun run(file, name, picture.place);
    if (picture.runs.size() > 1 || run.record.kind != name_of(RunKind::atlas))
        throw InputError(picture.place,
                         picture.runs.size() > 1
                             ? "several runs cannot be drawn as one atlas"
                             : fmt::format("run '{}' is of kind {}, not an atlas", name, run.record.kind),
                         picture.runs.size() > 1 ? "make a picture of each" : "choose another kind of picture");
    DrawnAtlas atlas{std::move(run), atlas_findings(stored_study(file), name, file)};
    std::map<std::size_t, std::string> directions; // by number of the motion
    auto rows = atlas.run.rows({.columns = {"number", "direction"}, .directions = picture.directions});
    while (rows.next())
        directions[static_cast<std::size_t>(rows.integer(0))] = rows.text(1);
    for (const AtlasMotion& motion : atlas.findings.motions)
        if (const auto found = directions.find(motion.number); motion.run == name && found != directions.end()) {
            atlas.motions.push_back(motion);
            atlas.directions.push_back(found->second);
        }
    return atlas;
}

} // namespace

std::pair<double, double> shown_range(const AtlasAxis& axis) {
    if (axis.least != axis.greatest)
        return {std::min(axis.least, axis.greatest), std::max(axis.least, axis.greatest)};
    return range_about(axis.least);
}

ResultPicture atlas_picture(const StudyPicture& picture, const ResultFile& file) {
    const DrawnAtlas atlas = drawn_atlas(picture, file);
    const std::vector<AtlasAxis>& axes = atlas.findings.axes;
    if (!picture.x.empty() && picture.x != axes.front().name)
        throw InputError(picture.place,
                         fmt::format("the x axis of an atlas is its first parameter, '{}'", axes[0].name),
                         "leave x out");
    ResultPicture made = axes.size() > 1 ? atlas_plane(picture, atlas) : atlas_diagram(picture, atlas);
    if (!atlas.findings.finished)
        made.figure.panels.front().notes.emplace_back("the atlas is not finished");
    return made;
}

} // namespace graze
