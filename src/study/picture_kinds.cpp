#include "study/picture_kinds.hpp"

#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

namespace graze {

std::vector<std::string> chosen_values(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.y.empty())
        return picture.y;
    return run.value_names();
}

void require_values(const StudyPicture& picture, const StoredRun& run, const std::vector<std::string>& names) {
    const std::vector<std::string> known = run.value_names();
    for (const std::string& name : names)
        if (!run.has_value(name))
            throw InputError(picture.place, fmt::format("run '{}' has no value '{}'", run.record.name, name),
                             name_advice(name, known, "it has none"));
}

std::string first_coordinate(const StudyPicture& picture, const StoredRun& run) {
    if (!picture.x.empty())
        return picture.x;
    if (run.record.coordinates.empty())
        throw InputError(picture.place, fmt::format("run '{}' varies nothing", run.record.name),
                         "draw its history instead");
    return run.record.coordinates.front().name;
}

std::vector<std::string> shown_samplings(const StudyPicture& picture, const StoredRun& run) {
    return picture.samplings.empty() ? run.record.samplings : picture.samplings;
}

std::vector<std::string> row_samplings(const StoredRun& run) {
    std::vector<std::string> names;
    if (run.record.kind == "record")
        for (const RecordSampling& sampling : stored_run(run.record).record.samplings)
            if (sampling.kind == RecordSampling::Kind::record)
                names.push_back(sampling.name);
    return names;
}

std::vector<std::string> shown_points(const StudyPicture& picture, const StoredRun& run) {
    std::vector<std::string> names = shown_samplings(picture, run);
    if (picture.samplings.empty())
        for (const std::string& rows : row_samplings(run))
            std::erase(names, rows);
    return names;
}

FigurePanel panel_of(const StudyPicture& picture, const StoredRun& run, const std::string& x, const std::string& y,
                     std::size_t index) {
    FigurePanel panel = empty_panel(picture);
    label_axes(panel, picture, run, x, y);
    apply_labels(panel, picture, index);
    return panel;
}

FigurePanel empty_panel(const StudyPicture& picture) {
    FigurePanel panel;
    panel.logarithmic_x = picture.logarithmic_x;
    panel.logarithmic_y = picture.logarithmic_y;
    panel.x_range = picture.x_range;
    panel.y_range = picture.y_range;
    return panel;
}

std::vector<double> samples_of(const PointRecord& point, const StoredRun& run, const std::string& value,
                               const std::string& sampling, std::vector<double>* times) {
    std::vector<double> result;
    const SampleSet& samples = point.result.samples;
    std::size_t column = 0;
    while (column < run.record.values.size() && run.record.values[column].name != value)
        ++column;
    for (std::size_t s = 0; s < samples.size() && column < samples.width; ++s)
        if (run.record.samplings[samples.samplings[s]] == sampling) {
            result.push_back(samples.values[s * samples.width + column]);
            if (times)
                times->push_back(samples.times[s]);
        }
    return result;
}

} // namespace graze
